// Splits tables into lines and fields.
#include "lab/formats/csv/csv_text.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lab/formats/format.hpp"

namespace broadside::lab::readers {
namespace {

constexpr auto npos = std::string_view::npos;

/// Whether a character may surround a value.
bool is_padding(char c, Separator separator) {
  return c == ' ' || (c == '\t' && separator != Separator::tab);
}

std::size_t skip_padding(std::string_view line, std::size_t at, Separator separator) {
  while (at < line.size() && is_padding(line[at], separator)) ++at;
  return at;
}

/// The position of the quote that closes the field beginning at a place; npos if the field is not entirely
/// quoted.
std::size_t closing_quote(std::string_view line, std::size_t begin, Separator separator) {
  if (begin == line.size() || line[begin] != '"') return npos;
  std::size_t close = line.find('"', begin + 1);
  while (close != npos && line.substr(close + 1).starts_with('"')) close = line.find('"', close + 2);
  if (close == npos) return npos;
  const std::size_t next = skip_padding(line, close + 1, separator);
  const bool ends =
      next == line.size() ||
      (separator == Separator::blanks ? next > close + 1 : line[next] == static_cast<char>(separator));
  return ends ? close : npos;
}

}  // namespace

Separator separator_of(std::string_view line) {
  for (const Separator separator : {Separator::semicolon, Separator::comma, Separator::tab}) {
    if (line.find(static_cast<char>(separator)) != npos) return separator;
  }
  return Separator::blanks;
}

void split(std::string_view line, Separator separator, std::vector<CsvField>& fields) {
  fields.clear();
  const bool are_blanks = separator == Separator::blanks;
  while (are_blanks && !line.empty() && is_padding(line.back(), separator)) line.remove_suffix(1);
  for (std::size_t at = 0, next = 0; next != npos; at = next + 1) {
    at = skip_padding(line, at, separator);
    std::size_t end = closing_quote(line, at, separator);
    const bool is_quoted = end != npos;
    if (is_quoted)
      ++at;
    else
      end = std::min(are_blanks ? line.find_first_of(" \t", at) : line.find(static_cast<char>(separator), at),
                     line.size());
    next = skip_padding(line, is_quoted ? end + 1 : end, separator);
    if (next == line.size()) next = npos;
    if (are_blanks && next != npos) --next;
    while (!is_quoted && end > at && is_padding(line[end - 1], separator)) --end;
    fields.push_back({line.substr(at, end - at), is_quoted});
  }
}

std::vector<std::string_view> fields_of(std::string_view line, Separator separator) {
  std::vector<CsvField> fields;
  split(line, separator, fields);
  std::vector<std::string_view> texts;
  for (const CsvField& field : fields) texts.push_back(field.text);
  return texts;
}

std::string unquoted(const CsvField& field) {
  std::string text;
  for (std::size_t i = 0; i < field.text.size(); ++i) {
    text += field.text[i];
    if (field.is_quoted && field.text[i] == '"') ++i;
  }
  return text;
}

void append_csv_field(std::string& line, std::string_view field) {
  const bool is_padded = !field.empty() && (is_padding(field.front(), Separator::comma) ||
                                            is_padding(field.back(), Separator::comma));
  if (!is_padded && field.find_first_of("\",\r\n") == npos) {
    line += field;
    return;
  }
  line += '"';
  for (const char c : field) line.append(c == '"' ? 2 : 1, c);
  line += '"';
}

bool has_open_quote(std::string_view line, const std::vector<CsvField>& fields) {
  // Most lines have no quotes.
  if (line.find('"') == npos) return false;
  return std::any_of(fields.begin(), fields.end(), [line](const CsvField& field) {
    const char* const begin = field.text.data();
    return !field.is_quoted && field.text.starts_with('"') &&
           std::count(begin, line.data() + line.size(), '"') % 2 == 1;
  });
}

bool is_held(std::string_view text, double value) {
  constexpr double exact = 9007199254740992;  // 2^53: doubles represent all integers up to here
  if (value < exact && value > -exact) return true;
  if (text.starts_with('+') || text.starts_with('-')) text.remove_prefix(1);
  if (text.find_first_not_of("0123456789") != npos) return true;
  text.remove_prefix(std::min(text.find_first_not_of('0'), text.size()));
  return text == fmt::format("{:.0f}", std::abs(value));
}

CsvLines::CsvLines(Input& input) : input_(&input), rest_(input.bytes()) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (rest_.starts_with(byte_order_mark)) {
    rest_.remove_prefix(byte_order_mark.size());
    passed_ = byte_order_mark.size();
  }
  // Editors leave empty lines at the end; they mean nothing.
  while (rest_.ends_with('\n') || rest_.ends_with('\r')) rest_.remove_suffix(1);
}

bool CsvLines::next() {
  if (rest_.empty()) return false;
  input_->passed(passed_);
  const std::size_t size = std::min(rest_.find('\n'), rest_.size());
  line_ = rest_.substr(0, size);
  rest_.remove_prefix(std::min(size + 1, rest_.size()));
  if (line_.ends_with('\r')) line_.remove_suffix(1);
  ++number_;
  passed_ += size + 1;
  return true;
}

void CsvLines::take_slice(std::size_t slice, std::size_t slices) {
  // A line belongs to the slice in which it begins.
  const auto begin_of = [&](std::size_t number) {
    const std::size_t place = rest_.size() / slices * number + std::min(number, rest_.size() % slices);
    if (place == 0 || place == rest_.size()) return place;
    const std::size_t end_of_line = rest_.find('\n', place - 1);
    return end_of_line == npos ? rest_.size() : end_of_line + 1;
  };
  const std::size_t begin = begin_of(slice);
  const std::size_t end = begin_of(slice + 1);
  before_slice_ = rest_.substr(0, begin);
  passed_ += begin;
  rest_ = rest_.substr(begin, end - begin);
}

void CsvLines::refuse(std::uint64_t line, const std::string& found, const std::string& expected) const {
  const auto before =
      static_cast<std::uint64_t>(std::count(before_slice_.begin(), before_slice_.end(), '\n'));
  throw FileError(fmt::format("{}:{}: {}; expected {}", input_->name(), before + line, found, expected));
}

}  // namespace broadside::lab::readers
