// CGAL's box_self_intersection_d: Zomorodian and Edelsbrunner's hybrid of segment trees and sweeps.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include <CGAL/box_intersection_d.h>
#include <CGAL/version.h>

#include "lab/peers/peers.hpp"
#include "lab/peers/typical_extent.hpp"

namespace broadside::lab::peers {
namespace {

/// The cutoff that is fastest, or within a third of the fastest, for 1,000 to 1,000,000 boxes, among measured
/// cutoffs from 10 to 3200 (docs/peers.md). Sweeping costs a box its neighbours along one axis, splitting
/// costs it the depth of the trees.
std::ptrdiff_t cutoff_for(std::size_t boxes) {
  return 4 + static_cast<std::ptrdiff_t>(4 * std::sqrt(static_cast<double>(boxes)));
}

template <int D>
class CgalBoxIntersection final : public Searcher<D> {
 public:
  explicit CgalBoxIntersection(const Settings& settings)
      : cutoff_(static_cast<std::ptrdiff_t>(settings.optional_number("cutoff").value_or(0))) {}

  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) override {
    const std::span<const Box<D>> boxes = input.boxes;
    const std::array<int, D> axes = axes_by_extent(boxes);  // CGAL sweeps along the first axis
    boxes_.clear();
    boxes_.reserve(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      float min[D];
      float max[D];
      for (int axis = 0; axis < D; ++axis) {
        min[axis] = boxes[i].min[axes[axis]];
        max[axis] = boxes[i].max[axes[axis]];
      }
      boxes_.emplace_back(min, max, BoxId(i));
    }
    const auto report = [&pairs](const CgalBox& a, const CgalBox& b) { pairs.add(a.info(), b.info()); };
    // CGAL sorts the boxes themselves; pointers to them, which it accepts as well, are slower.
    const std::ptrdiff_t cutoff = cutoff_ > 0 ? cutoff_ : cutoff_for(boxes.size());
    if (input.left_count > 0) {
      const auto middle = boxes_.begin() + static_cast<std::ptrdiff_t>(input.left_count);
      CGAL::box_intersection_d(boxes_.begin(), middle, middle, boxes_.end(), report, cutoff,
                               CGAL::Box_intersection_d::CLOSED);
    } else {
      CGAL::box_self_intersection_d(boxes_.begin(), boxes_.end(), report, cutoff,
                                    CGAL::Box_intersection_d::CLOSED);
    }
    return std::nullopt;
  }

 private:
  using CgalBox = CGAL::Box_intersection_d::Box_with_info_d<float, D, BoxId>;

  std::ptrdiff_t cutoff_;  // 0: by the number of boxes
  std::vector<CgalBox> boxes_;
};

}  // namespace

Algorithm cgal_box_intersection() {
  return {
      .name = "cgal_box_intersection",
      .summary = "CGAL's box_self_intersection_d: a hybrid of streamed segment trees and sweeps",
      .source =
          "CGAL, Intersecting Sequences of dD Iso-oriented Boxes, after Zomorodian and Edelsbrunner 2000",
      .kind = AlgorithmKind::peer,
      .version = "CGAL " CGAL_VERSION_STR,
      .tunables = {{.name = "cutoff",
                    .summary = "boxes, below which it sweeps instead of splitting",
                    .default_value = "auto",
                    .type = Tunable::Type::integer,
                    .min = 1,
                    .max = 1e9}},
      .in_2d = {.searcher = make_strategy<CgalBoxIntersection<2>>},
      .in_3d = {.searcher = make_strategy<CgalBoxIntersection<3>>},
      // Its axes end at the lowest and the highest float.
      .limits = {.infinite_boxes = false, .max_coordinate = 3.4e38},
  };
}

}  // namespace broadside::lab::peers
