// Records physics engines from crates.io (tools/lab/peers/rust) that run scenes, with the pairs of their
// broad phases, for `broadside verify` to check. Usage: record_engine ENGINE SCENE NAME [BODIES [STEPS
// [DROP]]]. From step DROP on, one pair is left out, as if the broad phase had missed it.
//
// Bodies are boxes and balls of about 1 m; a step takes 1/60 s. Every scene works in 2D and in 3D.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "broadside/recorder.hpp"

#include "bench/guarded.hpp"
#include "lab/peers/rust/include/rust_peers.h"
#include "lab/scenes/random.hpp"

namespace {

constexpr float pi = 3.14159265F;

RustVector operator+(RustVector a, RustVector b) {
  return {a.at[0] + b.at[0], a.at[1] + b.at[1], a.at[2] + b.at[2]};
}

void check(bool success) {
  if (!success) throw std::runtime_error(rust_peer_error());
}

/// An engine's world and its bodies; a body's number is its slot.
class World {
 public:
  World(const char* engine, std::size_t count) : simulation_(rust_simulation_new(engine)), count_(count) {
    check(simulation_ != nullptr);
  }

  RustSimulation* simulation() const { return simulation_.get(); }
  int dimension() const { return rust_simulation_dimension(simulation()); }
  const std::vector<RustBody>& bodies() const { return bodies_; }
  bool is_there(std::uint32_t slot) const { return is_there_[slot]; }

  /// The number of bodies still missing.
  std::size_t wanted() const { return count_ - std::min(count_, bodies_.size()); }

  float between(double low, double high) { return static_cast<float>(random_.between(low, high)); }
  std::uint32_t any_slot() { return static_cast<std::uint32_t>(random_.below(bodies_.size())); }

  /// Sets the coordinate of the scene's origin, the same on each axis.
  void set_origin(float origin) { origin_ = {origin, origin, origin}; }

  void set_gravity(RustVector gravity) { check(rust_simulation_set_gravity(simulation(), &gravity)); }

  void add(RustBodyKind kind, RustVector position, RustVector half, bool is_ball = false, float angle = 0,
           float spin = 0) {
    bodies_.push_back({position, half, angle, spin, kind, is_ball});
    is_there_.push_back(false);
    add_again(static_cast<std::uint32_t>(bodies_.size() - 1), position);
  }

  void add_again(std::uint32_t slot, RustVector position) {
    RustBody body = bodies_[slot];
    body.position = origin_ + position;
    check(rust_simulation_add(simulation(), slot, &body));
    is_there_[slot] = true;
  }

  void add_static(RustVector position, RustVector half, float angle = 0) {
    add(rust_body_static, position, half, false, angle);
  }

  void add_box(RustVector position, RustVector half) { add(rust_body_dynamic, position, half); }

  void add_ball(RustVector position, float radius) {
    add(rust_body_dynamic, position, {radius, radius, radius}, true);
  }

  /// A box, or every third time a ball.
  void add_any(RustVector position) {
    if (bodies_.size() % 3 == 0)
      add_ball(position, between(0.3, 0.6));
    else
      add_box(position, {between(0.3, 0.6), between(0.3, 0.6), between(0.3, 0.6)});
  }

  void remove(std::uint32_t slot) {
    check(rust_simulation_remove(simulation(), slot));
    is_there_[slot] = false;
  }

  void place(std::uint32_t slot, RustVector position, RustVector velocity = {}) {
    position = origin_ + position;
    check(rust_simulation_place(simulation(), slot, &position, &velocity));
  }

  RustBounds bounds(std::uint32_t slot) const {
    RustBounds bounds;
    check(rust_simulation_bounds(simulation(), slot, &bounds));
    return bounds;
  }

 private:
  struct Free {
    void operator()(RustSimulation* simulation) const { rust_simulation_free(simulation); }
  };

