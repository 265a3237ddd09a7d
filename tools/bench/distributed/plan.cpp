// Simulates the distributed plan for more boxes and ranks than this machine has, beside the plans of ArborX
// and Apache Sedona for the same boxes: distributed_plan [--help].
//
// A scene's boxes are the sample of a distribution, and each of them stands for many boxes. Each of these
// lies at a random place inside it and is smaller, by the factor that keeps the number of pairs per box. Some
// of these boxes are drawn, and each drawn box is weighted by the number of boxes that it represents. Only
// the plan is run, not the joins.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "broadside/broadside.hpp"
#include "broadside/partition.hpp"

#include "bench/guarded.hpp"
#include "lab/numbers.hpp"
#include "lab/report/aligned_columns.hpp"
#include "lab/report/machine.hpp"
#include "lab/scenes/random.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::bench {
namespace {

struct PlanBenchmarkOptions {
  std::vector<std::string> scenes{"uniform", "clustered", "mixed", "coastlines", "bunny"};
  std::vector<std::uint64_t> boxes{1'000'000'000, 10'000'000'000};
  std::size_t ranks = 1000;
  std::size_t sample_boxes = 1'000'000;  // of scenes with a variable number of boxes
  std::size_t drawn = 10'000'000;
  std::size_t sampled_per_rank = 256;
  double balanced = 1.2;
};

/// Largest load over mean load.
double imbalance(const std::vector<double>& loads) {
  double sum = 0;
  for (const double load : loads) sum += load;
  return sum == 0 ? 1 : *std::ranges::max_element(loads) * static_cast<double>(loads.size()) / sum;
}

/// Draws any number of boxes from the distribution of a sample.
template <int D>
class DrawnPopulation {
 public:
  DrawnPopulation(std::vector<Box<D>> sample, std::uint64_t boxes)
      : sample_(std::move(sample)), boxes_(boxes) {
    shrinking_ =
        std::min(1.0, std::pow(static_cast<double>(boxes) / static_cast<double>(sample_.size()), -1.0 / D));
    pairs_ = find_pairs(sample_);
  }

  std::uint64_t boxes() const { return boxes_; }

  double pairs_per_box() const {
    return static_cast<double>(pairs_.size()) / static_cast<double>(sample_.size());
  }

  Box<D> draw(lab::Random& random) const {
    const Box<D>& origin = sample_[random.below(sample_.size())];
    Box<D> box;
    for (std::size_t axis = 0; axis < D; ++axis) {
      const double extent = double{origin.max[axis]} - double{origin.min[axis]};
      const double at = origin.min[axis] + extent * (1 - shrinking_) * random.fraction();
      box.min[axis] = static_cast<float>(at);
      box.max[axis] = static_cast<float>(at + extent * shrinking_);
    }
    return box;
  }

  /// Number of the sample's pairs that each part owns.
  template <typename Owner>
  std::vector<double> pairs_by_part(std::size_t parts, const Owner& owner) const {
    std::vector<double> pairs(parts);
    for (const Pair pair : pairs_) {
      const Box<D>& first = sample_[index(pair.first)];
      const Box<D>& second = sample_[index(pair.second)];
      Point<D> place;
      for (std::size_t axis = 0; axis < D; ++axis) place[axis] = std::max(first.min[axis], second.min[axis]);
      pairs[owner(place)] += 1;
    }
    return pairs;
  }

 private:
  std::vector<Box<D>> sample_;
  std::uint64_t boxes_;
  double shrinking_;
  std::vector<Pair> pairs_;
};

template <int D>
std::vector<Box<D>> drawn_from(const DrawnPopulation<D>& population, std::size_t count, std::uint64_t seed) {
  lab::Random random(seed);
  std::vector<Box<D>> boxes(count);
  for (Box<D>& box : boxes) box = population.draw(random);
  return boxes;
}

/// Loads of the parts of a partition of the drawn boxes.
struct Loads {
  double cost = 0;    // Partition::cost(), largest over mean
  double boxes = 0;   // largest over mean
  double pairs = 0;   // largest over mean
  double copies = 0;  // parts per box
};

template <int D>
Loads loads_of(const DrawnPopulation<D>& population, const std::vector<Box<D>>& boxes,
               const Partition<D>& partition) {
  std::vector<double> touches(partition.size());
  for (const Box<D>& box : boxes) partition.for_each_part(box, [&](std::size_t part) { touches[part] += 1; });
  const std::vector<double> pairs = population.pairs_by_part(
      partition.size(), [&](const Point<D>& place) { return partition.owner(place); });
  // Per drawn box, and per pair of a sample box.
  std::vector<double> costs(partition.size());
  const double pair_weight = population.pairs_per_box() * static_cast<double>(boxes.size()) /
                             std::max(1.0, std::accumulate(pairs.begin(), pairs.end(), 0.0));
  for (std::size_t part = 0; part < costs.size(); ++part)
    costs[part] = touches[part] + Partition<D>::cost(0, 1) * pair_weight * pairs[part];
  const double all = std::accumulate(touches.begin(), touches.end(), 0.0);
  return {imbalance(costs), imbalance(touches), imbalance(pairs), all / static_cast<double>(boxes.size())};
}

/// Cuts as Sedona's KDBTreePartitioner makes them: each at the median minimum of the sampled boxes, across
/// the longer side, until there are enough parts. Pairs do not count.
template <int D>
class MedianCuts {
 public:
  using Cut = typename Partition<D>::Cut;

