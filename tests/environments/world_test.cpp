// Worlds and queries in every floating-point environment: they tell and keep what they do in the default one.
#include "broadside/world.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/error.hpp"
#include "broadside/find_pairs.hpp"
#include "broadside/finder.hpp"

#include "environment.hpp"
#include "tests/laws/hard_inputs.hpp"

namespace broadside::laws {
namespace {

/// All that was told, as integers, which no environment changes.
class Log {
 public:
  void add(std::uint64_t number) { numbers_.push_back(number); }
  void add(float number) { add(std::uint64_t{std::bit_cast<std::uint32_t>(number)}); }
  void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
  void add(Handle handle) { add(std::uint64_t{handle.slot} << 32 | handle.generation); }
  void add(std::span<const HandlePair> pairs) {
    add(std::uint64_t{pairs.size()});
    for (const HandlePair& pair : pairs) {
      add(pair.first);
      add(pair.second);
    }
  }
  void add(const Events& events) {
    add(events.begun);
    add(events.ended);
  }
  void add(const std::vector<std::byte>& bytes) {
    add(std::uint64_t{bytes.size()});
    for (const std::byte byte : bytes) add(std::to_integer<std::uint64_t>(byte));
  }

  friend bool operator==(const Log&, const Log&) = default;

 private:
  std::vector<std::uint64_t> numbers_;
};

/// Asks all kinds of queries.
template <int D, typename Real>
void ask(const World<D, Real>& world, const Box<D, Real>& box, Log& log) {
  const auto add = [&log](Handle handle) { log.add(handle); };
  world.overlapping(box, add);
  world.containing(box.max, add);
  std::vector<HandleNeighbour> nearest;
  world.nearest(box.max, 5, nearest);
  for (const HandleNeighbour& near : nearest) {
    log.add(near.handle);
    log.add(near.distance_squared);
    log.add(distance_squared(box.max, world.box(near.handle)));
  }
  BoxCast<D, Real> cast{.box = box, .direction = {}, .t_max = 3};
  for (int axis = 0; axis < D; ++axis) {
    if (!std::isfinite(box.min[axis]) || !std::isfinite(box.max[axis])) return;
    cast.direction[axis] = axis == 0 ? Real(1) / 3 : Real(-2) / 7;
  }
  world.hits(cast, [&log](Handle handle, Real entry) {
    log.add(handle);
    log.add(entry);
  });
  if (const auto hit = world.first_hit(cast)) log.add(hit->handle);
}

/// What a world of these boxes tells, whatever happens to it.
template <int D, typename Real>
Log life_of(const std::vector<Box<D, Real>>& boxes, double margin, WorldEvents events) {
  Log log;
  WorldOptions options;
  options.margin = margin;
  options.events = events;
  World<D, Real> world(options);
  std::vector<Handle> handles;
  for (const Box<D, Real>& box : boxes) handles.push_back(world.add(box));
  log.add(world.update());
  for (std::size_t i = 0; i < boxes.size(); i += 3) world.move(handles[i], boxes[i * 7 % boxes.size()]);
  for (std::size_t i = 1; i < boxes.size(); i += 5) world.remove(handles[i]);
  log.add(world.update());
  for (std::size_t i = 0; i < boxes.size(); i += boxes.size() / 8 + 1) ask(world, boxes[i], log);

  std::array<Real, D> origin;
  origin.fill(Real(1) / 7);
  world.shift_origin(origin);
  const std::vector<std::byte> snapshot = world.snapshot();
  log.add(snapshot);
  log.add(world.update());
  World<D, Real> restored(options);
  restored.restore(snapshot);
  log.add(restored.snapshot());
  log.add(restored.update());
  std::vector<HandlePair> joined;
  world.join(restored, joined);
  log.add(joined);
  return log;
}

template <typename Kind>
class WorldInEnvironments : public testing::Test {};

template <int Dimension, typename Coordinate>
struct Kind {
  static constexpr int dimension = Dimension;
  using Real = Coordinate;
};

using Kinds = testing::Types<Kind<2, float>, Kind<3, float>, Kind<2, double>, Kind<3, double>>;
TYPED_TEST_SUITE(WorldInEnvironments, Kinds);

TYPED_TEST(WorldInEnvironments, TellsAndKeepsTheSame) {
  constexpr int dimension = TypeParam::dimension;
  using Real = typename TypeParam::Real;
  std::size_t turn = 0;
  for (const Input<dimension>& input : hard_inputs<dimension>(Algorithm{}, 50)) {
    std::vector<Box<dimension, Real>> boxes;
    for (const Box<dimension>& box : input.boxes) {
      if (is_absent(box)) continue;
      Box<dimension, Real>& added = boxes.emplace_back();
      std::copy(box.min.begin(), box.min.end(), added.min.begin());
      std::copy(box.max.begin(), box.max.end(), added.max.begin());
    }
    if (boxes.size() > 200) continue;
    for (const auto& [margin, events] :
         {std::pair(0.0, WorldEvents::exact), std::pair(0.1, WorldEvents::exact),
          std::pair(0.1, WorldEvents::enlarged)}) {
      const Log expected = life_of(boxes, margin, events);
      // The one with most in it, and another in turn.
      for (const Environment* environment : {&environments()[++turn % environments().size()], &hardest()}) {
        const InEnvironment in(*environment);
        EXPECT_TRUE(life_of(boxes, margin, events) == expected)
            << input.name << ", " << environment->name << ", margin " << margin;
      }
    }
  }
}

TYPED_TEST(WorldInEnvironments, RefusesWhatIsNoBoxByValue) {
  constexpr int dimension = TypeParam::dimension;
  using Real = typename TypeParam::Real;
  constexpr Real smallest = std::numeric_limits<Real>::denorm_min();
  Box<dimension, Real> box{};
  box.min[0] = 2 * smallest;
  box.max[0] = smallest;
  Box<dimension, Real> point{};
  point.min.fill(smallest);
  point.max.fill(smallest);
  for (const Environment& environment : environments()) {
    const InEnvironment in(environment);
    World<dimension, Real> world;
    const Handle handle = world.add(point);
    EXPECT_THROW(world.add(box), InvalidInput) << environment.name;
    EXPECT_THROW(world.move(handle, box), InvalidInput) << environment.name;
    EXPECT_THROW(static_cast<void>(find_pairs(std::vector{point, box})), InvalidInput) << environment.name;
    WorldOptions options;
    options.bad_input = BadInput::quarantine;
    World<dimension, Real> lenient(options);
    const Handle quarantined = lenient.add(box);
    EXPECT_EQ(lenient.quarantined(), std::vector{quarantined}) << environment.name;
  }
}

}  // namespace
}  // namespace broadside::laws
