// Bullet on Broadside's broad phase and on its own: bullet [PART...] [options], one table per part.
//
//   stage      the broad phase alone: the recorded boxes of a simulation, replayed to both in turns
//   rays       the same, with a hundred rays through the scene after each step
//   step       two simulations in turns: Bullet's broad-phase stage, and the whole step
//   manifolds  the transforms of one simulation, applied to two more: in how many frames do contacts differ?
//   drift      two simulations: energy and penetration over all steps
#include "broadside/bullet.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <stdexcept>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "bench/engines/bullet_replay.hpp"
#include "bench/engines/bullet_simulation.hpp"
#include "bench/guarded.hpp"
#include "lab/scenes/random.hpp"

namespace broadside::bench {
namespace {

struct BulletBenchmarkOptions {
  std::vector<std::string> scenes;
  std::size_t bodies = 5000;
  std::size_t steps = 600;
  std::size_t rounds = 3;
  WorldOptions options = BulletBroadphase::standard_options();
};

std::unique_ptr<btBroadphaseInterface> bullets() { return std::make_unique<btDbvtBroadphase>(); }
std::unique_ptr<btBroadphaseInterface> ours(const BulletBenchmarkOptions& benchmark) {
  return std::make_unique<BulletBroadphase>(benchmark.options);
}

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

/// A finished simulation on Bullet's own broad phase, and the calls that it made to the broad phase.
struct Recorded {
  Recorded(const std::string& scene, const BulletBenchmarkOptions& benchmark)
      : Recorded(scene, benchmark, std::make_unique<NotedCalls>()) {}

  const NotedCalls& recording;
  Simulation simulation;