  std::unique_ptr<RustSimulation, Free> simulation_;
  std::size_t count_;
  broadside::lab::Random random_{1};
  RustVector origin_{};
  std::vector<RustBody> bodies_;
  std::vector<bool> is_there_;
};

/// What a scene does to its world before each step.
using Script = std::function<void(std::size_t step)>;

/// Adds the missing bodies on a lattice above y = 0, in a container that reaches down to y = -room. Returns
/// half of the container's width.
float fill_container(World& world, float room = 0) {
  const int dimension = world.dimension();
  const float spacing = dimension == 2 ? 1.6F : 1.8F;
  const auto count = static_cast<double>(world.wanted());
  const auto columns = static_cast<std::size_t>(std::ceil(std::pow(count, 1.0 / dimension)));
  const std::size_t per_layer = dimension == 2 ? columns : columns * columns;
  const float half = spacing * static_cast<float>(columns) / 2;
  const float half_height = half + room / 2 + spacing;
  const float middle = half_height - room;
  for (const float side : {-1.0F, 1.0F}) {
    world.add_static({side * (half + 1), middle, 0}, {1, half_height, half});
    world.add_static({0, middle + side * (half_height + 1), 0}, {half + 2, 1, half + 2});
    if (dimension == 3) world.add_static({0, middle, side * (half + 1)}, {half, half_height, 1});
  }
  for (std::size_t i = 0; world.wanted() > 0; ++i) {
    const auto along = [&](std::size_t cell) {
      return spacing * (static_cast<float>(cell) + world.between(0.4, 0.6));
    };
    const float x = along(i % columns) - half;
    const float z = dimension == 2 ? 0 : along(i / columns % columns) - half;
    world.add_any({x, along(i / per_layer), z});
  }
  return half;
}

Script free_fall(World& world) {
  world.set_gravity({0, -10, 0});
  fill_container(world);
  return [](std::size_t) {};
}

/// Gravity turns once in three seconds, and its plane more slowly.
Script turning_gravity(World& world) {
  fill_container(world);
  return [&world](std::size_t step) {
    const float angle = static_cast<float>(step) * 2 * pi / 180;
    world.set_gravity({10 * std::sin(angle), -10 * std::cos(angle), 5 * std::sin(0.37F * angle)});
  };
}

/// Bodies fall onto a beam that turns.
Script tumbler(World& world) {
  world.set_gravity({0, -10, 0});
  const float half =
      std::pow(static_cast<float>(world.wanted()), 1.0F / static_cast<float>(world.dimension())) / 2;
  world.add(rust_body_kinematic, {0, -1.5F * half, 0}, {1.4F * half, 0.3F, 1.2F * half}, false, 0, 1);
  fill_container(world, 3 * half);
  return [](std::size_t) {};
}

/// Bodies fall past slanting platforms; those that leave the scene below start again above.
Script rain(World& world) {
  world.set_gravity({0, -10, 0});
  const bool is_flat = world.dimension() == 2;
  const auto count = static_cast<float>(world.wanted());
  const float side = is_flat ? std::sqrt(2.5F * count) : std::cbrt(4 * count);
  const float depth = is_flat ? 0 : side;
  for (float platforms = count / 20; platforms >= 1; --platforms) {
    world.add_static({world.between(0, side), world.between(0, side), world.between(0, depth)},
                     {world.between(0.5, 2.5), 0.2F, world.between(0.5, 2.5)}, world.between(-0.5, 0.5));
  }
  while (world.wanted() > 0)
    world.add_any({world.between(0, side), world.between(0, 1.2 * side), world.between(0, depth)});
  return [&world, side, depth](std::size_t) {
    for (std::uint32_t slot = 0; slot < world.bodies().size(); ++slot) {
      if (world.bounds(slot).max.at[1] < -2)
        world.place(slot, {world.between(0, side), world.between(side, 1.2 * side), world.between(0, depth)});
    }
  };
}

/// Pyramids stand and sleep, until a ball hits one of them, and then the next.
Script pyramids(World& world) {
  world.set_gravity({0, -10, 0});
  constexpr int rows = 10;
  constexpr std::size_t bodies = 1 + rows * (rows + 1) / 2;
  const std::size_t pyramids = world.wanted() / bodies + 1;
  const float length = 20 * static_cast<float>(pyramids);
  world.add_static({length / 2, -1, 0}, {length, 1, 10});
  std::vector<std::pair<std::uint32_t, RustVector>> balls;
  for (float x = 0; world.wanted() > 0; x += 20) {
    balls.emplace_back(static_cast<std::uint32_t>(world.bodies().size()), RustVector{x, 0.5F, 0});
    world.add_ball(balls.back().second, 0.5F);
    for (int row = 0; row < rows; ++row) {
      for (int i = 0; i < rows - row && world.wanted() > 0; ++i) {
        const float left = x + 5 + 0.55F * static_cast<float>(row);
        world.add_box({left + 1.1F * static_cast<float>(i), 0.5F + 1.02F * static_cast<float>(row), 0},
                      {0.5F, 0.5F, 0.5F});
      }
    }
  }
  return [&world, balls](std::size_t step) {
    constexpr std::size_t first_shot = 150;
    constexpr std::size_t period = 20;
    if (step < first_shot || step % period != 0) return;
    const auto& [ball, home] = balls[(step - first_shot) / period % balls.size()];
    world.place(ball, home, {25, 4, 0});
  };
}

/// Bodies in a container that is `origin` away from 0 on each axis. In the first 20 of every 150 steps, some
/// bodies, static ones among them, jump into others or far away, vanish, and come back.
Script hostile(World& world, float origin) {
  world.set_origin(origin);
  world.set_gravity({0, -10, 0});
  for (int platform = 0; platform < 10; ++platform)
    world.add_static({world.between(-5, 5), world.between(0, 5), 0}, {2, 0.2F, 2}, world.between(-0.5, 0.5));
  const float half = fill_container(world, 5);
  return [&world, half](std::size_t step) {
    if (step % 150 >= 20) return;
    const auto anywhere = [&world](float reach) -> RustVector {
      return {world.between(-reach, reach), world.between(0, reach), world.between(-reach, reach)};
    };
    for (std::size_t i = world.bodies().size() / 50 + 1; i > 0; --i) {
      const std::uint32_t slot = world.any_slot();
      const float reach = i % 5 == 0 ? 2000.0F : half;
      if (!world.is_there(slot))
        world.add_again(slot, anywhere(reach));
      else if (i % 3 == 0)
        world.remove(slot);
      else
        world.place(slot, anywhere(reach), {0, i % 7 == 0 ? 300.0F : 0.0F, 0});
    }
  };
}

Script begin(const std::string& scene, World& world) {
  const std::map<std::string, std::function<Script(World&)>> scenes = {
      {"free_fall", free_fall},
      {"turning_gravity", turning_gravity},
      {"tumbler", tumbler},
      {"rain", rain},
      {"pyramids", pyramids},
      {"hostile", [](World& of) { return hostile(of, 0); }},
      {"hostile_1e5", [](World& of) { return hostile(of, 1e5F); }},
      {"hostile_1e6", [](World& of) { return hostile(of, 1e6F); }},
  };
  const auto found = scenes.find(scene);
  if (found != scenes.end()) return found->second(world);
  std::string names;
  for (const auto& [name, make] : scenes) names += " " + name;
  throw std::runtime_error("no scene '" + scene + "'; expected one of" + names);
}

/// Records the boxes of bodies in NAME.btrace. If the engine keeps enlarged boxes, records these in
/// NAME.enlarged.btrace, with the same pairs and a margin of 0.
template <int D>
class Recording {
 public:
  Recording(World& world, const std::string& name, std::size_t drop) : world_(world), drop_(drop) {
    recorder_.open(name + ".btrace", rust_simulation_margin(world.simulation()));
    enlarged_name_ = name + ".enlarged.btrace";
  }

