// Bullet over Broadside's broad phase and over its own: bullet [PART...] [options], each part a table.
//
// stage      the broad phase alone: the boxes of a simulation, recorded and set in both, in turns
// step       two simulations, in turns: the broad-phase stage as Bullet knows it, and the whole step
// manifolds  the transforms of one simulation in two more: in how many frames do contacts differ?
// drift      two simulations: energy and penetration over all steps
#include "broadside/bullet.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "bench/engines/bullet_simulation.hpp"
#include "bench/guarded.hpp"

namespace broadside::bench {
namespace {

struct Wishes {
  std::vector<std::string> scenes;
  std::size_t bodies = 5000;
  std::size_t steps = 600;
  std::size_t rounds = 3;
  WorldOptions options;
};

std::unique_ptr<btBroadphaseInterface> bullets() { return std::make_unique<btDbvtBroadphase>(); }
std::unique_ptr<btBroadphaseInterface> ours(const Wishes& wishes) {
  return std::make_unique<BulletBroadphase>(wishes.options);
}

/// A box that was set, by the proxy's place in the order of creation.
struct Call {
  int proxy;
  btVector3 min;
  btVector3 max;
};

/// Bullet's broad phase, which notes what it is told.
class Recording final : public btDbvtBroadphase {
 public:
  struct Created {
    Call call;
    int group;
    int mask;
  };

  btBroadphaseProxy* createProxy(const btVector3& min, const btVector3& max, int type, void* client,
                                 int group, int mask, btDispatcher* dispatcher) override {
    btBroadphaseProxy* const proxy =
        btDbvtBroadphase::createProxy(min, max, type, client, group, mask, dispatcher);
    places_[proxy] = static_cast<int>(created.size());
    created.push_back({{places_[proxy], min, max}, group, mask});
    return proxy;
  }
  void setAabb(btBroadphaseProxy* proxy, const btVector3& min, const btVector3& max,
               btDispatcher* dispatcher) override {
    calls.push_back({places_.at(proxy), min, max});
    btDbvtBroadphase::setAabb(proxy, min, max, dispatcher);
  }
  void calculateOverlappingPairs(btDispatcher* dispatcher) override {
    ends.push_back(calls.size());
    btDbvtBroadphase::calculateOverlappingPairs(dispatcher);
  }

  std::vector<Created> created;
  std::vector<Call> calls;
  std::vector<std::size_t> ends;  ///< where the calls of each step end

 private:
  std::map<btBroadphaseProxy*, int> places_;
};

/// A recording played to a broad phase.
class Replay {
 public:
  Replay(const Recording& recording, std::unique_ptr<btBroadphaseInterface> broadphase)
      : recording_(recording), broadphase_(std::move(broadphase)) {
    for (const Recording::Created& made : recording.created)
      proxies_.push_back(
          broadphase_->createProxy(made.call.min, made.call.max, 0, nullptr, made.group, made.mask, nullptr));
  }

  /// The microseconds that a step takes.
  double step(std::size_t number) {
    const std::size_t first = number == 0 ? 0 : recording_.ends[number - 1];
    const Stopwatch watch;
    for (std::size_t i = first; i < recording_.ends[number]; ++i) {
      const Call& call = recording_.calls[i];
      broadphase_->setAabb(proxies_[static_cast<std::size_t>(call.proxy)], call.min, call.max, nullptr);
    }
    broadphase_->calculateOverlappingPairs(nullptr);
    return watch.microseconds();
  }

  int pairs() const { return broadphase_->getOverlappingPairCache()->getNumOverlappingPairs(); }

