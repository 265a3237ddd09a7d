// Measures the cost of boxes of doubles over the same boxes as floats: double_boxes [BOXES [ROUNDS
// [ALGORITHM]]].
//
// Every way of requesting pairs is timed with floats and with doubles in alternating rounds. After each call
// its pairs are compared, as a set, with those of all other calls.
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "broadside/broadside.hpp"

#include "bench/guarded.hpp"
#include "lab/measure/samples.hpp"
#include "lab/numbers.hpp"
#include "lab/report/machine.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::bench {
namespace {

constexpr std::array<std::string_view, 3> own_algorithms = {"grid", "sweep_and_prune", "quadtree"};

/// Scales coordinates to doubles that no float holds, and keeps their order: distinct floats stay distinct.
/// The pairs therefore stay the same, and each has to be found in double precision.
constexpr double scale = 3.14159265358979324;

/// The ways of requesting pairs.
enum class Call { once, kept_finder, between };
constexpr std::array<Call, 3> calls = {Call::once, Call::kept_finder, Call::between};

std::string_view name(Call call) {
  constexpr std::array<std::string_view, 3> names = {"find_pairs", "find, kept", "between"};
  return names[static_cast<std::size_t>(call)];
}

/// A set of pairs, represented by a hash and a count.
struct HashedPairs {
  std::uint64_t count = 0;
  std::uint64_t hash = 0;

  friend bool operator==(const HashedPairs&, const HashedPairs&) = default;
};

HashedPairs set_of(std::span<const Pair> pairs) {
  HashedPairs set{.count = pairs.size()};
  for (const Pair pair : pairs) set.hash += hash(pair);
  return set;
}

/// One precision's side of a comparison.
template <int D, typename Real>
class PrecisionSide {
 public:
  PrecisionSide(std::span<const Box<D, Real>> boxes, std::string_view algorithm, Call call)
      : boxes_(boxes), algorithm_(algorithm), call_(call), finder_(algorithm) {}

  /// Runs one call and returns its pairs. Its times are recorded if `keep`.
  HashedPairs run(bool keep) {
    using Clock = std::chrono::steady_clock;
    std::vector<Pair> pairs = std::move(pairs_);
    pairs.clear();
    const Clock::time_point start = Clock::now();
    const std::clock_t busy_start = std::clock();
    ask(pairs);
    const std::clock_t busy_end = std::clock();
    const std::chrono::duration<double> time = Clock::now() - start;
    if (keep) {
      samples_.push_back(time.count());
      busy_samples_.push_back(static_cast<double>(busy_end - busy_start));
    }
    const HashedPairs set = set_of(pairs);
    if (call_ == Call::kept_finder) pairs_ = std::move(pairs);
    return set;
  }

  /// Seconds of wall-clock time.
  std::span<const double> samples() const { return samples_; }

  /// Processor time, in an unspecified unit; other programs disturb it less than wall-clock time.
  std::span<const double> busy_samples() const { return busy_samples_; }

 private:
  void ask(std::vector<Pair>& pairs) {
    const std::size_t half = boxes_.size() / 2;
    switch (call_) {
      case Call::once:
        pairs = find_pairs(boxes_, {.algorithm = algorithm_});
        return;
      case Call::between:
        pairs = find_pairs(boxes_.first(half), boxes_.subspan(half), {.algorithm = algorithm_});
        return;
      case Call::kept_finder:
        PairCollector collector(pairs);
        finder_.find(boxes_, collector);
    }
  }

  std::span<const Box<D, Real>> boxes_;
  std::string_view algorithm_;
  Call call_;
  Finder<D, Real> finder_;
  std::vector<Pair> pairs_;
  std::vector<double> samples_;
  std::vector<double> busy_samples_;
};

double median_ratio(std::span<const double> over, std::span<const double> under) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < over.size(); ++i) ratios.push_back(over[i] / under[i]);
  return lab::median(ratios);
}

template <int D>
std::vector<Box<D>> uniform_boxes(std::size_t count) {
  const lab::NamedScene uniform = lab::find_scene("uniform");
  return lab::make_history<D>(uniform.scene, uniform.spec, {.boxes = count}).boxes;
}

template <int D>
std::vector<Box<D, double>> scaled(std::span<const Box<D>> boxes) {
  std::vector<Box<D, double>> result(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (int axis = 0; axis < D; ++axis) {
      result[i].min[axis] = boxes[i].min[axis] * scale;
      result[i].max[axis] = boxes[i].max[axis] * scale;
    }
  }
  return result;
}

/// Times the calls in one dimension and prints a line for each. Throws std::runtime_error if sets of pairs
/// that should be equal differ.
template <int D>
void compare_precisions(std::span<const std::string_view> algorithms, std::size_t count, std::size_t rounds) {
  const std::vector<Box<D>> floats = uniform_boxes<D>(count);
  const std::vector<Box<D, double>> doubles = scaled<D>(floats);
  for (const Call call : calls) {
    std::optional<HashedPairs> expected;
    for (const std::string_view algorithm : algorithms) {
      PrecisionSide<D, float> in_float(floats, algorithm, call);
      PrecisionSide<D, double> in_double(doubles, algorithm, call);
      // Round 0 warms up.
      for (std::size_t round = 0; round <= rounds; ++round) {
        for (const HashedPairs& found : {in_float.run(round > 0), in_double.run(round > 0)}) {
          if (found != expected.value_or(found))
            throw std::runtime_error(fmt::format(
                "{} in {}D gave {} pairs that are not the {} of the call before; expected one set for all",
                algorithm, D, found.count, expected->count));
          expected = found;
        }
      }
      fmt::print("{:<4}{:<17}{:<12}{:>10}{:>10}{:>11}{:>7.2f}{:>10.2f}\n", fmt::format("{}D", D), algorithm,
                 name(call), lab::grouped(expected->count),
                 lab::rounded(lab::median(in_float.samples()) * 1e3),
                 lab::rounded(lab::median(in_double.samples()) * 1e3),
                 median_ratio(in_double.samples(), in_float.samples()),
                 median_ratio(in_double.busy_samples(), in_float.busy_samples()));
      std::fflush(stdout);
    }
  }
}

void run(std::span<const std::string_view> algorithms, std::size_t count, std::size_t rounds) {
  const lab::Machine machine = lab::this_machine();
  fmt::print("uniform, {} boxes, {} rounds; {}, {} cores; {}\n", lab::grouped(count), rounds, machine.cpu,
             machine.cores, lab::this_build().compiler);
  fmt::print("{:<4}{:<17}{:<12}{:>10}{:>10}{:>11}{:>7}{:>10}\n", "", "algorithm", "call", "pairs", "float ms",
             "double ms", "ratio", "CPU ratio");
  compare_precisions<2>(algorithms, count, rounds);
  compare_precisions<3>(algorithms, count, rounds);
}

}  // namespace
}  // namespace broadside::bench

int main(int count, char** arguments) {
  using namespace broadside::bench;
  return guarded("double_boxes", 1, [&] {
    const std::string text = text_at(count, arguments, 3, "");
    const std::string_view chosen = text;
    std::span<const std::string_view> algorithms = own_algorithms;
    if (!chosen.empty()) algorithms = {&chosen, 1};
    run(algorithms, number_at(count, arguments, 1, 1'000'000), number_at(count, arguments, 2, 9));
    return 0;
  });
}
