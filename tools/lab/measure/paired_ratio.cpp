// Ratios of times measured in the same rounds, with confidence intervals.
#include "lab/measure/paired_ratio.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <stdexcept>

#include "lab/measure/ranking.hpp"
#include "lab/measure/samples.hpp"

namespace broadside::lab {
namespace {

constexpr std::size_t replicate_count = 1'000;

/// The median of numbers, which it may reorder.
double median_in_place(std::vector<double>& numbers) {
  const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
  std::nth_element(numbers.begin(), middle, numbers.end());
  if (numbers.size() % 2 == 1) return *middle;
  return (*std::max_element(numbers.begin(), middle) + *middle) / 2;
}

}  // namespace

std::vector<double> round_times(const Measurement& measurement) {
  const std::vector<double>& samples = measurement.samples_ms;
  const std::size_t a_round = measurement.samples_per_round;
  if (a_round <= 1) return samples;
  std::vector<double> times;
  for (std::size_t first = 0; first + a_round <= samples.size(); first += a_round) {
    const auto begin = samples.begin() + static_cast<std::ptrdiff_t>(first);
    times.push_back(std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(a_round), 0.0) /
                    static_cast<double>(a_round));
  }
  return times;
}

RatiosBySeed::RatiosBySeed(std::span<const double> times, std::span<const double> others, std::size_t seeds)
    : rounds_(std::min(times.size(), others.size())) {
  if (rounds_ == 0 || seeds == 0)
    throw std::invalid_argument("no round that both took part in; expected at least 1");
  logs_.resize(std::min(seeds, rounds_));
  for (std::size_t round = 0; round < rounds_; ++round)
    logs_[round % seeds].push_back(std::log(times[round] / others[round]));
}

double RatiosBySeed::median() const {
  std::vector<double> medians;
  for (const std::vector<double>& of_seed : logs_) medians.push_back(lab::median(of_seed));
  return std::exp(median_in_place(medians));
}

std::vector<double> RatiosBySeed::replicates(std::size_t count, std::uint64_t seed) const {
  std::mt19937_64 random(seed);
  std::vector<double> result;
  std::vector<double> medians;
  std::vector<double> drawn;
  for (std::size_t i = 0; i < count; ++i) {
    medians.clear();
    for (std::size_t j = 0; j < logs_.size(); ++j) {
      const std::vector<double>& of_seed = logs_[random() % logs_.size()];
      drawn.clear();
      for (std::size_t k = 0; k < of_seed.size(); ++k) drawn.push_back(of_seed[random() % of_seed.size()]);
      medians.push_back(median_in_place(drawn));
    }
    result.push_back(std::exp(median_in_place(medians)));
  }
  return result;
}

std::optional<Interval> RatiosBySeed::interval() const {
  if (rounds_ < min_rounds_of_interval) return std::nullopt;
  return middle_of(replicates(replicate_count, 1));
}

RatiosBySeed ratios_of(const Case& measured, const Measurement& entry, const Measurement& other) {
  return {round_times(entry), round_times(other), std::max<std::size_t>(measured.seeds.size(), 1)};
}

Interval middle_of(std::span<const double> replicates) {
  return {percentile(replicates, 0.025), percentile(replicates, 0.975)};
}

PairedRatio paired_ratio(const Case& measured, const Measurement& entry, const Measurement& other) {
  const RatiosBySeed ratios = ratios_of(measured, entry, other);
  const auto time = [&](const Measurement& one) {
    const std::vector<double> times = round_times(one);
    return lab::median(std::span(times).first(ratios.rounds()));
  };
  return {other.algorithm, ratios.median(), ratios.interval(), ratios.rounds(), time(entry), time(other)};
}

void add_ratios(CaseResult& result) {
  const Measurement* const fastest = fastest_of(result);
  const Measurement* const own = best_own_of(result);
  const Measurement* const peer = fastest_of_kind(result, AlgorithmKind::peer);
  for (Measurement& measurement : result.measurements) {
    if (!is_timed(measurement)) continue;
    const auto ratio_to = [&](const Measurement* other) -> std::optional<PairedRatio> {
      if (other == nullptr) return std::nullopt;
      return paired_ratio(result.of, measurement, *other);
    };
    measurement.to_fastest = ratio_to(fastest);
    // Reuses a ratio, which takes a thousand bootstrap samples: most often our best is the fastest of all.
    measurement.to_best_own = own == fastest ? measurement.to_fastest : ratio_to(own);
    measurement.to_fastest_peer = peer == fastest ? measurement.to_fastest : ratio_to(peer);
  }
}

MeanRatio geometric_mean(std::span<const RatiosBySeed> pairs) {
  std::vector<double> medians;
  std::vector<double> sums(replicate_count, 0);  // of logarithms, in each bootstrap sample
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    medians.push_back(pairs[i].median());
    std::vector<double> replicates(replicate_count, medians.back());
    // Each pair has its own random numbers: errors common to all pairs would not average out.
    if (pairs[i].rounds() >= min_rounds_of_interval) replicates = pairs[i].replicates(replicate_count, i + 1);
    for (std::size_t j = 0; j < sums.size(); ++j) sums[j] += std::log(replicates[j]);
  }
  for (double& sum : sums) sum = std::exp(sum / static_cast<double>(pairs.size()));
  return {geometric_mean(medians), middle_of(sums)};
}

}  // namespace broadside::lab
