// A user's program: pairs in one call, by a spec, frame after frame, and an error caught across the library's
// border. Exit status 0 if all is as promised.
#include <cstdio>
#include <vector>

#include "broadside/broadside.hpp"

using namespace broadside;

World2 world;  // no namespace of the library has the name of a variable that users have

namespace {

int failures = 0;

void expect(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "consumer: expected %s\n", what);
  ++failures;
}

}  // namespace

int main() {
  const std::vector<Box2> boxes = {{{0, 0}, {2, 2}}, {{1, 1}, {3, 3}}, {{3, 3}, {4, 4}}, {{9, 9}, {9, 9}}};

  expect(find_pairs(boxes).size() == 2, "two pairs from the default algorithm");
  for (const Algorithm& algorithm : algorithms()) {
    if (algorithm.has_dimension(2))
      expect(find_pairs(boxes, {.algorithm = algorithm.name}).size() == 2, algorithm.name.c_str());
  }
  world.add(boxes[0]);
  expect(world.size() == 1, "a box in a world");
  PairCounter counter;
  find_pairs(boxes, counter, {.algorithm = "brute_force"});
  expect(counter.count() == 2, "two pairs counted");

  world = World2("brute_force");
  const Handle still = world.add(boxes[0]);
  const Handle moving = world.add(boxes[3]);
  expect(world.update().begun.empty(), "no pair at first");
  world.move(moving, boxes[1]);
  expect(world.update().begun.size() == 1, "a pair to begin");
  world.remove(still);
  expect(world.update().ended.size() == 1, "the pair to end");

  try {
    static_cast<void>(find_pairs(boxes, {.algorithm = "no_such_algorithm"}));
    expect(false, "an unknown algorithm to be refused");
  } catch (const InvalidSpec&) {
  }
  return failures == 0 ? 0 : 1;
}