  static Partition<D> of(std::vector<Box<D>> sample, std::size_t parts) {
    MedianCuts cuts;
    cuts.cut(sample, parts);
    return Partition<D>(std::move(cuts.cuts_));
  }

 private:
  void cut(std::span<Box<D>> boxes, std::size_t parts) {
    const std::size_t place = cuts_.size();
    cuts_.emplace_back();
    const std::size_t axis = longest_axis(boxes);
    const auto by_minimum = [axis](const Box<D>& a, const Box<D>& b) { return a.min[axis] < b.min[axis]; };
    const auto middle = boxes.begin() + static_cast<std::ptrdiff_t>(boxes.size() * (parts / 2) /
                                                                    std::max<std::size_t>(parts, 1));
    if (parts < 2 || boxes.size() < 2 || middle == boxes.begin()) {
      cuts_[place].below = parts_++;
      return;
    }
    std::ranges::nth_element(boxes, middle, by_minimum);
    const float at = middle->min[axis];
    const auto below = static_cast<std::uint32_t>(cuts_.size());
    cut({boxes.begin(), middle}, parts / 2);
    const auto above = static_cast<std::uint32_t>(cuts_.size());
    cut({middle, boxes.end()}, parts - parts / 2);
    cuts_[place] = {static_cast<std::uint32_t>(axis), below, above, at};
  }

  static std::size_t longest_axis(std::span<const Box<D>> boxes) {
    std::size_t longest = 0;
    float max_spread = -1;
    for (std::size_t axis = 0; axis < D; ++axis) {
      const auto [lowest, highest] =
          std::ranges::minmax(boxes, {}, [axis](const Box<D>& box) { return box.min[axis]; });
      if (highest.min[axis] - lowest.min[axis] > max_spread)
        longest = axis, max_spread = highest.min[axis] - lowest.min[axis];
    }
    return longest;
  }

