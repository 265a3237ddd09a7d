// Cuts tables into lines and fields, and reads numbers.
#include "lab/formats/csv/text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <type_traits>

#include <fmt/format.h>

#include "lab/formats/format.hpp"

namespace broadside::lab::readers {
namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

template <typename Number>
bool parse(std::string_view text, Number& value) {
  // Which std::from_chars does not know.
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size()) return false;
  if constexpr (std::is_floating_point_v<Number>) {
    if (error == std::errc::result_out_of_range) {
      // Too large, or so small that the nearest is zero or almost zero: that one is right.
      const std::string copy(text);
      if constexpr (std::is_same_v<Number, float>)
        value = std::strtof(copy.c_str(), nullptr);
      else
        value = std::strtod(copy.c_str(), nullptr);
      return std::isfinite(value);
    }
    if (std::isnan(value)) return false;
  }
  return error == std::errc();
}

}  // namespace

Separator separator_of(std::string_view line) {
  for (const Separator separator : {Separator::semicolon, Separator::comma, Separator::tab}) {
    if (line.find(static_cast<char>(separator)) != std::string_view::npos) return separator;
  }
  return Separator::blanks;
}

CsvFields::CsvFields(const char* begin, const char* end, Separator separator)
    : at_(begin), end_(end), separator_(separator) {
  if (separator != Separator::blanks) return;
  skip_padding();
  while (end_ != at_ && is_padding(end_[-1], separator)) --end_;
}

bool CsvFields::next(std::string_view& field) {
  if (!more_) return false;
  skip_padding();
  is_quoted_ = at_ != end_ && *at_ == '"' && take_quoted(field);
  if (is_quoted_) return true;
  const char* const begin = at_;
  if (separator_ == Separator::blanks)
    at_ = std::find_if(at_, end_, [](char c) { return is_padding(c, Separator::blanks); });
  else
    at_ = std::find(at_, end_, static_cast<char>(separator_));
  const char* last = at_;
  while (last != begin && is_padding(last[-1], separator_)) --last;
  field = {begin, last};
  take_separator();
  return true;
}

/// Takes a field in quotes, in which two quotes stand for one; if it is not one, takes nothing.
bool CsvFields::take_quoted(std::string_view& field) {
  const char* const begin = at_;
  const char* close = std::find(begin + 1, end_, '"');
  while (end_ - close > 1 && close[1] == '"') close = std::find(close + 2, end_, '"');
  if (close == end_) return false;
  at_ = close + 1;
  if (!take_separator()) {
    at_ = begin;
    return false;
  }
  field = {begin + 1, close};
  return true;
}

void CsvFields::read_text(std::string_view field, std::string& text) const {
  text.clear();
  for (std::size_t i = 0; i < field.size(); ++i) {
    text += field[i];
    if (is_quoted_ && field[i] == '"') ++i;
  }
}

void CsvFields::skip_padding() {
  while (at_ != end_ && is_padding(*at_, separator_)) ++at_;
}

/// Whether a field ends here; the next one then begins behind the separator, if there is one.
bool CsvFields::take_separator() {
  const char* const before = at_;
  skip_padding();
  more_ = at_ != end_;
  if (!more_) return true;
  if (separator_ == Separator::blanks) return at_ != before;
  return *at_++ == static_cast<char>(separator_);
}

void append_csv_field(std::string& line, std::string_view field) {
  const bool is_padded = !field.empty() && (is_padding(field.front(), Separator::comma) ||
                                            is_padding(field.back(), Separator::comma));
  if (!is_padded && field.find_first_of("\",\r\n") == std::string_view::npos) {
    line += field;
    return;
  }
  line += '"';
  for (const char c : field) line.append(c == '"' ? 2 : 1, c);
  line += '"';
}

bool has_open_quote(std::string_view line, Separator separator) {
  // Most lines have no quotes.
  if (line.find('"') == std::string_view::npos) return false;
  CsvFields fields(line, separator);
  for (std::string_view field; fields.next(field);) {
    const std::string_view rest(field.data(), line.data() + line.size());
    if (!fields.is_quoted() && field.starts_with('"') && std::ranges::count(rest, '"') % 2 == 1) return true;
  }
  return false;
}

std::vector<std::string_view> fields_of(std::string_view line, Separator separator) {
  std::vector<std::string_view> list;
  CsvFields fields(line, separator);
  for (std::string_view field; fields.next(field);) list.push_back(field);
  return list;
}

bool parse_number(std::string_view text, float& value) { return parse(text, value); }
bool parse_number(std::string_view text, double& value) { return parse(text, value); }
bool parse_number(std::string_view text, std::uint32_t& value) { return parse(text, value); }

bool is_whole_number_of(std::string_view text, double value) {
  if (text.starts_with('+') || text.starts_with('-')) text.remove_prefix(1);
  if (text.find_first_not_of("0123456789") != std::string_view::npos) return true;
  text.remove_prefix(std::min(text.find_first_not_of('0'), text.size()));
  return text == fmt::format("{:.0f}", std::abs(value));
}

CsvLines::CsvLines(Input& input) : input_(&input), rest_(input.bytes()) {
  if (rest_.starts_with(byte_order_mark)) {
    rest_.remove_prefix(byte_order_mark.size());
    passed_ = byte_order_mark.size();
  }
  // Editors leave empty lines at the end; they say nothing.
  while (rest_.ends_with('\n') || rest_.ends_with('\r')) rest_.remove_suffix(1);
}

void CsvLines::take_slice(std::size_t slice, std::size_t slices) {
  // A line belongs to the slice in which it begins.
  const auto begin_of = [&](std::size_t number) {
    const std::size_t place = rest_.size() / slices * number + std::min(number, rest_.size() % slices);
    if (place == 0 || place == rest_.size()) return place;
    const std::size_t end_of_line = rest_.find('\n', place - 1);
    return end_of_line == std::string_view::npos ? rest_.size() : end_of_line + 1;
  };
  const std::size_t begin = begin_of(slice);
  const std::size_t end = begin_of(slice + 1);
  before_slice_ = rest_.substr(0, begin);
  passed_ += begin;
  rest_ = rest_.substr(begin, end - begin);
}

void CsvLines::take() {
  input_->passed(passed_);
  const void* const end = std::memchr(rest_.data(), '\n', rest_.size());
  const std::size_t size =
      end != nullptr ? static_cast<std::size_t>(static_cast<const char*>(end) - rest_.data()) : rest_.size();
  line_ = rest_.substr(0, size);
  rest_.remove_prefix(std::min(size + 1, rest_.size()));
  if (line_.ends_with('\r')) line_.remove_suffix(1);
  ++number_;
  passed_ += size + 1;
}

void CsvLines::refuse(std::uint64_t line, const std::string& found, const std::string& expected) const {
  const auto before = static_cast<std::uint64_t>(std::ranges::count(before_slice_, '\n'));
  throw FileError(fmt::format("{}:{}: {}; expected {}", input_->name(), before + line, found, expected));
}

}  // namespace broadside::lab::readers
