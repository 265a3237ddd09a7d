// Compares Broadside as FCL's broad phase with FCL's dynamic tree: fcl_manager [FRAMES [SCENE]].
//
// Both managers hold the same objects, get the same moves and collide all objects, frame by frame, in turns,
// in one thread; times are milliseconds of processor time. The callback hashes its pairs, and the hashes must
// agree. Then both managers answer queries of single objects, with callbacks that cost almost nothing.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <broadside/fcl.hpp>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/sphere.h>
#include <fmt/format.h>

#include "broadside/broadside.hpp"

#include "bench/guarded.hpp"
#include "lab/measure/samples.hpp"
#include "lab/numbers.hpp"
#include "lab/report/machine.hpp"
#include "lab/scenes/motion.hpp"
#include "lab/scenes/scene.hpp"

// FCL's tree of doubles, compiled with this program's flags. Debian's library is slower, because it checks
// Eigen's assertions.
template class fcl::AABB<double>;
template class fcl::DynamicAABBTreeCollisionManager<double>;

namespace broadside::bench {
namespace {

/// Milliseconds of processor time since construction. Everything runs in one thread, and other programs
/// disturb processor time less than wall-clock time.
class ProcessorClock {
 public:
  double milliseconds() const { return static_cast<double>(std::clock() - begin_) * 1e3 / CLOCKS_PER_SEC; }

 private:
  std::clock_t begin_ = std::clock();
};

/// A geometry that consists of its box alone.
template <typename S>
class BoxObject final : public fcl::CollisionObject<S> {
 public:
  BoxObject(const std::shared_ptr<fcl::CollisionGeometry<S>>& geometry, const Box<3, S>& box)
      : fcl::CollisionObject<S>(geometry) {
    set(box);
  }

  void set(const Box<3, S>& box) {
    for (int axis = 0; axis < 3; ++axis) {
      this->aabb.min_[axis] = box.min[axis];
      this->aabb.max_[axis] = box.max[axis];
    }
  }
};

/// The pairs passed to a callback, as a set. An object is identified by its address and never read: reading
/// objects would add their cache misses to the times.
template <typename S>
class CallbackPairs {
 public:
  explicit CallbackPairs(const std::vector<BoxObject<S>>& objects) : first_(objects.data()) {}

  static bool take(fcl::CollisionObject<S>* first, fcl::CollisionObject<S>* second, void* data) {
    auto& set = *static_cast<CallbackPairs*>(data);
    const BoxId a = set.id_of(first);
    const BoxId b = set.id_of(second);
    ++set.count_;
    set.hash_ += hash(a < b ? Pair{a, b} : Pair{b, a});
    return false;
  }

  std::uint64_t count() const { return count_; }
  friend bool operator==(const CallbackPairs&, const CallbackPairs&) = default;

 private:
  BoxId id_of(const fcl::CollisionObject<S>* object) const {
    return BoxId(static_cast<const BoxObject<S>*>(object) - first_);
  }

  const BoxObject<S>* first_;
  std::uint64_t count_ = 0;
  std::uint64_t hash_ = 0;
};

/// The smallest distance of centres found by a distance query, and its callbacks.
struct MinDistance {
  std::uint64_t calls = 0;
  double distance = std::numeric_limits<double>::infinity();

  static bool take(fcl::CollisionObjectd* first, fcl::CollisionObjectd* second, void* data,
                   double& min_distance) {
    if (first == second) return false;  // FCL's tree reports the object itself
    auto& query = *static_cast<MinDistance*>(data);
    ++query.calls;
    query.distance =
        std::min(query.distance, (first->getAABB().center() - second->getAABB().center()).norm());
    min_distance = query.distance;
    return false;
  }
};

/// A manager and its times.
template <typename S>
struct ManagerSide {
  std::unique_ptr<fcl::BroadPhaseCollisionManager<S>> manager;
  std::vector<double> update_ms{};
  std::vector<double> collide_ms{};
  std::vector<double> frame_ms{};

