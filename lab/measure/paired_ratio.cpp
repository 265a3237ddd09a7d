// Ratios of times that were measured in the same rounds, with intervals.
#include "lab/measure/paired_ratio.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <stdexcept>

#include "lab/measure/ranking.hpp"
#include "lab/measure/samples.hpp"

namespace broadside::lab {
namespace {

constexpr std::size_t replicate_count = 1'000;

/// The median of numbers that may be put in another order.
double median_in_place(std::vector<double>& numbers) {
  const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
  std::nth_element(numbers.begin(), middle, numbers.end());
  if (numbers.size() % 2 == 1) return *middle;
  return (*std::max_element(numbers.begin(), middle) + *middle) / 2;
}

/// The 97.5 % quantile of Student's distribution.
double student_quantile(std::size_t degrees_of_freedom) {
  constexpr std::array table = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228,
                                2.201,  2.179, 2.160, 2.145, 2.131, 2.120, 2.110, 2.101, 2.093, 2.086,
                                2.080,  2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042};
  if (degrees_of_freedom <= table.size()) return table[degrees_of_freedom - 1];
  // Abramowitz and Stegun, Handbook of Mathematical Functions, 26.7.5, the first two terms.
  const auto n = static_cast<double>(degrees_of_freedom);
  return 1.960 + 2.372 / n + 2.822 / (n * n);
}

/// The geometric mean; of one number that very number.
double mean_of_processes(const std::vector<double>& numbers) {
  return numbers.size() == 1 ? numbers[0] : lab::geometric_mean(numbers);
}

/// The times of one process among those of all.
std::span<const double> part_of(std::span<const double> times, const Measurement& measurement,
                                std::size_t process) {
  const std::vector<std::size_t>& rounds = measurement.rounds_of_processes;
  if (rounds.empty()) return times;
  const auto first =
      std::accumulate(rounds.begin(), rounds.begin() + static_cast<std::ptrdiff_t>(process), std::size_t{0});
  return times.subspan(first, rounds[process]);
}

}  // namespace

std::vector<double> round_times(const Measurement& measurement) {
  const std::vector<double>& samples = measurement.samples_ms;
  const std::size_t a_round = measurement.samples_a_round;
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
  if (rounds_ < least_rounds_of_interval) return std::nullopt;
  return middle_of(replicates(replicate_count, 1));
}

RatiosByProcess::RatiosByProcess(const Case& measured, const Measurement& entry, const Measurement& other) {
  const std::vector<double> times = round_times(entry);
  const std::vector<double> others = round_times(other);
  const std::size_t seeds = std::max<std::size_t>(measured.seeds.size(), 1);
  const std::size_t count = std::max<std::size_t>(entry.rounds_of_processes.size(), 1);
  for (std::size_t process = 0; process < count; ++process) {
    const std::span<const double> some = part_of(times, entry, process);
    const std::span<const double> some_others = part_of(others, other, process);
    if (some.empty() || some_others.empty()) {
      processes_.emplace_back();
      continue;
    }
    processes_.emplace_back(RatiosBySeed(some, some_others, seeds));
    medians_ms_.push_back(lab::median(some.first(processes_.back()->rounds())));
    other_medians_ms_.push_back(lab::median(some_others.first(processes_.back()->rounds())));
  }
  if (process_count() == 0)
    throw std::invalid_argument("no round that both took part in; expected at least 1");
}

std::size_t RatiosByProcess::process_count() const noexcept {
  return static_cast<std::size_t>(
      std::ranges::count_if(processes_, [](const auto& process) { return process.has_value(); }));
}

std::size_t RatiosByProcess::rounds() const noexcept {
  std::size_t sum = 0;
  for (const auto& process : processes_) sum += process ? process->rounds() : 0;
  return sum;
}

std::vector<double> RatiosByProcess::ratios() const {
  std::vector<double> ratios;
  for (const auto& process : processes_) {
    if (process) ratios.push_back(process->median());
  }
  return ratios;
}

double RatiosByProcess::ratio() const { return mean_of_processes(ratios()); }

double RatiosByProcess::milliseconds() const { return mean_of_processes(medians_ms_); }

