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

/// A field of a line, without the spaces and the pair of double quotes around its value.
struct CsvField {
  std::string_view text;
  bool is_quoted = false;
};

/// Cuts a line into its fields, at least one.
void split(std::string_view line, Separator separator, std::vector<CsvField>& fields);

/// The texts of a line's fields.
std::vector<std::string_view> fields_of(std::string_view line, Separator separator);

/// What a field says: two quotes in one that stood in quotes are one.
std::string unquoted(const CsvField& field);

/// Appends a field to a line with commas: in quotes where it could be read as anything else.
void append_csv_field(std::string& line, std::string_view field);

/// Whether a quoted field of a line goes on in the next line.
bool has_open_quote(std::string_view line, const std::vector<CsvField>& fields);

/// Whether `value` is exactly what `text` says, if that is a whole number without point or exponent; true of
/// any other text. So are identifiers and fixed-point coordinates written, which must not lose digits.
bool is_held(std::string_view text, double value);

/// A file's lines, one after the other. A copy goes on from the same place.
class CsvLines {
 public:
  /// The input must outlive the lines.
  explicit CsvLines(Input& input);

  /// Whether there was another line; line() is then that one, without its end.
  bool next();

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
  Input* input_;  // not a reference, so that lines can be assigned
  std::uint64_t passed_ = 0;
  std::string_view before_slice_;  // what was left out; its lines are counted where they are told
  std::string_view rest_;
  std::string_view line_;
  std::uint64_t number_ = 0;
};

}  // namespace broadside::lab::readers
