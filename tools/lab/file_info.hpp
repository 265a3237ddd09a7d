// Statistics of a file of boxes: number, positions, sizes and motion.
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

/// The percentiles at which FileInfo reports extents.
inline constexpr std::array<double, 7> told_percentiles = {0, 0.01, 0.25, 0.5, 0.75, 0.99, 1};

/// The boxes along one axis.
struct AxisInfo {
  double min;  ///< over all boxes in all frames, without infinite coordinates; above max if there are no
               ///< finite ones
  double max;
  std::array<double, told_percentiles.size()> extents;  ///< in the fullest frame
};

/// Boxes whose longest side is from 2^exponent to below 2^(exponent + 1).
struct SizeBin {
  int exponent;
  std::uint64_t boxes;
};

/// The pairs that an engine's own broad phase reported.
struct RecordedPairsInfo {
  double margin = 0;
  std::array<std::uint64_t, 3> reported{};  ///< minimum, median and maximum of a frame
  std::uint64_t begun = 0;                  ///< in all frames after the first
  std::uint64_t ended = 0;
  std::uint64_t ignored = 0;  ///< maximum number of pairs in a frame that need not be reported
  std::uint64_t filters = 0;  ///< how often a box gets a filter, over all frames
};

/// The contents of a file. The fullest frame is the first one with the maximum number of boxes.
struct FileInfo {
  std::string file;
  std::string format;  ///< empty for a scene
  int dimension = 2;
  Precision precision = Precision::float32;
  std::string importer{};  ///< the library that may have rounded its numbers to float; otherwise empty
  std::uint64_t frames = 0;

  std::uint64_t present = 0;  ///< boxes in the fullest frame
  std::uint64_t absent = 0;   ///< places in that frame without a box
  std::vector<AxisInfo> axes{};
  std::uint64_t points = 0;          ///< boxes of the fullest frame without extent on any axis
  std::uint64_t flat = 0;            ///< boxes without extent on some axis but not on all
  std::uint64_t infinite = 0;        ///< boxes that reach to infinity
  std::vector<SizeBin> sizes{};      ///< the other boxes, if they have an extent; ascending, without gaps
  std::uint64_t coordinates = 0;     ///< finite coordinates of the first frame's boxes and of each change
  std::uint64_t whole = 0;           ///< coordinates that are integers
  std::uint64_t exactly_floats = 0;  ///< coordinates that a float represents exactly
  std::uint64_t added = 0;           ///< boxes added, in all frames after the first
  std::uint64_t removed = 0;
  std::array<double, 3> moving{};  ///< minimum, median and maximum fraction of a frame's boxes that move
  std::optional<RecordedPairsInfo> pairs{};  ///< empty if none were recorded

  double seconds = 0;       ///< spent reading
  std::uint64_t bytes = 0;  ///< size of the file; 0 if unknown
  std::uint64_t boxes = 0;  ///< boxes read, in all frames
  std::string warning{};    ///< what was left out of a damaged file; empty if nothing was
};

/// Reads a file frame by frame; the path "-" is standard input. Throws FileError. Memory: two frames, unless
/// the format needs more.
FileInfo file_info(const std::filesystem::path& path, const ReadOptions& options);

/// Likewise for a file that is already open, or for a scene's boxes; their size in bytes is unknown.
FileInfo file_info(BoxFile file);

/// The statistics as lines of text, with a small histogram of sizes.
std::string text_of(const FileInfo& info);

}  // namespace broadside::lab
