// What bounds an algorithm's tests, references, cells and memory, whatever its boxes and tunables: counted.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"
#include "broadside/tracker.hpp"

#include "lab/measure/memory.hpp"
#include "tests/support/boxes.hpp"
#include "tests/support/model.hpp"

namespace broadside {
namespace {

/// Boxes that are hard to part: long ones across each other, all at one place, clusters within clusters; and
/// scattered ones.
template <int D>
std::vector<std::vector<Box<D>>> hard_boxes(std::size_t count) {
  Rng rng(1);
  std::vector<std::vector<Box<D>>> all(4, std::vector<Box<D>>(count));
  float scale = 1;
  for (std::size_t i = 0; i < count; ++i) {
    for (int axis = 0; axis < D; ++axis) {
      const float at = rng.between(0, 1000);
      const bool is_long = i % D == static_cast<std::size_t>(axis);
      all[0][i].min[axis] = is_long ? 0 : at;
      all[0][i].max[axis] = is_long ? 1000 : at + 1;
      all[1][i].min[axis] = 0;
      all[1][i].max[axis] = 1;
      all[2][i].min[axis] = scale * rng.unit();
      all[2][i].max[axis] = all[2][i].min[axis] + scale / 1000;
      all[3][i].min[axis] = at;
      all[3][i].max[axis] = at + 1;
    }
    if (i % 100 == 99) scale /= 2;
  }
  return all;
}

TEST(Limits, HoldInSearches) {
  in_each_dimension([]<int D>() {
    constexpr std::size_t count = 1500;
    for (const std::string spec :
         {"grid", "grid:cell=1e-6", "grid:cell=1e30", "quadtree", "quadtree:capacity=1", "bvh",
          "sweep_and_prune", "sweep_and_prune:axes=2", "auto"}) {
      for (const std::vector<Box<D>>& boxes : hard_boxes<D>(count)) {
        const lab::AllocationMeter meter;
        Finder<D> finder(spec);
        PairCounter pairs;
        const auto statistics = finder.find(boxes, pairs);
        ASSERT_TRUE(statistics);
        EXPECT_LE(statistics->references, 80 * count) << spec;
        EXPECT_LE(statistics->tests, 80 * count * count / 2) << spec;
        if (const auto allocation = meter.read()) {
          EXPECT_LE(allocation->peak, static_cast<std::int64_t>(2000 * count)) << spec;
        }
      }
    }
  });
}

TEST(Limits, HoldWhileBoxesAreFollowed) {
  in_each_dimension([]<int D>() {
    constexpr std::size_t count = 1000;
    for (const std::string spec :
         {"grid:update=follow", "grid:cell=1e-6:update=follow", "quadtree:update=follow",
          "quadtree:capacity=1:update=follow", "bvh:update=follow", "sweep_and_prune:update=follow"}) {
      Tracker<D> tracker(spec);
      std::vector<BoxId> all;
      for (std::size_t i = 0; i < count; ++i) all.push_back(BoxId(i));
      std::vector<Box<D>> boxes(count, absent_box<D>());
      std::uint64_t max_events = 0;
      const auto update = [&](std::size_t max_references) {
        PairCounter events;
        const auto statistics = tracker.update({boxes, all}, events, events);
        max_events = std::max(max_events, events.count());
        ASSERT_TRUE(statistics);
        EXPECT_LE(statistics->references, max_references * count) << spec;
        EXPECT_LE(statistics->cells, 8 * count) << spec;
        EXPECT_LE(statistics->tests, 4 * count * count) << spec;
        EXPECT_LE(tracker.bytes(), 4000 * count + 64 * max_events) << spec;
      };
      for (const std::vector<Box<D>>& next : hard_boxes<D>(count)) {
        // A third at a time becomes of another kind, in a structure made for others.
        for (std::size_t third = 0; third < 3; ++third) {
          for (std::size_t i = third; i < count; i += 3) boxes[i] = next[i];
          update(40);
        }
        // Then they move, for as long as it takes to notice.
        for (int frame = 0; frame < 3; ++frame) {
          for (Box<D>& box : boxes) box.max[0] = std::nextafter(box.max[0], infinity);
          update(frame < 2 ? 40 : 7);
        }
      }
    }
  });
}

}  // namespace
}  // namespace broadside
