// The umbrella, which is every public header but the recorder, under the flags that engines compile with: see
// CMakeLists.txt.
#include <vector>

#include <broadside/broadside.hpp>

int main() {
  const std::vector<broadside::Box2> boxes = {{{0, 0}, {2, 2}}, {{1, 1}, {3, 3}}};
  broadside::World2 world("grid");
  world.add({{0, 0}, {1, 1}});
  return broadside::find_pairs(boxes, {.algorithm = "grid"}).size() == 1 && world.update().begun.empty() ? 0
                                                                                                         : 1;
}