  void step(const Script& script) {
    script(steps_);
    // A step finds pairs before it moves bodies, so these are the boxes that it uses.
    put_boxes(recorder_, [this](std::uint32_t slot) { return world_.bounds(slot); });
    pairs_.clear();
    check(rust_simulation_step(world_.simulation(), take, this));
    count_ += pairs_.size() / 2;
    put_pairs(recorder_);
    RustBounds bounds;
    if (steps_ == 0 && rust_simulation_enlarged(world_.simulation(), 0, &bounds))
      enlarged_.emplace().open(enlarged_name_, 0);
    if (enlarged_) {
      put_boxes(*enlarged_, [&](std::uint32_t slot) {
        check(rust_simulation_enlarged(world_.simulation(), slot, &bounds));
        return bounds;
      });
      put_pairs(*enlarged_);
    }
    ++steps_;
  }

  /// The number of pairs, over all steps.
  std::size_t close() {
    for (broadside::Recorder<D>* const recorder : {&recorder_, enlarged_ ? &*enlarged_ : nullptr}) {
      if (recorder != nullptr && !recorder->close()) throw std::runtime_error(recorder->error());
    }
    return count_;
  }

 private:
  static bool take(void* context, const std::uint32_t* ids, std::size_t count) {
    auto& self = *static_cast<Recording*>(context);
    self.pairs_.insert(self.pairs_.end(), ids, ids + 2 * count);
    return true;
  }

