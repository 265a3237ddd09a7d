// A program whose library has `grid` alone. Exit status 0 if that finds pairs and another name is refused.
#include <cstdio>
#include <string>
#include <vector>

#include "broadside/broadside.hpp"

int main() {
  using namespace broadside;
  const std::vector<Box2> boxes = {{{0, 0}, {2, 2}}, {{1, 1}, {3, 3}}, {{9, 9}, {9, 9}}};
  if (algorithms().size() != 1 || find_pairs(boxes, "grid").size() != 1) {
    std::fprintf(stderr, "trimmed: expected grid alone, and one pair by it\n");
    return 1;
  }
  World2 world("grid");
  for (const Box2& box : boxes) world.add(box);
  if (world.update().begun.size() != 1) return 1;
  try {
    find_pairs(boxes, "bvh");
  } catch (const InvalidSpec& error) {
    const std::string text = error.what();
    if (text == "unknown algorithm 'bvh'; expected one of: grid") return 0;
    std::fprintf(stderr, "trimmed: %s\n", text.c_str());
  }
  return 1;
}
