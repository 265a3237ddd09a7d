// What a file of boxes holds, in numbers: how many, where, how large, and how they move.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lab/formats/format.hpp"

namespace broadside::lab {

/// The shares of boxes at which FileInfo tells their extents.
inline constexpr std::array<double, 7> told_percentiles = {0, 0.01, 0.25, 0.5, 0.75, 0.99, 1};

/// Boxes along one axis.
struct AxisInfo {
  double min;  ///< of all boxes in all frames, infinite ones aside; above max where there are none
  double max;
  std::array<double, told_percentiles.size()> extents;  ///< of the fullest frame's boxes
};

/// Boxes whose longest side is from 2^exponent to below 2^(exponent + 1).
struct SizeBin {
  int exponent;
  std::uint64_t boxes;
};

/// The pairs that an engine's own broad phase reported.
struct RecordedPairsInfo {
  double margin = 0;
  std::array<std::uint64_t, 3> reported{};  ///< least, median and most in a frame
  std::uint64_t begun = 0;                  ///< in all frames after the first
  std::uint64_t ended = 0;
  std::uint64_t ignored = 0;  ///< most pairs of a frame that need not be reported
  std::uint64_t filters = 0;  ///< how often a box is given a filter, in all frames
};

/// What a file holds. The fullest frame is the first with the most boxes.
struct FileInfo {
  std::string file;
  std::string format;  ///< empty for a scene
  int dimension = 2;
  Precision precision = Precision::float32;
  std::string importer{};  ///< the library that may have rounded its numbers to float; empty if none did
  std::uint64_t frames = 0;

  std::uint64_t present = 0;  ///< boxes in the fullest frame
  std::uint64_t absent = 0;   ///< places in that frame that hold none
  std::vector<AxisInfo> axes{};
  std::uint64_t points = 0;          ///< boxes of the fullest frame without any extent
  std::uint64_t flat = 0;            ///< those without extent on some axis but not on all
  std::uint64_t infinite = 0;        ///< those that reach to infinity
  std::vector<SizeBin> sizes{};      ///< of the others that have an extent; ascending, no bin left out
  std::uint64_t coordinates = 0;     ///< finite ones, of the first frame's boxes and of each change
  std::uint64_t whole = 0;           ///< those that are integers
  std::uint64_t exactly_floats = 0;  ///< those that a float holds
  std::uint64_t added = 0;           ///< boxes, in all frames after the first
  std::uint64_t removed = 0;
  std::array<double, 3> moving{};  ///< least, median and greatest fraction of a frame's boxes that move
  std::optional<RecordedPairsInfo> pairs{};  ///< empty where none were recorded

  double seconds = 0;       ///< that reading took
  std::uint64_t bytes = 0;  ///< of the file; 0 where unknown
  std::uint64_t boxes = 0;  ///< that were read, in all frames
  std::string warning{};    ///< what had to be left out of a damaged file; empty otherwise
};

/// Reads a file, or standard input where the path is "-", frame by frame. Throws FileError. Memory: that of
/// two frames, where the format does not need more.
FileInfo file_info(const std::filesystem::path& path, const ReadOptions& options);

/// The same of a file that is open already, or of a scene's boxes; how many bytes they took is not known.
FileInfo file_info(BoxFile file);

/// The same as lines of text, with a small histogram of sizes.
std::string text_of(const FileInfo& info);

}  // namespace broadside::lab
