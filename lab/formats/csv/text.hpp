// Tables as text: lines, and the fields in a line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "lab/formats/input.hpp"

namespace broadside::lab::readers {

/// What stands between two fields; blanks: any number of spaces and tabs.
enum class Separator : char { comma = ',', semicolon = ';', tab = '\t', blanks = ' ' };

/// The separator of a line: the first of semicolon, comma and tab that it has, and blanks otherwise.
Separator separator_of(std::string_view line);

/// Whether a character may stand around a value.
constexpr bool is_padding(char c, Separator separator) noexcept {
  return c == ' ' || (c == '\t' && separator != Separator::tab);
}

/// The fields of one line, from left to right. Spaces and a pair of double quotes around a value are not part
/// of it.
class CsvFields {
 public:
  CsvFields(const char* begin, const char* end, Separator separator);
  CsvFields(std::string_view line, Separator separator)
      : CsvFields(line.data(), line.data() + line.size(), separator) {}

  /// Whether there was another field; `field` is then that one.
  bool next(std::string_view& field);

  /// What the field taken last says: two quotes in one that stood in quotes are one.
  void read_text(std::string_view field, std::string& text) const;

  /// Whether the field taken last stood in quotes.
  bool is_quoted() const noexcept { return is_quoted_; }

  /// Where the next field begins.
  const char* at() const noexcept { return at_; }

  /// Whether there is a next field. A line has at least one, which may be empty.
  bool more() const noexcept { return more_; }

 private:
  bool take_quoted(std::string_view& field);
  void skip_padding();
  bool take_separator();

  const char* at_;
  const char* end_;
  Separator separator_;
  bool more_ = true;
  bool is_quoted_ = false;
};

/// Appends a field to a line with commas: in quotes where it could be read as anything else.
void append_csv_field(std::string& line, std::string_view field);

/// Whether a quoted field of the line goes on in the next line.
bool has_open_quote(std::string_view line, Separator separator);

/// All fields of a line.
std::vector<std::string_view> fields_of(std::string_view line, Separator separator);

/// Whether all of `text` is a number, which may be infinite but not a NaN, in the range of a `Number`;
/// `value` is then the nearest one.
bool parse_number(std::string_view text, float& value);
bool parse_number(std::string_view text, double& value);
bool parse_number(std::string_view text, std::uint32_t& value);

/// Whether `value` is exactly what `text` says, if that is a whole number without point or exponent; true of
/// any other text.
bool is_whole_number_of(std::string_view text, double value);

/// A file's lines, one after the other. A copy goes on from the same place.
class CsvLines {
 public:
  /// The input must outlive the lines.
  explicit CsvLines(Input& input);

  /// Whether there was another line; line() is then that one, without its end.
  bool next() {
    if (rest_.empty()) return false;
    take();
    return true;
  }

  std::string_view line() const noexcept { return line_; }

  /// Leaves out the lines but those of one of `slices` slices, which have about as many bytes.
  void take_slice(std::size_t slice, std::size_t slices);

  /// How many bytes of the input come before what next() takes.
  std::uint64_t passed_bytes() const noexcept { return passed_; }

  /// The number of the line, from 1; in a slice, from 1 after the lines that were left out before it.
  std::uint64_t number() const noexcept { return number_; }

  /// How many bytes there are behind the line, without empty lines at the end.
  std::size_t bytes_left() const noexcept { return rest_.size(); }

  [[noreturn]] void refuse(const std::string& found, const std::string& expected) const {
    refuse(number_, found, expected);
  }

  /// Refuses an earlier line, by its number().
  [[noreturn]] void refuse(std::uint64_t line, const std::string& found, const std::string& expected) const;

 private:
  void take();

  Input* input_;  // not a reference, so that lines can be assigned
  std::uint64_t passed_ = 0;
  std::string_view before_slice_;  // what was left out; its lines are counted where they are told
  std::string_view rest_;
  std::string_view line_;
  std::uint64_t number_ = 0;
};

}  // namespace broadside::lab::readers
