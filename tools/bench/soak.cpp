// Tests whether a World grows over time: soak [FRAMES [SPEC]], with 100,000 boxes, 1 % of them replaced in
// each frame.
//
// Prints the memory of the world and of the process, over the values after the first frames, when slots are
// being reused. Now and then it compares the pairs with those of a search from scratch by another algorithm.
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <unistd.h>

#include "broadside/broadside.hpp"

#include "bench/guarded.hpp"

namespace broadside::bench {
namespace {

constexpr std::size_t count = 100'000;
constexpr std::size_t replaced = count / 100;

/// Resident bytes of the process; 0 if the system does not tell.
double resident_bytes() {
  std::ifstream file("/proc/self/statm");
  double total = 0;
  double resident = 0;
  file >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

class SoakBoxes {
 public:
  Box2 next() {
    const float x = unit() * 1000;
    const float y = unit() * 1000;
    return {{x, y}, {x + 1 + unit(), y + 1 + unit()}};
  }

  std::size_t below(std::size_t end) { return random_() % end; }

 private:
  float unit() { return static_cast<float>(random_() >> 40) * 0x1p-24F; }

  std::mt19937_64 random_{1};
};

void verify(const World2& world, const std::vector<Handle>& handles, std::uint64_t frame) {
  std::vector<Box2> boxes;
  boxes.reserve(handles.size());
  for (const Handle handle : handles) boxes.push_back(world.box(handle));
  const std::size_t expected = find_pairs(boxes, {.algorithm = "sweep_and_prune"}).size();
  for (const HandlePair pair : world.pairs()) {
    if (!overlap(world.box(pair.first), world.box(pair.second)))
      throw std::runtime_error("frame " + std::to_string(frame) + ": a pair that does not overlap");
  }
  if (world.pairs().size() != expected) {
    throw std::runtime_error("frame " + std::to_string(frame) + ": " + std::to_string(world.pairs().size()) +
                             " pairs; expected " + std::to_string(expected));
  }
}

void run(std::uint64_t frames, const std::string& spec) {
  SoakBoxes boxes;
  World2 world(spec);
  std::vector<Handle> handles;
  for (std::size_t i = 0; i < count; ++i) handles.push_back(world.add(boxes.next()));
  world.update();
  verify(world, handles, 0);
  const auto fresh = static_cast<double>(world.statistics().bytes.total());
  const double fresh_resident = resident_bytes();
  std::printf("%zu boxes, %zu replaced a frame, %s\n", count, replaced, spec.c_str());
  std::printf("%10s %12s %10s %12s %10s %8s\n", "frame", "own MiB", "over new", "RSS MiB", "over new", "s");
  const auto begin = std::chrono::steady_clock::now();
  const std::uint64_t step = frames < 10 ? 1 : frames / 10;
  for (std::uint64_t frame = 1; frame <= frames; ++frame) {
    for (std::size_t i = 0; i < replaced; ++i) {
      Handle& handle = handles[boxes.below(count)];
      world.remove(handle);
      handle = world.add(boxes.next());
    }
    world.update();
    if (frame % step != 0 && frame != frames) continue;
    verify(world, handles, frame);
    const auto own = static_cast<double>(world.statistics().bytes.total());
    const double resident = resident_bytes();
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    std::printf("%10llu %12.1f %10.3f %12.1f %10.3f %8.1f\n", static_cast<unsigned long long>(frame),
                own / 1048576, own / fresh, resident / 1048576, resident / fresh_resident, seconds.count());
    std::fflush(stdout);
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  std::printf("1,000,000 frames take about %.1f hours\n",
              seconds.count() / static_cast<double>(frames) * 1e6 / 3600);
}

}  // namespace
}  // namespace broadside::bench

int main(int count, char** arguments) {
  using namespace broadside::bench;
  return guarded("soak", 1, [&] {
    run(number_at(count, arguments, 1, 20'000), text_at(count, arguments, 2, "auto"));
    return 0;
  });
}
