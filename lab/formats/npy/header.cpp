// Reads the Python dictionary that is the header of a NumPy array: three keys, each once, and nothing else.
#include "lab/formats/npy/header.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

#include <fmt/format.h>

#include "lab/formats/format.hpp"
#include "lab/formats/text.hpp"

namespace broadside::lab::readers {
namespace {

/// Takes a header's text apart, from left to right.
class HeaderText {
 public:
  HeaderText(std::string_view text, std::size_t begin, const std::string& name)
      : rest_(text), end_(begin + text.size()), name_(name) {}

  /// Whether the next character is this one, which is then taken.
  bool take(char c) {
    skip_blanks();
    if (!rest_.starts_with(c)) return false;
    rest_.remove_prefix(1);
    return true;
  }

  void expect(char c) {
    if (!take(c)) refuse(fmt::format("'{}'", c));
  }

  /// Whether a string comes next.
  bool is_string() {
    skip_blanks();
    return rest_.starts_with('\'') || rest_.starts_with('"');
  }

  std::string string(std::string_view expected) {
    skip_blanks();
    const char quote = rest_.empty() ? '\0' : rest_.front();
    const std::size_t end = quote == '\'' || quote == '"' ? rest_.find(quote, 1) : std::string_view::npos;
    if (end == std::string_view::npos) refuse(std::string(expected));
    std::string value(rest_.substr(1, end - 1));
    rest_.remove_prefix(end + 1);
    return value;
  }

  bool truth() {
    skip_blanks();
    for (const bool value : {false, true}) {
      const std::string_view word = value ? "True" : "False";
      if (!rest_.starts_with(word)) continue;
      rest_.remove_prefix(word.size());
      return value;
    }
    refuse("True or False");
  }

  std::uint64_t number() {
    skip_blanks();
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (error != std::errc()) refuse("a whole number from 0 to 18446744073709551615");
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return value;
  }

  void expect_end() {
    skip_blanks();
    if (!rest_.empty()) refuse("the end of the header");
  }

  [[noreturn]] void refuse(const std::string& expected) const {
    throw FileError(fmt::format("{}: byte {}: {}; expected {} in a NumPy header", name_, end_ - rest_.size(),
                                rest_.empty() ? "the header ends" : shown(rest_, 20), expected));
  }

 private:
  void skip_blanks() { rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size())); }

  std::string_view rest_;
  std::size_t end_;
  const std::string& name_;
};

std::vector<std::uint64_t> take_shape(HeaderText& text) {
  std::vector<std::uint64_t> shape;
  text.expect('(');
  while (!text.take(')')) {
    // As many dimensions as NumPy has.
    if (shape.size() == 32) text.refuse("at most 32 numbers");
    shape.push_back(text.number());
    if (text.take(',')) continue;
    text.expect(')');
    break;
  }
  return shape;
}

/// The fields of a structured array: [('min_x', '<f8'), ('max', '<f4', (2,)), ...].
std::vector<NpyField> take_fields(HeaderText& text) {
  constexpr std::string_view type = "a type of numbers such as '<f8'";
  std::vector<NpyField> fields;
  text.expect('[');
  while (!text.take(']')) {
    text.expect('(');
    NpyField field;
    field.name = text.string("a field's name in quotes");
    text.expect(',');
    field.type = text.string(type);
    if (text.take(',')) field.shape = take_shape(text);
    text.expect(')');
    fields.push_back(std::move(field));
    if (text.take(',')) continue;
    text.expect(']');
    break;
  }
  return fields;
}

/// Where the dictionary begins and ends.
struct Extent {
  std::size_t begin;
  std::size_t end;
};

Extent extent_of_dictionary(std::string_view bytes, const std::string& name) {
  const auto byte = [&bytes](std::size_t at) { return std::size_t{static_cast<unsigned char>(bytes[at])}; };
  const std::string_view magic = bytes.substr(0, npy_magic.size());
  if (magic.empty()) throw FileError(fmt::format("{}: is empty; expected a NumPy array", name));
  if (!npy_magic.starts_with(magic))
    throw FileError(
        fmt::format("{}: byte 0: {:02x}; expected 93 4e 55 4d 50 59, with which a NumPy array begins", name,
                    fmt::join(reinterpret_cast<const unsigned char*>(magic.data()),
                              reinterpret_cast<const unsigned char*>(magic.data()) + magic.size(), " ")));
  const auto cut_off = [&](std::size_t expected) {
    return FileError(
        fmt::format("{}: has {} bytes; expected a NumPy header of {} bytes", name, bytes.size(), expected));
  };
  if (bytes.size() < 10) throw cut_off(10);
  if (byte(6) < 1 || byte(6) > 3 || byte(7) != 0)
    throw FileError(
        fmt::format("{}: byte 6: version {}.{}; expected 1.0, 2.0 or 3.0", name, byte(6), byte(7)));
  const bool is_short = byte(6) == 1;
  const std::size_t begin = is_short ? 10 : 12;
  if (bytes.size() < begin) throw cut_off(begin);
  const std::size_t size = byte(8) | byte(9) << 8 | (is_short ? 0 : byte(10) << 16 | byte(11) << 24);
  if (size > bytes.size() - begin) throw cut_off(begin + size);
  return {begin, begin + size};
}

}  // namespace

NpyHeader read_npy_header(std::string_view bytes, const std::string& name) {
  const auto [begin, end] = extent_of_dictionary(bytes, name);
  NpyHeader header;
  header.bytes = end;
  HeaderText text(bytes.substr(begin, end - begin), begin, name);
  bool has_type = false;
  bool has_order = false;
  bool has_shape = false;
  text.expect('{');
  while (!text.take('}')) {
    const std::string key = text.string("a key in quotes");
    text.expect(':');
    if (key == "descr" && !has_type) {
      has_type = true;
      header.is_structured = !text.is_string();
      if (header.is_structured)
        header.fields = take_fields(text);
      else
        header.type = text.string("a type of numbers such as '<f8'");
    } else if (key == "fortran_order" && !has_order) {
      has_order = true;
      header.is_column_major = text.truth();
    } else if (key == "shape" && !has_shape) {
      has_shape = true;
      header.shape = take_shape(text);
    } else {
      text.refuse(fmt::format("'descr', 'fortran_order' and 'shape', each once, and not the key {} here,",
                              shown(key, 20)));
    }
    if (text.take(',')) continue;
    text.expect('}');
    break;
  }
  text.expect_end();
  if (!has_type || !has_order || !has_shape) text.refuse("'descr', 'fortran_order' and 'shape'");
  return header;
}

}  // namespace broadside::lab::readers