double RatiosByProcess::other_milliseconds() const { return mean_of_processes(other_medians_ms_); }

std::optional<Interval> RatiosByProcess::interval() const {
  const std::vector<double> all = ratios();
  if (all.size() > 1) return student_interval(all);
  return processes_.size() > 1 ? std::nullopt : processes_[0]->interval();
}

Interval student_interval(std::span<const double> numbers) {
  if (numbers.size() < 2)
    throw std::invalid_argument("an interval over fewer than two numbers; expected at least 2");
  const double mean = std::log(lab::geometric_mean(numbers));
  double squares = 0;
  for (const double number : numbers) squares += (std::log(number) - mean) * (std::log(number) - mean);
  const auto n = static_cast<double>(numbers.size());
  const double half = student_quantile(numbers.size() - 1) * std::sqrt(squares / (n - 1) / n);
  return {std::exp(mean - half), std::exp(mean + half)};
}

Interval middle_of(std::span<const double> replicates) {
  return {percentile(replicates, 0.025), percentile(replicates, 0.975)};
}

PairedRatio paired_ratio(const Case& measured, const Measurement& entry, const Measurement& other) {
  const RatiosByProcess ratios(measured, entry, other);
  return {other.algorithm,        ratios.ratio(),        ratios.interval(),          ratios.rounds(),
          ratios.process_count(), ratios.milliseconds(), ratios.other_milliseconds()};
}

bool were_together(const Measurement& entry, const Measurement& other) {
  if (!is_timed(entry) || !is_timed(other)) return false;
  if (entry.rounds_of_processes.empty()) return true;
  for (std::size_t i = 0; i < entry.rounds_of_processes.size(); ++i) {
    if (entry.rounds_of_processes[i] > 0 && other.rounds_of_processes[i] > 0) return true;
  }
  return false;
}

void add_ratios(CaseResult& result) {
  const Measurement* const fastest = fastest_of(result);
  const Measurement* const own = best_own_of(result);
  const Measurement* const peer = fastest_of_kind(result, AlgorithmKind::peer);
  for (Measurement& measurement : result.measurements) {
    if (!is_timed(measurement)) continue;
    const auto ratio_to = [&](const Measurement* other) -> std::optional<PairedRatio> {
      if (other == nullptr || !were_together(measurement, *other)) return std::nullopt;
      return paired_ratio(result.of, measurement, *other);
    };
    measurement.to_fastest = ratio_to(fastest);
    // Most often our best is the fastest of all, and a ratio takes a thousand samples.
    measurement.to_best_own = own == fastest ? measurement.to_fastest : ratio_to(own);
    measurement.to_fastest_peer = peer == fastest ? measurement.to_fastest : ratio_to(peer);
  }
}

MeanRatio geometric_mean(std::span<const RatiosByProcess> pairs) {
  std::vector<double> medians;
  for (const RatiosByProcess& pair : pairs) medians.push_back(pair.ratio());
  const double mean = geometric_mean(medians);
  const std::size_t processes = pairs[0].processes().size();
  const bool is_one = processes == 1;
  // The logarithms of as many means: one a process, or one a sample of the bootstrap.
  std::vector<double> sums(is_one ? replicate_count : processes, 0);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const RatiosBySeed* const only = is_one ? &*pairs[i].processes()[0] : nullptr;
    if (only != nullptr && only->rounds() >= least_rounds_of_interval) {
      // Each pair draws numbers of its own: what they have in common would not average out.
      const std::vector<double> replicates = only->replicates(replicate_count, i + 1);
      for (std::size_t j = 0; j < sums.size(); ++j) sums[j] += std::log(replicates[j]);
      continue;
    }
    for (std::size_t j = 0; j < sums.size(); ++j) {
      const auto& process = pairs[i].processes()[is_one ? 0 : j];
      sums[j] += std::log(!is_one && process ? process->median() : medians[i]);
    }
  }
  for (double& sum : sums) sum = std::exp(sum / static_cast<double>(pairs.size()));
  return {mean, is_one ? middle_of(sums) : student_interval(sums)};
}

}  // namespace broadside::lab
