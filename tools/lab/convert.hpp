// Converts files of boxes to another format.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lab/formats/format.hpp"

namespace broadside::lab {

/// The result of a conversion.
struct Converted {
  int dimension = 2;
  Precision precision = Precision::float32;
  std::uint64_t frames = 0;
  std::size_t boxes = 0;                ///< the maximum number of places in a frame
  Rounding rounding{};                  ///< over all boxes written as floats, in all frames
  std::vector<std::string> left_out{};  ///< the names of a table's columns that were not written
  std::string left_out_pairs{};         ///< why the recorded pairs were not written; empty if they were
                                        ///< written
  std::string warning{};                ///< what was left out of a damaged input; empty if nothing was
  std::string importer{};  ///< the library that may have rounded the input's numbers to float; otherwise
                           ///< empty
};

/// Writes the remaining frames of `from` to `path`, as write_frames() does: in the requested precision, or
/// that of `from`; in float if the format has no doubles. Throws FileError. Memory: one frame, if both
/// formats work frame by frame.
Converted convert(BoxFile from, const std::filesystem::path& path, const Format& format,
                  std::optional<Precision> precision);

/// A line of text that says what was written to `path`: "rain.csv: 101 frames of 500 boxes in 2D, as floats,
/// in format csv; 3 of 4,000 coordinates were rounded to float".
std::string text_of(const Converted& converted, const std::filesystem::path& path, const Format& format);

/// A line of text that says which columns of a table, or why recorded pairs, were not written; empty if
/// nothing was left out.
std::string text_of_left_out(const Converted& converted, const Format& format);

}  // namespace broadside::lab