  CallbackPairs<S> run(const std::vector<fcl::CollisionObject<S>*>& moved, CallbackPairs<S> pairs) {
    const ProcessorClock watch;
    if (moved.size() == manager->size())
      manager->update();
    else
      manager->update(moved);
    const double updated = watch.milliseconds();
    manager->collide(&pairs, CallbackPairs<S>::take);
    const double all = watch.milliseconds();
    update_ms.push_back(updated);
    collide_ms.push_back(all - updated);
    frame_ms.push_back(all);
    return pairs;
  }
};

/// Microseconds and number of callbacks of one query by one object.
struct QueryCost {
  double collide_us;
  double distance_us;
  double calls;
};

/// Queries some of the objects; results go to `found`.
QueryCost query_cost(const fcl::BroadPhaseCollisionManagerd& manager,
                     const std::vector<fcl::CollisionObjectd*>& objects,
                     std::vector<std::pair<std::uint64_t, double>>& found) {
  constexpr std::size_t queries = 1000;
  const auto asked = [&](std::size_t query) { return objects[query * (objects.size() / queries)]; };
  const auto count_others = [](fcl::CollisionObjectd* first, fcl::CollisionObjectd* second, void* data) {
    *static_cast<std::uint64_t*>(data) += first != second ? 1 : 0;
    return false;
  };
  found.assign(queries, {});
  const ProcessorClock watch;
  for (std::size_t i = 0; i < queries; ++i) manager.collide(asked(i), &found[i].first, count_others);
  const double collided = watch.milliseconds();
  std::uint64_t calls = 0;
  for (std::size_t i = 0; i < queries; ++i) {
    MinDistance query;
    manager.distance(asked(i), &query, MinDistance::take);
    found[i].second = query.distance;
    calls += query.calls;
  }
  const double all = watch.milliseconds();
  constexpr double us_per_query = 1e3 / queries;
  return {collided * us_per_query, (all - collided) * us_per_query, static_cast<double>(calls) / queries};
}

void compare_queries(const fcl::BroadPhaseCollisionManagerd& tree,
                     const fcl::BroadPhaseCollisionManagerd& own,
                     const std::vector<fcl::CollisionObjectd*>& objects, std::size_t rounds) {
  std::array<std::vector<double>, 2> collide;
  std::array<std::vector<double>, 2> distance;
  std::array<double, 2> calls{};
  std::array<std::vector<std::pair<std::uint64_t, double>>, 2> found;
  for (std::size_t round = 0; round < rounds; ++round) {
    for (const std::size_t side : {round % 2, 1 - round % 2}) {
      const QueryCost cost = query_cost(side == 0 ? tree : own, objects, found[side]);
      collide[side].push_back(cost.collide_us);
      distance[side].push_back(cost.distance_us);
      calls[side] = cost.calls;
    }
    if (found[0] != found[1]) throw std::runtime_error("the managers differ in queries of one object");
  }
  fmt::print("  one object, us: collide {} and {}; distance {} with {:.1f} callbacks, and {} with {:.1f}\n",
             lab::rounded(lab::median(collide[0])), lab::rounded(lab::median(collide[1])),
             lab::rounded(lab::median(distance[0])), calls[0], lab::rounded(lab::median(distance[1])),
             calls[1]);
}

template <typename S>
void compare(std::string_view scene, std::size_t count, double moving, std::size_t frames) {
  const lab::NamedScene named = lab::find_scene(scene);
  std::vector<Box<3, S>> boxes;
  for (const Box3& box : lab::make_history<3>(named.scene, named.spec, {.boxes = count}).boxes) {
    // In doubles, use coordinates that no float holds.
    constexpr S scale = static_cast<S>(3.14159265358979324);
    Box<3, S>& scaled = boxes.emplace_back();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      scaled.min[axis] = scale * box.min[axis];
      scaled.max[axis] = scale * box.max[axis];
    }
  }
  lab::MovingBoxes<3, S> motion(boxes, {.boxes = count, .moving = moving}, false);

  const auto geometry = std::make_shared<fcl::Sphere<S>>(S{1});
  std::vector<BoxObject<S>> objects;
  objects.reserve(count);
  std::vector<fcl::CollisionObject<S>*> pointers;
  for (const Box<3, S>& box : boxes) pointers.push_back(&objects.emplace_back(geometry, box));