 private:
  const Recording& recording_;
  std::unique_ptr<btBroadphaseInterface> broadphase_;
  std::vector<btBroadphaseProxy*> proxies_;
};

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

double quantile(std::vector<double> values, double part) {
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(part * double(values.size() - 1))];
}

void print_times(const std::string& scene, const std::string& what, const std::vector<double>& bullets_us,
                 const std::vector<double>& ours_us) {
  fmt::print("{:<8} {:<14} {:>9.0f} {:>9.0f} {:>9.0f}   {:>9.0f} {:>9.0f} {:>9.0f}   {:>6.2f} {:>6.2f}\n",
             scene, what, mean(bullets_us), quantile(bullets_us, 0.5), quantile(bullets_us, 0.99),
             mean(ours_us), quantile(ours_us, 0.5), quantile(ours_us, 0.99), mean(bullets_us) / mean(ours_us),
             quantile(bullets_us, 0.5) / quantile(ours_us, 0.5));
}

void print_times_heading() {
  fmt::print(
      "\n{:<23} {:>29}   {:>29}   {:>13}\n{:<23} {:>9} {:>9} {:>9}   {:>9} {:>9} {:>9}   {:>6} {:>6}\n", "",
      "btDbvtBroadphase, us a step", "BulletBroadphase, us a step", "times faster", "", "mean", "median",
      "p99", "mean", "median", "p99", "mean", "median");
}

void stage(const Wishes& wishes) {
  print_times_heading();
  for (const std::string& scene : wishes.scenes) {
    auto broadphase = std::make_unique<Recording>();
    const Recording& recording = *broadphase;
    Simulation simulation(scene, wishes.bodies, std::move(broadphase));
    for (std::size_t step = 0; step < wishes.steps; ++step) simulation.step();

    std::vector<double> bullets_us(wishes.steps, 1e30);
    std::vector<double> ours_us(wishes.steps, 1e30);
    for (std::size_t round = 0; round < wishes.rounds; ++round) {
      Replay one(recording, bullets());
      Replay other(recording, ours(wishes));
      for (std::size_t step = 0; step < wishes.steps; ++step) {
        bullets_us[step] = std::min(bullets_us[step], one.step(step));
        ours_us[step] = std::min(ours_us[step], other.step(step));
      }
      if (round + 1 == wishes.rounds)
        fmt::print("{}: {} boxes, {} and {} pairs at the end\n", scene, simulation.size(), one.pairs(),
                   other.pairs());
    }
    const auto part = [&](const std::vector<double>& all, std::size_t third) {
      const std::size_t size = all.size() / 3;
      return std::vector(all.begin() + std::ptrdiff_t(third * size),
                         all.begin() + std::ptrdiff_t((third + 1) * size));
    };
    print_times(scene, "all steps", bullets_us, ours_us);
    for (const std::size_t third : {0, 1, 2})
      print_times(scene, fmt::format("third {}", third + 1), part(bullets_us, third), part(ours_us, third));
  }
}

void step(const Wishes& wishes) {
  print_times_heading();
  for (const std::string& scene : wishes.scenes) {
    Simulation one(scene, wishes.bodies, bullets());
    Simulation other(scene, wishes.bodies, ours(wishes));
    std::vector<double> stage_us[2];
    std::vector<double> step_us[2];
    for (std::size_t step = 0; step < wishes.steps; ++step) {
      for (const std::size_t turn : {step % 2, 1 - step % 2}) {
        Simulation& simulation = turn == 0 ? one : other;
        simulation.world().stage_us = 0;
        const Stopwatch watch;
        simulation.step();
        step_us[turn].push_back(watch.microseconds());
        stage_us[turn].push_back(simulation.world().stage_us);
      }
    }
    fmt::print("{}: {} boxes, {} and {} pairs at the end\n", scene, one.size(), one.pairs(), other.pairs());
    print_times(scene, "stage", stage_us[0], stage_us[1]);
    print_times(scene, "whole step", step_us[0], step_us[1]);
  }
}

void manifolds(const Wishes& wishes) {
  fmt::print("\n{:<8} {:>7} {:>20} {:>22}\n", "", "frames", "contacts at the end", "frames that differ");
  for (const std::string& scene : wishes.scenes) {
    Simulation moving(scene, wishes.bodies, bullets());
    Simulation one(scene, wishes.bodies, bullets());
    Simulation other(scene, wishes.bodies, ours(wishes));
    std::size_t different = 0;
    for (std::size_t step = 0; step < wishes.steps; ++step) {
      moving.step();
      one.detect(moving);
      other.detect(moving);
      different += one.contacts() != other.contacts() ? 1 : 0;
    }
    fmt::print("{:<8} {:>7} {:>20} {:>22}\n", scene, wishes.steps, other.sums().contacts, different);
  }
}

void drift(const Wishes& wishes) {
  fmt::print("\n{:<8} {:>29}   {:>29}\n{:<8} {:>9} {:>9} {:>9}   {:>9} {:>9} {:>9}\n", "", "energy, kJ, mean",
             "penetration, mm a contact", "", "Bullet", "ours", "differ", "Bullet", "ours", "differ");
  for (const std::string& scene : wishes.scenes) {
    Simulation one(scene, wishes.bodies, bullets());
    Simulation other(scene, wishes.bodies, ours(wishes));
    Sums all[2];
    for (std::size_t step = 0; step < wishes.steps; ++step) {
      for (const int which : {0, 1}) {
        Simulation& simulation = which == 0 ? one : other;
        simulation.step();
        const Sums now = simulation.sums();
        all[which].energy += now.energy / double(wishes.steps) / 1000;
        all[which].penetration += now.penetration * 1000;
        all[which].contacts += now.contacts;
      }
    }
    const double depth[2] = {all[0].penetration / double(all[0].contacts),
                             all[1].penetration / double(all[1].contacts)};
    fmt::print("{:<8} {:>9.3f} {:>9.3f} {:>7.2f} %   {:>9.4f} {:>9.4f} {:>7.2f} %\n", scene, all[0].energy,
               all[1].energy, 100 * std::abs(all[1].energy / all[0].energy - 1), depth[0], depth[1],
               100 * std::abs(depth[1] / depth[0] - 1));
  }
}

int run(int count, char** arguments) {
  const std::vector<std::pair<std::string, void (*)(const Wishes&)>> parts = {
      {"stage", stage}, {"step", step}, {"manifolds", manifolds}, {"drift", drift}};
  std::vector<std::string> names;
  for (const auto& [name, part] : parts) names.push_back(name);
  Wishes wishes;
  for (const BulletScene& scene : bullet_scenes()) wishes.scenes.push_back(scene.name);
  std::vector<std::string> wanted;

  CLI::App program("Bullet over Broadside's broad phase and over its own.");
  program.add_option("parts", wanted, "stage, step, manifolds, drift; all unless some are named")
      ->check(CLI::IsMember(names));
  program.add_option("--scenes", wishes.scenes, "fall, sheet, statics")
      ->delimiter(',')
      ->check(CLI::IsMember(wishes.scenes));
  program.add_option("-n", wishes.bodies, "Bodies")->capture_default_str()->check(CLI::PositiveNumber);
  program.add_option("--steps", wishes.steps, "Steps of a simulation")
      ->capture_default_str()
      ->check(CLI::Range(std::size_t{3}, std::size_t{1000000}));
  program.add_option("--rounds", wishes.rounds, "Of each step of `stage`, the least time of so many counts")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  program.add_option("--algorithm", wishes.options.algorithm, "The world's")->capture_default_str();
  program.add_option("--margin", wishes.options.margin, "The world's, in metres")->capture_default_str();
  CLI11_PARSE(program, count, arguments);
  for (const auto& [name, part] : parts) {
    if (wanted.empty() || std::ranges::find(wanted, name) != wanted.end()) part(wishes);
  }
  return 0;
}

}  // namespace
}  // namespace broadside::bench

int main(int count, char** arguments) {
  using namespace broadside::bench;
  return guarded("bullet", 1, [&] { return run(count, arguments); });
}