  std::vector<Cut> cuts_;
  std::uint32_t parts_ = 0;
};

/// Ranks that the query of each box visits in ArborX's DistributedTree. ArborX leaves boxes where they are
/// and asks all ranks whose bounds meet a query. Here every rank holds the boxes of one region, as our parts
/// do; if boxes were on random ranks, each query would visit all ranks.
template <int D>
double ranks_per_query(const std::vector<Box<D>>& boxes, const Partition<D>& partition) {
  constexpr std::size_t max_queries = 200'000;
  std::vector<Box<D>> bounds(partition.size(), absent_box<D>());
  for (const Box<D>& box : boxes) {
    Box<D>& bound = bounds[partition.owner(box.min)];
    bound = merged(bound, box);
  }
  const std::size_t queries = std::min(boxes.size(), max_queries);
  double met = 0;
  for (std::size_t query = 0; query < queries; ++query)
    for (const Box<D>& bound : bounds) met += overlap(bound, boxes[query]) ? 1 : 0;
  return met / static_cast<double>(queries);
}

template <int D>
void simulate(const lab::NamedScene& named, const PlanBenchmarkOptions& options,
              lab::AlignedColumns& columns) {
  const std::vector<Box<D>> sample =
      lab::make_history<D>(named.scene, named.spec, {.boxes = options.sample_boxes, .seed = 1}).boxes;
  for (const std::uint64_t boxes : options.boxes) {
    const DrawnPopulation<D> population(sample, boxes);
    const std::vector<Box<D>> drawn = drawn_from(population, options.drawn, 2);
    // Each step samples four times as many boxes as the one before, until the cuts are balanced.
    std::size_t steps = 0;
    std::size_t sampled = options.ranks * options.sampled_per_rank / 4;
    Partition<D> partition;
    Loads loads;
    do {
      sampled *= 4;
      partition = Partition<D>(drawn_from(population, sampled, 3 + steps), options.ranks, boxes);
      loads = loads_of(population, drawn, partition);
    } while (++steps < 4 && loads.cost > options.balanced);
    // Sedona samples 1 %. More than a million boxes would change nothing here.
    const std::size_t hundredth = std::min<std::uint64_t>(boxes / 100, 1'000'000);
    const Loads median =
        loads_of(population, drawn, MedianCuts<D>::of(drawn_from(population, hundredth, 9), options.ranks));
    const auto ranks = static_cast<double>(options.ranks);
    const double elsewhere = (ranks - 1) / ranks;
    const double box_bytes = sizeof(Box<D>) + sizeof(std::uint64_t);
    const double sent =
        elsewhere * (loads.copies * box_bytes + population.pairs_per_box() * 2 * sizeof(std::uint64_t));
    // A search needs memory for about three more boxes per box: docs/lab-notes.md.
    const double memory = loads.boxes * loads.copies * static_cast<double>(boxes) / ranks *
                              (box_bytes + 3 * sizeof(Box<D>) + 17) +
                          loads.pairs * population.pairs_per_box() * static_cast<double>(boxes) / ranks * 2 *
                              sizeof(std::uint64_t);
    columns.add({named.spec.text(), fmt::format("{}D", D), fmt::format("{:.0e}", static_cast<double>(boxes)),
                 lab::rounded(population.pairs_per_box()), std::to_string(steps),
                 lab::grouped(sampled / options.ranks), lab::rounded(loads.cost), lab::rounded(loads.boxes),
                 lab::rounded(loads.pairs), lab::rounded(loads.copies), lab::whole(sent), lab::bytes(memory),
                 lab::rounded(median.cost), lab::rounded(median.boxes), lab::rounded(median.pairs),
                 lab::rounded(median.copies), lab::rounded(ranks_per_query(drawn, partition))});
  }
}

int run(int count, char** arguments) {
  PlanBenchmarkOptions options;
  CLI::App app("Simulates the distributed plan for more boxes and ranks than this machine has.");
  app.add_option("--scenes", options.scenes, "scenes whose distributions are simulated")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--boxes", options.boxes, "numbers of boxes")->delimiter(',')->capture_default_str();
  app.add_option("--ranks", options.ranks, "number of ranks, each with one part")
      ->check(CLI::Range(2, 100'000))
      ->capture_default_str();
  app.add_option("--drawn", options.drawn, "boxes drawn to stand for all")
      ->check(CLI::Range(1000, 1'000'000'000))
      ->capture_default_str();
  app.add_option("--sample", options.sampled_per_rank, "boxes sampled by each rank in the first step")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  app.add_option("--balanced", options.balanced, "largest cost over the mean at which no step follows")
      ->capture_default_str();
  try {
    app.parse(count, arguments);
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  }
  const lab::Machine machine = lab::this_machine();
  const lab::Build build = lab::this_build();
  fmt::print("{} ranks, {} boxes drawn; {}, {}, {}, {}\n", lab::grouped(options.ranks),
             lab::grouped(options.drawn), machine.cpu, build.compiler, build.revision, lab::today());
  lab::AlignedColumns columns("<<>>>>>>>>>>>>>>>");
  columns.add({"scene", "", "boxes", "pairs a box", "steps", "sampled a rank", "cost, largest/mean", "boxes",
               "pairs", "parts a box", "bytes sent a box", "memory a rank", "Sedona: cost", "boxes", "pairs",
               "parts a box", "ArborX: ranks a query"});
  for (const std::string& name : options.scenes) {
    const lab::NamedScene named = lab::find_scene(name);
    if (named.scene.has_dimension(2)) simulate<2>(named, options, columns);
    if (named.scene.has_dimension(3)) simulate<3>(named, options, columns);
  }
  fmt::print("{}", columns.text(""));
  return 0;
}

}  // namespace
}  // namespace broadside::bench

int main(int count, char** arguments) {
  return broadside::bench::guarded("distributed_plan", 1,
                                   [&] { return broadside::bench::run(count, arguments); });
}