  template <typename BoundsOf>
  void put_boxes(broadside::Recorder<D>& recorder, BoundsOf bounds_of) {
    for (std::uint32_t slot = 0; slot < world_.bodies().size(); ++slot) {
      if (!world_.is_there(slot)) {
        recorder.remove(slot);
        continue;
      }
      const RustBounds bounds = bounds_of(slot);
      recorder.set(slot, bounds.min.at, bounds.max.at);
      const bool is_static = world_.bodies()[slot].kind != rust_body_dynamic;
      recorder.set_filter(slot, 1, std::numeric_limits<std::uint64_t>::max(), 0, is_static);
    }
  }

  void put_pairs(broadside::Recorder<D>& recorder) {
    for (std::size_t i = steps_ >= drop_ ? 2 : 0; i < pairs_.size(); i += 2)
      recorder.add_pair(pairs_[i], pairs_[i + 1]);
    recorder.end_frame();
  }

  World& world_;
  std::size_t drop_;
  broadside::Recorder<D> recorder_;
  std::optional<broadside::Recorder<D>> enlarged_;
  std::string enlarged_name_;
  std::vector<std::uint32_t> pairs_;  // of the last step, two slots each
  std::size_t count_ = 0;
  std::size_t steps_ = 0;
};

template <int D>
void record(World& world, const Script& script, const char* name, std::size_t steps, std::size_t drop) {
  Recording<D> recording(world, name, drop);
  for (std::size_t step = 0; step < steps; ++step) recording.step(script);
  std::printf("%s: %zu bodies, %zu steps, %zu pairs\n", name, world.bodies().size(), steps,
              recording.close());
}

}  // namespace

int main(int argc, char** argv) {
  return broadside::bench::guarded("record_engine", 1, [&] {
    if (argc < 4 || argc > 7)
      throw std::invalid_argument("expected ENGINE SCENE NAME [BODIES [STEPS [DROP]]]");
    const auto number = [&](int place, std::size_t default_value) {
      return broadside::bench::number_at(argc, argv, place, default_value);
    };
    World world(argv[1], number(4, 1000));
    const std::size_t steps = number(5, 450);
    const std::size_t drop = number(6, std::numeric_limits<std::size_t>::max());
    const Script script = begin(argv[2], world);
    if (world.dimension() == 2)
      record<2>(world, script, argv[3], steps, drop);
    else
      record<3>(world, script, argv[3], steps, drop);
    return 0;
  });
}
