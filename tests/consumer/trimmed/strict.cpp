// Each public header, and what is inline in it, under the flags that engines compile with: see
// CMakeLists.txt.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <broadside/broadside.hpp>
#include <broadside/debug/history.hpp>
#include <broadside/debug/minimise.hpp>
#include <broadside/debug/outline.hpp>
#include <broadside/debug/shadow.hpp>

namespace {

using namespace broadside;

struct Wall {
  Box2 box;
};

/// Likewise, of the questions beside overlap.
std::size_t pairs_of_other_questions(const std::vector<Box2>& boxes) {
  const std::vector<Pair> near =
      find_pairs_within(boxes, Reach(2).periodic({8.0, 8.0}), {.algorithm = "grid"});
  std::size_t found = distances(boxes, near).size() + nearest_pairs(boxes, 1).boxes.size();
  found += neighbours(near, boxes.size(), NeighbourLists::full).ids.size();
  const std::vector<Pair> met = find_pairs_moving(boxes, boxes, {.algorithm = "grid"});
  found += overlap_times(boxes, boxes, met).size();
  PairCounter counter;
  const std::vector<int> keys(boxes.size());
  auto different = only_different(keys, keys, counter);
  find_pairs(boxes, different, {.algorithm = "grid"});
  const std::vector<std::uint64_t> owners(boxes.size());
  OwnerPairs bodies;
  found += bodies.update(near, {}, owners).begun.size();
  const std::vector<std::size_t> offsets = {0, boxes.size()};
  BatchTracker<2> worlds("grid");
  found += worlds.update(boxes, offsets).begun.pairs.size();
  found += find_pairs_batch(boxes, offsets, {.algorithm = "grid"}).pairs.size();
  const std::vector<DoubleBox2> intervals = {interval(0, 2), interval(1, 3)};
  return found + find_pairs(intervals, {.algorithm = "grid"}).size();
}

/// Calls the inline functions and templates, so that they are compiled.
std::size_t all_calls(const std::vector<Box2>& boxes) {
  std::size_t found = 0;
  const auto count = [&found](auto&&...) { ++found; };
  find_pairs(boxes, count, {.algorithm = "grid"});
  found += find_pairs(boxes, boxes, {.algorithm = "grid"}).size();
  const std::vector<Wall> walls(2);
  found += find_pairs(boxes_of(walls, &Wall::box), {.algorithm = GridOptions{.cell = 2}}).size();

  found += pairs_of_other_questions(boxes);
  Finder<2> finder("grid");
  finder.find(boxes, count);
  Tracker<2> tracker("grid");
  tracker.update({.boxes = boxes}, count, count);

  BoxIndex<2> index;
  index.update({.boxes = boxes});
  index.overlapping(boxes[0], count);
  index.hits(Ray<2>{{0, 0}, {1, 0}}, count);
  found += index.nearest({0, 0}, 1).size();

  World2 world("grid");
  const Handle handle = world.add(boxes[0]);
  world.overlapping(boxes[0], [](Handle) { return true; });
  world.update();
  found += world.nearest({0, 0}, 1, {.except = handle}).size() + world.snapshot().size();

  IgnoredPairs ignored;
  ignored.insert({BoxId(0), BoxId(1)});
  ignored.for_each(count);
  std::vector<Pair> pairs;
  std::vector<Pair> scratch;
  PairCollector collector(pairs);
  collector.add(BoxId(1), BoxId(0));
  collector.flush();
  sort_pairs(pairs, scratch);

  const History<2> history = history_of(Frame<2>{.boxes = boxes});
  ShadowTracker<2> shadow("grid");
  shadow.update(Replay(history).frame(), collector, collector);
  std::vector<Box2> few = boxes;
  minimise(few, [](std::span<const Box2> some) { return !some.empty(); });
  return found + outline(Spec("grid"), std::span<const Box2>(few)).levels.size();
}

}  // namespace

int main() { return all_calls({{{0, 0}, {2, 2}}, {{1, 1}, {3, 3}}}) > 0 ? 0 : 1; }
