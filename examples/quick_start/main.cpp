// The example in the README: all pairs in one call, and boxes followed from frame to frame.
#include <cstdio>
#include <vector>

#include <broadside/broadside.hpp>

int main() {
  std::vector<broadside::Box2> boxes = {{{0, 0}, {2, 2}}, {{1, 1}, {3, 3}}, {{5, 5}, {6, 6}}};
  for (const auto [a, b] : broadside::find_pairs(boxes)) {  // once: boxes 0 and 1 overlap
    std::printf("%u and %u\n", a, b);
  }

  broadside::World2 world;  // or frame after frame, under stable handles
  const broadside::Handle ball = world.add({{0, 0}, {1, 1}});
  world.add({{3, 0}, {4, 1}});
  world.update();  // begun and ended pairs since the last update: none yet
  world.move(ball, {{2.5F, 0}, {3.5F, 1}});
  for (const auto& [first, second] : world.update().begun)
    std::printf("%u touches %u\n", first.slot, second.slot);
}
