// Cars of five boxes each: a body and four wheels. A crash of two cars is told once, however many of their
// boxes touch, and a car that is towed away ends its crashes.
#include <array>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include <broadside/broadside.hpp>

namespace {

using broadside::Box2;
using broadside::Handle;

const std::array<std::string, 3> names = {"red car", "blue car", "van"};

/// The five boxes of a car that stands at x, as seen from the side and from a little above.
std::array<Box2, 5> boxes_of_car(float x) {
  const auto wheel = [x](float dx, float dy) { return Box2::around({x + dx, dy}, 0.4F); };
  return {Box2{{x - 2, 0.5F}, {x + 2, 2}}, wheel(-1.5F, 0.4F), wheel(1.5F, 0.4F), wheel(-1.5F, 0.6F),
          wheel(1.5F, 0.6F)};
}

}  // namespace

int main() {
  broadside::World2 world;
  broadside::OwnerPairs crashes;
  std::array<float, 3> x = {0, 6, 30};
  const std::array<float, 3> speed = {1, 0, -4};  // per frame
  std::array<std::vector<Handle>, 3> cars;
  for (std::uint32_t car = 0; car < cars.size(); ++car) {
    // Boxes of one group below 0 never pair. The user data is the owner.
    const broadside::Filter of_car{.group = -1 - static_cast<std::int32_t>(car)};
    for (const Box2& box : boxes_of_car(x[car]))
      cars[car].push_back(world.add(box, {.filter = of_car, .user_data = car}));
  }
  for (int frame = 1; frame <= 7; ++frame) {
    for (std::size_t car = 0; car < cars.size(); ++car) {
      x[car] += speed[car];
      const std::array<Box2, 5> boxes = boxes_of_car(x[car]);
      for (std::size_t i = 0; i < cars[car].size(); ++i) world.move(cars[car][i], boxes[i]);
    }
    if (frame == 5) {
      for (const Handle part : cars[1]) world.remove(part);
      cars[1].clear();
    }
    const broadside::Events events = world.update();
    const broadside::OwnerEvents told = crashes.update(events.begun_data, events.ended_data);
    for (const auto& [first, second] : told.begun)
      std::printf("%d: %s and %s crash\n", frame, names[first].c_str(), names[second].c_str());
    for (const auto& [first, second] : told.ended)
      std::printf("%d: %s and %s are apart\n", frame, names[first].c_str(), names[second].c_str());
  }
}