  auto tree = std::make_unique<fcl::DynamicAABBTreeCollisionManager<S>>();
  tree->tree_init_level = 2;  // build by sorted Morton codes, as FCL's own tests do
  ManagerSide<S> fcl_side{std::move(tree)};
  ManagerSide<S> own_side{std::make_unique<FclCollisionManager<S>>()};
  for (ManagerSide<S>* side : {&fcl_side, &own_side}) {
    side->manager->registerObjects(pointers);
    side->manager->setup();
  }

  std::uint64_t pairs = 0;
  std::vector<fcl::CollisionObject<S>*> moved;
  constexpr std::size_t warm_up = 5;
  for (std::size_t frame = 0; frame < warm_up + frames; ++frame) {
    if (frame == warm_up) {
      for (ManagerSide<S>* side : {&fcl_side, &own_side})
        side->update_ms = side->collide_ms = side->frame_ms = {};
      pairs = 0;
    }
    const Step<3, S> step = motion.next();
    moved.clear();
    for (std::size_t i = 0; i < step.changed.size(); ++i) {
      objects[index(step.changed[i])].set(step.boxes[i]);
      moved.push_back(pointers[index(step.changed[i])]);
    }
    const bool own_first = frame % 2 == 0;
    const CallbackPairs<S> first = (own_first ? own_side : fcl_side).run(moved, CallbackPairs(objects));
    const CallbackPairs<S> second = (own_first ? fcl_side : own_side).run(moved, CallbackPairs(objects));
    if (first != second)
      throw std::runtime_error(
          fmt::format("frame {}: {} pairs, and {} that are not the same from the other manager", frame,
                      first.count(), second.count()));
    pairs += first.count();
  }
  const auto median = [](const std::vector<double>& times) { return lab::rounded(lab::median(times)); };
  std::vector<double> ratios;
  for (std::size_t i = 0; i < frames; ++i) ratios.push_back(fcl_side.frame_ms[i] / own_side.frame_ms[i]);
  fmt::print("{:<8}{:>9}{:>9}{:>10}  {:>9}{:>9}{:>9}  {:>9}{:>9}{:>9}{:>8.1f}\n",
             sizeof(S) == sizeof(float) ? "float" : "double", lab::grouped(count),
             fmt::format("{:.3g} %", moving * 100), lab::grouped(pairs / frames), median(fcl_side.update_ms),
             median(fcl_side.collide_ms), median(fcl_side.frame_ms), median(own_side.update_ms),
             median(own_side.collide_ms), median(own_side.frame_ms), lab::median(ratios));
  if constexpr (std::is_same_v<S, double>) {
    if (moving == 0.01) compare_queries(*fcl_side.manager, *own_side.manager, pointers, frames);
  }
  std::fflush(stdout);
}

void run(std::size_t frames, const std::string& scene) {
  const lab::Machine machine = lab::this_machine();
  fmt::print("{}, {} frames, FCL " FCL_VERSION "; {}, {} cores; {}\n", scene, frames, machine.cpu,
             machine.cores, lab::this_build().compiler);
  fmt::print("{:<36}  {:>27}  {:>27}\n", "", "FCL's dynamic tree, ms", "Broadside, ms");
  fmt::print("{:<8}{:>9}{:>9}{:>10}  {:>9}{:>9}{:>9}  {:>9}{:>9}{:>9}{:>8}\n", "", "objects", "moving",
             "pairs", "update", "collide", "both", "update", "collide", "both", "ratio");
  for (const std::size_t count : {10'000U, 100'000U}) {
    for (const double moving : {1.0, 0.1, 0.01}) compare<double>(scene, count, moving, frames);
  }
  for (const std::size_t count : {10'000U, 100'000U}) compare<float>(scene, count, 1.0, frames);
}

}  // namespace
}  // namespace broadside::bench

int main(int count, char** arguments) {
  using namespace broadside::bench;
  return guarded("fcl_manager", 1, [&] {
    run(number_at(count, arguments, 1, 40), text_at(count, arguments, 2, "uniform"));
    return 0;
  });
}