 private:
  Recorded(const std::string& scene, const BulletBenchmarkOptions& benchmark,
           std::unique_ptr<NotedCalls> broadphase)
      : recording(*broadphase), simulation(scene, benchmark.bodies, std::move(broadphase)) {
    for (std::size_t step = 0; step < benchmark.steps; ++step) simulation.step();
  }
};

/// Throws unless both hold the same overlapping pairs. Pairs that overlap only because of enlarged boxes may
/// differ.
void check_pairs(BulletReplay& one, BulletReplay& other, std::size_t step) {
  const auto pairs = one.overlapping_pairs();
  const auto others = other.overlapping_pairs();
  if (pairs == others) return;
  throw std::runtime_error(
      fmt::format("step {}: {} pairs overlap by Bullet and {} by ours; expected the same", step, pairs.size(),
                  others.size()));
}

void stage(const BulletBenchmarkOptions& benchmark) {
  print_times_heading();
  for (const std::string& scene : benchmark.scenes) {
    const Recorded recorded(scene, benchmark);
    std::vector<double> bullets_us(benchmark.steps, 1e30);
    std::vector<double> ours_us(benchmark.steps, 1e30);
    for (std::size_t round = 0; round < benchmark.rounds; ++round) {
      BulletReplay one(recorded.recording, bullets());
      BulletReplay other(recorded.recording, ours(benchmark));
      for (std::size_t step = 0; step < benchmark.steps; ++step) {
        bullets_us[step] = std::min(bullets_us[step], one.step(step));
        ours_us[step] = std::min(ours_us[step], other.step(step));
        if (round == 0) check_pairs(one, other, step);
      }
      if (round + 1 == benchmark.rounds)
        fmt::print("{}: {} boxes, {} and {} pairs at the end\n", scene, recorded.simulation.size(),
                   one.pairs(), other.pairs());
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

/// Microseconds for a hundred rays from wall to wall.
double cast_rays(btBroadphaseInterface& broadphase, btScalar half_width, std::uint64_t seed,
                 std::size_t& met) {
  lab::Random random(seed);
  std::vector<std::pair<btVector3, btVector3>> rays;
  for (int i = 0; i < 100; ++i) {
    const btScalar z = half_width * btScalar(random.between(-1, 1));
    const btScalar low = half_width * btScalar(random.between(0, 1));
    const btScalar high = half_width * btScalar(random.between(0, 1));
    rays.push_back({{-half_width, low, z}, {half_width, high, -z}});
  }
  const ThreadStopwatch watch;
  for (const auto& [from, to] : rays) {
    CountingRay ray(from, to);
    broadphase.rayTest(from, to, ray);
    met += ray.met;
  }
  return watch.microseconds();
}

void rays(const BulletBenchmarkOptions& benchmark) {
  print_times_heading();
  for (const std::string& scene : benchmark.scenes) {
    const Recorded recorded(scene, benchmark);
    BulletReplay one(recorded.recording, bullets());
    BulletReplay other(recorded.recording, ours(benchmark));
    std::vector<double> rays_us[2];
    std::vector<double> both_us[2];
    std::size_t met[2] = {0, 0};
    const btScalar half_width = recorded.recording.created[0].call.max.x();  // of the ground
    for (std::size_t step = 0; step < benchmark.steps; ++step) {
      for (const int turn : {0, 1}) {
        BulletReplay& replay = turn == 0 ? one : other;
        const double stage_us = replay.step(step);
        rays_us[turn].push_back(cast_rays(replay.broadphase(), half_width, step + 1, met[turn]));
        both_us[turn].push_back(stage_us + rays_us[turn].back());
      }
    }
    fmt::print("{}: {} boxes; a ray meets {:.0f} boxes of Bullet's and {:.0f} of ours\n", scene,
               recorded.simulation.size(), double(met[0]) / double(100 * benchmark.steps),
               double(met[1]) / double(100 * benchmark.steps));
    print_times(scene, "100 rays", rays_us[0], rays_us[1]);
    print_times(scene, "with the stage", both_us[0], both_us[1]);
  }
}

void step(const BulletBenchmarkOptions& benchmark) {
  print_times_heading();
  for (const std::string& scene : benchmark.scenes) {
    Simulation one(scene, benchmark.bodies, bullets());
    Simulation other(scene, benchmark.bodies, ours(benchmark));
    std::vector<double> stage_us[2];
    std::vector<double> step_us[2];
    for (std::size_t step = 0; step < benchmark.steps; ++step) {
      for (const std::size_t turn : {step % 2, 1 - step % 2}) {
        Simulation& simulation = turn == 0 ? one : other;
        simulation.world().stage_us = 0;
        const ThreadStopwatch watch;
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

void manifolds(const BulletBenchmarkOptions& benchmark) {
  fmt::print("\n{:<8} {:>7} {:>20} {:>22}\n", "", "frames", "contacts at the end", "frames that differ");
  for (const std::string& scene : benchmark.scenes) {
    Simulation moving(scene, benchmark.bodies, bullets());
    Simulation one(scene, benchmark.bodies, bullets());
    Simulation other(scene, benchmark.bodies, ours(benchmark));
    std::size_t different = 0;
    for (std::size_t step = 0; step < benchmark.steps; ++step) {
      moving.step();
      one.detect(moving);
      other.detect(moving);
      different += one.contacts() != other.contacts() ? 1 : 0;
    }
    fmt::print("{:<8} {:>7} {:>20} {:>22}\n", scene, benchmark.steps, other.sums().contacts, different);
  }
}

void drift(const BulletBenchmarkOptions& benchmark) {
  fmt::print("\n{:<8} {:>29}   {:>29}\n{:<8} {:>9} {:>9} {:>9}   {:>9} {:>9} {:>9}\n", "", "energy, kJ, mean",
             "penetration, mm a contact", "", "Bullet", "ours", "differ", "Bullet", "ours", "differ");
  for (const std::string& scene : benchmark.scenes) {
    Simulation one(scene, benchmark.bodies, bullets());
    Simulation other(scene, benchmark.bodies, ours(benchmark));
    Sums all[2];
    for (std::size_t step = 0; step < benchmark.steps; ++step) {
      for (const int which : {0, 1}) {
        Simulation& simulation = which == 0 ? one : other;
        simulation.step();
        const Sums now = simulation.sums();
        all[which].energy += now.energy / double(benchmark.steps) / 1000;
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
  const std::vector<std::pair<std::string, void (*)(const BulletBenchmarkOptions&)>> parts = {
      {"stage", stage}, {"rays", rays}, {"step", step}, {"manifolds", manifolds}, {"drift", drift}};
  std::vector<std::string> names;
  for (const auto& [name, part] : parts) names.push_back(name);
  BulletBenchmarkOptions benchmark;
  for (const BulletScene& scene : bullet_scenes()) benchmark.scenes.push_back(scene.name);
  std::vector<std::string> wanted;

  CLI::App program("Bullet over Broadside's broad phase and over its own.");
  program.add_option("parts", wanted, "stage, rays, step, manifolds, drift; all unless some are named")
      ->check(CLI::IsMember(names));
  program.add_option("--scenes", benchmark.scenes, "fall, sheet, statics")
      ->delimiter(',')
      ->check(CLI::IsMember(benchmark.scenes));
  program.add_option("-n", benchmark.bodies, "Bodies")->capture_default_str()->check(CLI::PositiveNumber);
  program.add_option("--steps", benchmark.steps, "Steps of a simulation")
      ->capture_default_str()
      ->check(CLI::Range(std::size_t{3}, std::size_t{1000000}));
  program
      .add_option("--rounds", benchmark.rounds, "Of each step of `stage`, the least time of so many counts")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  program.add_option("--algorithm", benchmark.options.algorithm, "The world's")->capture_default_str();
  program.add_option("--margin", benchmark.options.margin, "By how much boxes are enlarged, in metres")
      ->capture_default_str();
  program.add_flag_callback(
      "--exact", [&] { benchmark.options = {.algorithm = benchmark.options.algorithm}; },
      "Pairs of the boxes themselves instead of enlarged ones");
  CLI11_PARSE(program, count, arguments);
  for (const auto& [name, part] : parts) {
    if (wanted.empty() || std::ranges::find(wanted, name) != wanted.end()) part(benchmark);
  }
  return 0;
}

}  // namespace
}  // namespace broadside::bench

int main(int count, char** arguments) {
  using namespace broadside::bench;
  return guarded("bullet", 1, [&] { return run(count, arguments); });
}
