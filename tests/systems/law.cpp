// The law in one program without a test framework, so that it runs wherever the library is compiled for: each
// of our own algorithms against all pairs tested here. Prints what was found, and in which order, line by
// line; two machines must print the same. Stops at the first divergence with exit status 1.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "broadside/broadside.hpp"

#include "lab/scenes/random.hpp"

namespace {

using broadside::BoxId;
using broadside::Pair;
using broadside::lab::Random;

constexpr float infinity = std::numeric_limits<float>::infinity();

template <int D>
using Boxes = std::vector<broadside::Box<D>>;

/// Boxes with each axis drawn by `draw`, which sets a min and a max.
template <int D, typename Draw>
Boxes<D> drawn(std::size_t count, Draw draw) {
  Random random(count * 10 + D);
  Boxes<D> boxes(count);
  for (auto& box : boxes) {
    for (int axis = 0; axis < D; ++axis) draw(random, box.min[axis], box.max[axis]);
  }
  return boxes;
}

/// Boxes of at most `size` in a world in which a box has a few neighbours.
template <int D>
Boxes<D> scattered(std::size_t count, double size) {
  double world = 1;
  const auto volume = [&] { return D == 2 ? world * world : world * world * world; };
  while (volume() < static_cast<double>(count) / 4) world *= 1.1;
  return drawn<D>(count, [&](Random& random, float& min, float& max) {
    min = static_cast<float>(random.between(0, world));
    max = min + static_cast<float>(random.between(0, size));
  });
}

template <int D>
struct Input {
  std::string name;
  Boxes<D> boxes;
};

template <int D>
std::vector<Input<D>> inputs() {
  std::vector<Input<D>> all;
  for (const std::size_t count : {0, 1, 2, 3, 4, 5, 8, 15, 16, 17, 18, 31, 33, 64, 100, 301, 1000, 2000})
    all.push_back({"scattered", scattered<D>(count, 1)});
  for (const std::size_t count : {40, 2000}) {
    all.push_back({"small whole numbers", drawn<D>(count, [](Random& random, float& min, float& max) {
                     min = static_cast<float>(random.below(30)) - 10;
                     max = min + static_cast<float>(random.below(3));
                   })});
    all.push_back({"points on a lattice", drawn<D>(count, [](Random& random, float& min, float& max) {
                     min = max = static_cast<float>(random.below(12));
                   })});
    all.push_back({"points", scattered<D>(count, 0)});
    Boxes<D> flat = scattered<D>(count, 1);
    for (auto& box : flat) box.max[D - 1] = box.min[D - 1] = 3;
    all.push_back({"in one plane", flat});
    all.push_back({"far from the origin", drawn<D>(count, [](Random& random, float& min, float& max) {
                     min = 1e7F + static_cast<float>(random.below(200));
                     max = min + static_cast<float>(random.below(9));
                   })});
    all.push_back({"of very uneven sizes", drawn<D>(count, [](Random& random, float& min, float& max) {
                     min = static_cast<float>(random.between(0, 400));
                     max = min + static_cast<float>(0.01 / (random.fraction() * random.fraction() + 1e-4));
                   })});
    Boxes<D> huge = scattered<D>(count, 1);
    huge[count / 2].min.fill(-1e6F);
    huge[count / 2].max.fill(1e6F);
    all.push_back({"one huge", huge});
    Boxes<D> infinite = scattered<D>(count, 1);
    for (std::size_t i = 0; i < count; i += 20) infinite[i].max[i / 20 % D] = infinity;
    for (std::size_t i = 7; i < count; i += 50) infinite[i].min[i / 50 % D] = -infinity;
    infinite[count / 3].min.fill(-infinity);
    infinite[count / 3].max.fill(infinity);
    all.push_back({"some infinite", infinite});
    for (std::size_t i = 1; i < count; i += 3) infinite[i] = broadside::absent_box<D>();
    all.push_back({"some infinite, some absent", infinite});
  }
  all.push_back({"at one point", Boxes<D>(150, broadside::Box<D>{})});
  all.push_back({"all infinite", drawn<D>(90, [](Random& random, float& min, float& max) {
                   min = random.chance(0.5) ? -infinity : 0;
                   max = random.chance(0.5) ? infinity : 0;
                 })});
  return all;
}

template <int D>
bool meet(const broadside::Box<D>& a, const broadside::Box<D>& b) {
  if (is_absent(a) || is_absent(b)) return false;
  for (int axis = 0; axis < D; ++axis) {
    if (a.min[axis] > b.max[axis] || b.min[axis] > a.max[axis]) return false;
  }
  return true;
}

template <int D>
std::vector<Pair> all_pairs(std::span<const broadside::Box<D>> boxes) {
  std::vector<Pair> pairs;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    for (std::uint32_t j = i + 1; j < boxes.size(); ++j) {
      if (meet(boxes[i], boxes[j])) pairs.push_back({BoxId{i}, BoxId{j}});
    }
  }
  return pairs;
}

