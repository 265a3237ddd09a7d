// Tables as text: lines, and the fields of a line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "lab/formats/input.hpp"

namespace broadside::lab::readers {

/// The separator between two fields; blanks: any number of spaces and tabs.
enum class Separator : char { comma = ',', semicolon = ';', tab = '\t', blanks = ' ' };

/// The separator of a line: the first of semicolon, comma and tab that it contains; otherwise blanks.
Separator separator_of(std::string_view line);

/// A field of a line, without spaces and double quotes around its value.
struct CsvField {
  std::string_view text;
  bool is_quoted = false;
};

/// Splits a line into its fields, at least one.
void split(std::string_view line, Separator separator, std::vector<CsvField>& fields);

/// The texts of a line's fields.
std::vector<std::string_view> fields_of(std::string_view line, Separator separator);

/// The value of a field: in a quoted field, two quotes stand for one.
std::string unquoted(const CsvField& field);

/// Appends a field to a line with commas, in quotes if it could be misread.
void append_csv_field(std::string& line, std::string_view field);

/// Whether a quoted field of a line continues in the next line.
bool has_open_quote(std::string_view line, const std::vector<CsvField>& fields);

/// Whether `value` equals `text` exactly, if that is an integer without point or exponent; true for any other
/// text. Identifiers and fixed-point coordinates are written this way, and must not lose digits.
bool is_held(std::string_view text, double value);

/// Reads a file's lines in sequence. A copy continues from the same place.
class CsvLines {
 public:
  /// The input must outlive the lines.
  explicit CsvLines(Input& input);

  /// Whether there was another line; line() then returns it without its end.
  bool next();

  std::string_view line() const noexcept { return line_; }

  /// Restricts reading to one of `slices` slices, which have about equally many bytes.
  void take_slice(std::size_t slice, std::size_t slices);

  /// The number of input bytes before the line that next() reads.
  std::uint64_t passed_bytes() const noexcept { return passed_; }

  /// The number of the line, counted from 1; in a slice, counted from the beginning of the slice.
  std::uint64_t number() const noexcept { return number_; }

  /// The number of bytes after the line, without empty lines at the end.
  std::size_t bytes_left() const noexcept { return rest_.size(); }

  [[noreturn]] void refuse(const std::string& found, const std::string& expected) const {
    refuse(number_, found, expected);
  }

  /// Refuses an earlier line, given its number().
  [[noreturn]] void refuse(std::uint64_t line, const std::string& found, const std::string& expected) const;

 private:
  Input* input_;  // not a reference, so that lines are assignable
  std::uint64_t passed_ = 0;
  std::string_view before_slice_;  // the part left out; its lines are counted when an error needs them
  std::string_view rest_;
  std::string_view line_;
  std::uint64_t number_ = 0;
};

}  // namespace broadside::lab::readers
