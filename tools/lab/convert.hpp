// Files of boxes turned into another format.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lab/formats/format.hpp"

namespace broadside::lab {

/// What a conversion wrote.
struct Converted {
  int dimension = 2;
  Precision precision = Precision::float32;
  std::uint64_t frames = 0;
  std::size_t boxes = 0;                ///< the most places there are in a frame
  Rounding rounding{};                  ///< of all boxes written as floats, in all frames
  std::vector<std::string> left_out{};  ///< the names of a table's columns that were not written
  std::string left_out_pairs{};         ///< why the recorded pairs were not written; empty if they were
  std::string warning{};                ///< what had to be left out of a damaged input; empty otherwise
  std::string importer{};  ///< the library that may have rounded its numbers to float; empty if none did
};

/// Writes what is left of `from` to `path`, as write_frames does: in the precision asked for, or that of
/// `from`; in float where the format holds no doubles. Throws FileError. Memory: that of a frame, where both
/// formats go frame by frame.
Converted convert(BoxFile from, const std::filesystem::path& path, const Format& format,
                  std::optional<Precision> precision);

/// What was written to `path`, as a line of text: "rain.csv: 101 frames of 500 boxes in 2D, as floats, in
/// format csv; 3 of 4,000 coordinates were rounded to float".
std::string text_of(const Converted& converted, const std::filesystem::path& path, const Format& format);

/// Which columns of a table were not written, or why recorded pairs were not, as a line of text; empty where
/// nothing was left out.
std::string text_of_left_out(const Converted& converted, const Format& format);

}  // namespace broadside::lab
