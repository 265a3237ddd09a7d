// Files of boxes joined: the pairs that overlap or lie within a distance, in one set or between two.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "broadside/box.hpp"
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

/// The boxes of one frame of a file.
struct FrameOfFile {
  std::string name;  ///< the file's
  AnyBoxes boxes;
  bool is_moving = false;                     ///< whether the file has other frames
  std::shared_ptr<const BoxLabels> labels{};  ///< null where the file has none
  std::string warning{};                      ///< what had to be left out of a damaged file; empty otherwise
  std::string importer{};    ///< the library that may have rounded its numbers to float; empty if none did
  bool is_computed = false;  ///< whether bounds were computed from a centre and a size
};

/// Reads one frame, counted from 0. Throws FileError, also if there are fewer. Memory: that of a frame,
/// where the format is read frame by frame.
FrameOfFile read_frame(BoxFile file, std::size_t frame);

/// Rounds doubles to the nearest floats, and counts what that changes.
Rounding round_to_float(AnyBoxes& boxes);

/// Brings two sets to the same precision: double, which is exact, if either is double. Throws FileError,
/// naming both, if one is in 2D and the other in 3D.
void match(FrameOfFile& left, FrameOfFile& right);

/// Writes every pair of overlapping boxes once, in the order in which the entry finds them. Throws as
/// Finder::find() does, and InvalidSpec if the entry cannot search boxes of this dimension.
void join(const AnyBoxes& boxes, const Entry& entry, PairSink& pairs);

/// Writes every pair of a box of `left` and one of `right`, which match, likewise.
void join(const AnyBoxes& left, const AnyBoxes& right, const Entry& entry, PairSink& pairs);

/// Writes every pair of boxes whose gap on each axis (0 where they overlap on it) is at most `distance`,
/// which is finite and 0 or more. So it finds all pairs whose Euclidean distance is at most that, and a few
/// more, past corners. Exact: the gap of two coordinates is compared with the distance as the real numbers
/// that they are, unrounded. Otherwise as join.
void join_within(const AnyBoxes& boxes, double distance, const Entry& entry, PairSink& pairs);

/// Writes every such pair of a box of `left` and one of `right`, which match, likewise.
void join_within(const AnyBoxes& left, const AnyBoxes& right, double distance, const Entry& entry,
                 PairSink& pairs);

}  // namespace broadside::lab
