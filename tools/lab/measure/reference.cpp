// The reference that an algorithm's pairs are compared with.
#include "lab/measure/reference.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "broadside/executor.hpp"
#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"

#include "lab/numbers.hpp"

namespace broadside::lab {

Reference::Reference(const Algorithm& entry, std::span<const Algorithm> known, std::size_t boxes,
                     std::size_t max_by_definition) {
  if (boxes <= max_by_definition) return;
  constexpr std::array<std::string_view, 3> names = {"quadtree", "sweep_and_prune", "grid"};
  for (const std::string_view name : names) {
    if (entry.name.find(name) != std::string::npos) continue;
    algorithm_ = find_algorithm(name, known);
    if (algorithm_ != nullptr) return;
  }
}

std::string Reference::text() const {
  if (is_definition()) return "the definition";
  return fmt::format("{} + {} sampled boxes", algorithm_->name, sampled_boxes);
}

template <int D, typename Real>
std::vector<Pair> Reference::pairs(BoxSpan<D, Real> boxes, const std::function<void()>& asks) const {
  if (is_definition()) return reference_pairs<D, Real>(boxes);
  std::vector<Pair> pairs;
  PairCollector collector(pairs);
  Finder<D, Real> finder(*algorithm_, Spec{algorithm_->name, {}});
  Workers workers = finder.workers();
  workers.checkpoint = asks;
  finder.set_workers(workers);
  finder.find(boxes, collector);
  Checkpoint checkpoint(asks);
  sort_pairs(pairs, checkpoint);
  return pairs;
}

template <int D, typename Real>
std::optional<PairDivergence> check_sample(BoxSpan<D, Real> boxes, std::span<const Pair> pairs,
                                           std::uint64_t seed) {
  const std::vector<std::size_t> sample = sample_of(boxes.size(), sampled_boxes, seed);
  std::vector<bool> sampled(boxes.size(), false);
  for (const std::size_t i : sample) sampled[i] = true;
  const std::vector<Pair> expected = reference_pairs_of<D, Real>(boxes, sample);
  std::vector<Pair> found;
  std::ranges::copy_if(pairs, std::back_inserter(found),
                       [&](Pair pair) { return sampled[index(pair.first)] || sampled[index(pair.second)]; });
  return compare_pairs(std::move(found), expected);
}

std::uint64_t hash_of(std::span<const Pair> pairs) noexcept {
  std::uint64_t sum = 0;
  for (const Pair pair : pairs) sum += hash(pair);
  return sum;
}

std::vector<std::size_t> sample_of(std::size_t size, std::size_t count, std::uint64_t seed) {
  std::vector<std::size_t> all(size);
  std::iota(all.begin(), all.end(), std::size_t{0});
  if (size <= count) return all;
  std::vector<std::size_t> chosen;
  std::mt19937_64 random(seed);
  std::ranges::sample(all, std::back_inserter(chosen), static_cast<std::ptrdiff_t>(count), random);
  return chosen;
}

template std::vector<Pair> Reference::pairs<2, float>(BoxSpan<2, float>, const std::function<void()>&) const;
template std::optional<PairDivergence> check_sample<2, float>(BoxSpan<2, float>, std::span<const Pair>,
                                                              std::uint64_t);
template std::vector<Pair> Reference::pairs<2, double>(BoxSpan<2, double>,
                                                       const std::function<void()>&) const;
template std::optional<PairDivergence> check_sample<2, double>(BoxSpan<2, double>, std::span<const Pair>,
                                                               std::uint64_t);
template std::vector<Pair> Reference::pairs<3, float>(BoxSpan<3, float>, const std::function<void()>&) const;
template std::optional<PairDivergence> check_sample<3, float>(BoxSpan<3, float>, std::span<const Pair>,
                                                              std::uint64_t);
template std::vector<Pair> Reference::pairs<3, double>(BoxSpan<3, double>,
                                                       const std::function<void()>&) const;
template std::optional<PairDivergence> check_sample<3, double>(BoxSpan<3, double>, std::span<const Pair>,
                                                               std::uint64_t);

template <int D, typename Real>
void check_pair_count(BoxSpan<D, Real> boxes) {
  constexpr double max_pairs = 250e6;  // 2 GB
  std::vector<Box<D, Real>> some;
  for (const std::size_t i : sample_of(boxes.size(), 1'000)) some.push_back(boxes[i]);
  const double scale =
      static_cast<double>(boxes.size()) / static_cast<double>(std::max<std::size_t>(some.size(), 1));
  const double pairs = static_cast<double>(reference_pairs<D, Real>(some).size()) * scale * scale;
  if (pairs > max_pairs) {
    throw std::runtime_error(fmt::format(
        "{} boxes with about {:.1e} pairs; expected at most {:.1e}, since pairs are kept to be checked",
        grouped(boxes.size()), pairs, max_pairs));
  }
}

template void check_pair_count<2, float>(BoxSpan<2, float>);
template void check_pair_count<3, float>(BoxSpan<3, float>);
template void check_pair_count<2, double>(BoxSpan<2, double>);
template void check_pair_count<3, double>(BoxSpan<3, double>);

}  // namespace broadside::lab
