// A program whose library has `grid` alone, in 2D. Exit status 0 if that finds pairs, and another name and 3D
// are refused.
#include <cstdio>
#include <string>
#include <vector>

#include "broadside/broadside.hpp"

namespace {

using namespace broadside;

/// Whether a call throws InvalidSpec with this message.
template <typename Call>
bool refuses(const Call& call, const std::string& message) {
  try {
    call();
  } catch (const InvalidSpec& error) {
    if (error.what() == message) return true;
    std::fprintf(stderr, "trimmed: %s\n", error.what());
  }
  return false;
}

}  // namespace

int main() {
  const std::vector<Box2> boxes = {{{0, 0}, {2, 2}}, {{1, 1}, {3, 3}}, {{9, 9}, {9, 9}}};
  if (algorithms().size() != 1 || find_pairs(boxes, {.algorithm = "grid"}).size() != 1) {
    std::fprintf(stderr, "trimmed: expected grid alone, and one pair by it\n");
    return 1;
  }
  World2 world("grid");
  for (const Box2& box : boxes) world.add(box);
  if (world.update().begun.size() != 1) return 1;
  const bool refuses_names = refuses([&] { return find_pairs(boxes, {.algorithm = "bvh"}); },
                                     "unknown algorithm 'bvh'; expected one of: grid");
  const bool refuses_3d = refuses([] { World3("grid"); }, "grid does not support 3D; expected 2D boxes");
  return refuses_names && refuses_3d ? 0 : 1;
}
