// Joins files of boxes: the boxes of one frame, and the overlapping pairs within one set or between two.
#include "lab/join.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "broadside/algorithm.hpp"
#include "broadside/finder.hpp"

#include "lab/numbers.hpp"

namespace broadside::lab {
namespace {

template <int D, typename Real>
FrameOfFile read(FrameReader<D, Real>& frames, std::string name, std::size_t frame) {
  std::vector<Box<D, Real>> boxes = frames.first();
  std::size_t at = 0;
  Step<D, Real> step;
  bool has_more = frames.next(step);
  for (; has_more && at < frame; ++at) {
    lab::apply(step, boxes);
    has_more = frames.next(step);
  }
  if (at < frame)
    throw FileError(fmt::format("{}: --frame is {}; expected 0{}, as the file has {}", name, frame,
                                at == 0 ? "" : fmt::format(" to {}", at),
                                counted(at + 1, "frame", "frames")));
  return {std::move(name),     std::move(boxes), has_more || frame > 0,
          frames.labels(),     frames.warning(), std::string(frames.importer()),
          frames.is_computed()};
}

template <int D, typename Real>
FrameOfFile read_all(FrameReader<D, Real>& frames, std::string name) {
  std::vector<Box<D, Real>> boxes = frames.first();
  std::vector<Box<D, Real>> all = boxes;
  std::vector<std::size_t> offsets = {0, all.size()};
  for (Step<D, Real> step; frames.next(step); offsets.push_back(all.size())) {
    lab::apply(step, boxes);
    all.insert(all.end(), boxes.begin(), boxes.end());
  }
  return {std::move(name),      std::move(all),    offsets.size() > 2,
          frames.labels(),      frames.warning(),  std::string(frames.importer()),
          frames.is_computed(), std::move(offsets)};
}

template <typename Real, int D, typename OldReal>
std::vector<Box<D, Real>> converted(const std::vector<Box<D, OldReal>>& boxes) {
  std::vector<Box<D, Real>> result(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t axis = 0; axis < D; ++axis) {
      result[i].min[axis] = static_cast<Real>(boxes[i].min[axis]);
      result[i].max[axis] = static_cast<Real>(boxes[i].max[axis]);
    }
  }
  return result;
}

AnyBoxes widened(const AnyBoxes& boxes) {
  if (dimension(boxes) == 2) return converted<double>(std::get<std::vector<Box2>>(boxes));
  return converted<double>(std::get<std::vector<Box3>>(boxes));
}

}  // namespace

std::size_t size(const AnyBoxes& boxes) {
  return std::visit([](const auto& list) { return list.size(); }, boxes);
}

std::size_t absent_count(const AnyBoxes& boxes) {
  return std::visit(
      [](const auto& list) {
        return static_cast<std::size_t>(
            std::ranges::count_if(list, [](const auto& box) { return is_absent(box); }));
      },
      boxes);
}

int dimension(const AnyBoxes& boxes) noexcept { return boxes.index() % 2 == 0 ? 2 : 3; }

Precision precision(const AnyBoxes& boxes) noexcept {
  return boxes.index() < 2 ? Precision::float32 : Precision::float64;
}

FrameOfFile read_frame(BoxFile file, std::size_t frame) {
  return std::visit([&](const auto& frames) { return read(*frames, std::move(file.name), frame); },
                    file.frames);
}

FrameOfFile read_all_frames(BoxFile file) {
  return std::visit([&](const auto& frames) { return read_all(*frames, std::move(file.name)); }, file.frames);
}

Rounding round_to_float(AnyBoxes& boxes) {
  Rounding rounding;
  boxes = std::visit(
      [&]<int D, typename Real>(const std::vector<Box<D, Real>>& list) -> AnyBoxes {
        rounding.count(std::span<const Box<D, Real>>(list));
        return converted<float>(list);
      },
      boxes);
  return rounding;
}

void match(FrameOfFile& left, FrameOfFile& right) {
  if (dimension(left.boxes) != dimension(right.boxes)) {
    throw FileError(fmt::format(
        "{} holds boxes in {}D and {} in {}D; expected both in the same, as --dimension 2 makes them",
        left.name, dimension(left.boxes), right.name, dimension(right.boxes)));
  }
  if (precision(left.boxes) == precision(right.boxes)) return;
  AnyBoxes& narrow = precision(left.boxes) == Precision::float32 ? left.boxes : right.boxes;
  narrow = widened(narrow);
}

void join(const AnyBoxes& boxes, const Entry& entry, PairSink& pairs, const PairFilters& filters) {
  std::visit(
      [&]<int D, typename Real>(const std::vector<Box<D, Real>>& list) {
        Finder<D, Real>(*entry.algorithm, entry.spec).find(list, pairs, filters);
      },
      boxes);
}

void join(const AnyBoxes& left, const AnyBoxes& right, const Entry& entry, PairSink& pairs,
          const PairFilters& filters) {
  std::visit(
      [&]<int D, typename Real>(const std::vector<Box<D, Real>>& list) {
        Finder<D, Real> finder(*entry.algorithm, entry.spec);
        finder.find_between(list, std::get<std::vector<Box<D, Real>>>(right), pairs, filters);
      },
      left);
}

}  // namespace broadside::lab