/// Those of a set's pairs that are of one box among the first `left_count` and one of the others, whose
/// places are counted from there.
std::vector<Pair> crossing(std::span<const Pair> pairs, std::uint32_t left_count) {
  std::vector<Pair> some;
  for (const Pair pair : pairs) {
    if (index(pair.first) < left_count && index(pair.second) >= left_count)
      some.push_back({pair.first, BoxId{index(pair.second) - left_count}});
  }
  return some;
}

/// Another order, another number.
std::uint64_t order_of(std::span<const Pair> pairs) {
  std::uint64_t hash = 0;
  for (const Pair pair : pairs) hash = hash * 0x9e3779b97f4a7c15U + broadside::hash(pair);
  return hash;
}

/// The first pair in which `found` is not `expected`, which is sorted; empty if there is none.
std::string divergence(std::vector<Pair> found, const std::vector<Pair>& expected) {
  std::ranges::sort(found);
  const auto [f, e] = std::mismatch(found.begin(), found.end(), expected.begin(), expected.end());
  if (f == found.end() && e == expected.end()) return {};
  const bool missing = f == found.end() || (e != expected.end() && *e < *f);
  const Pair pair = missing ? *e : *f;
  return "pair (" + std::to_string(index(pair.first)) + ", " + std::to_string(index(pair.second)) +
         (missing ? ") is missing" : ") is reported once too often");
}

/// Whether the pairs are right. Prints what they are either way.
bool holds(const std::string& what, const std::vector<Pair>& found, const std::vector<Pair>& expected) {
  const std::string wrong = divergence(found, expected);
  std::printf("%s: %zu pairs in order %016llx\n", what.c_str(), found.size(),
              static_cast<unsigned long long>(order_of(found)));
  if (!wrong.empty()) std::fprintf(stderr, "law: %s: %s\n", what.c_str(), wrong.c_str());
  return wrong.empty();
}

template <int D>
bool all_hold() {
  for (const Input<D>& input : inputs<D>()) {
    const std::span<const broadside::Box<D>> boxes = input.boxes;
    const std::vector<Pair> expected = all_pairs<D>(boxes);
    const auto left_count = static_cast<std::uint32_t>(boxes.size() / 3);
    const std::vector<Pair> expected_between = crossing(expected, left_count);
    for (const broadside::Algorithm& algorithm : broadside::algorithms()) {
      if (algorithm.kind != broadside::AlgorithmKind::own) continue;
      broadside::Finder<D> finder(algorithm.name);
      const std::string what = std::string(algorithm.name) + ", " + std::to_string(D) + "D, " + input.name +
                               ", " + std::to_string(boxes.size()) + " boxes";
      std::vector<Pair> pairs;
      broadside::PairCollector collector(pairs);
      finder.find(boxes, collector);
      if (!holds(what, pairs, expected)) return false;
      pairs.clear();
      finder.find_between(boxes.first(left_count), boxes.subspan(left_count), collector);
      if (!holds(what + ", between", pairs, expected_between)) return false;
    }
  }
  return true;
}

}  // namespace

int main() {
  std::fprintf(stderr, "instruction set: %s\n", broadside::instruction_set().c_str());
  return all_hold<2>() && all_hold<3>() ? 0 : 1;
}
