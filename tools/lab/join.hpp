// Joins files of boxes: the pairs that overlap or lie within a distance, within one set or between two.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/filter.hpp"
#include "broadside/pair.hpp"

#include "lab/catalogue.hpp"
#include "lab/formats/format.hpp"

namespace broadside::lab {

/// Boxes of either dimension and either precision.
using AnyBoxes =
    std::variant<std::vector<Box2>, std::vector<Box3>, std::vector<DoubleBox2>, std::vector<DoubleBox3>>;

std::size_t size(const AnyBoxes& boxes);
std::size_t absent_count(const AnyBoxes& boxes);
int dimension(const AnyBoxes& boxes) noexcept;
Precision precision(const AnyBoxes& boxes) noexcept;

/// The boxes of one frame of a file, or of all.
struct FrameOfFile {
  std::string name;  ///< of the file
  AnyBoxes boxes;
  bool is_moving = false;                     ///< whether the file has more than one frame
  std::shared_ptr<const BoxLabels> labels{};  ///< null if the file has none
  std::string warning{};                      ///< what was left out of a damaged file; empty if nothing was
  std::string importer{};    ///< the library that may have rounded the file's numbers to float; otherwise
                             ///< empty
  bool is_computed = false;  ///< whether bounds were computed from a centre and a size
  std::vector<std::size_t> offsets{};  ///< of all frames: where each begins, and the number of all boxes
};

/// Reads one frame; the first is frame 0. Throws FileError, also if the file has fewer frames. Memory: one
/// frame, if the format is read frame by frame.
FrameOfFile read_frame(BoxFile file, std::size_t frame);

/// Reads all frames, one after the other. Absent boxes keep their places.
FrameOfFile read_all_frames(BoxFile file);

/// Rounds doubles to the nearest floats, and counts the coordinates that change.
Rounding round_to_float(AnyBoxes& boxes);

/// Converts two sets to the same precision: double if either is double, which is exact. Throws FileError,
/// naming both, if one is in 2D and the other in 3D.
void match(FrameOfFile& left, FrameOfFile& right);

/// Writes each pair of overlapping boxes once, in the order in which the entry finds it. Throws what
/// Finder::find() throws, and InvalidSpec if the entry cannot search boxes of this dimension. Leaves out the
/// pairs that `filters` reject.
void join(const AnyBoxes& boxes, const Entry& entry, PairSink& pairs, const PairFilters& filters = {});

/// Likewise, each overlapping pair of a box of `left` and a box of `right`. match() must have been called for
/// the two.
void join(const AnyBoxes& left, const AnyBoxes& right, const Entry& entry, PairSink& pairs,
          const PairFilters& filters = {});

/// Writes each pair of boxes whose gap on each axis (0 if they overlap on it) is at most `distance`, which is
/// finite and at least 0. The gap between two coordinates is compared with
/// the distance as real numbers, without rounding. Otherwise as join().
void join_within(const AnyBoxes& boxes, double distance, const Entry& entry, PairSink& pairs,
                 const PairFilters& filters = {});

/// Likewise, each such pair of a box of `left` and a box of `right`. match() must have been called for the
/// two.
void join_within(const AnyBoxes& left, const AnyBoxes& right, double distance, const Entry& entry,
                 PairSink& pairs, const PairFilters& filters = {});

}  // namespace broadside::lab
