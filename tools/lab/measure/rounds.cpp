// How many rounds a case's algorithms run.
#include "lab/measure/rounds.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <fmt/format.h>

#include "lab/measure/paired_ratio.hpp"
#include "lab/numbers.hpp"

namespace broadside::lab {
namespace {

double sum_of(const std::vector<double>& samples) {
  return std::accumulate(samples.begin(), samples.end(), 0.0);
}

/// The minimum time of a first round among the algorithms of a kind, in milliseconds; infinite without any.
double min_first_round(std::span<const Measurement> all, AlgorithmKind kind) {
  double min_time = std::numeric_limits<double>::infinity();
  for (const Measurement& measurement : all) {
    if (measurement.kind == kind && !measurement.samples_ms.empty())
      min_time = std::min(min_time, round_times(measurement).front());
  }
  return min_time;
}

double scaled(double seconds, std::size_t from, std::size_t to, double exponent) {
  return seconds * std::pow(static_cast<double>(to) / static_cast<double>(from), exponent);
}

}  // namespace

std::size_t inputs_in_rotation(std::size_t boxes) {
  if (boxes >= 500'000) return 1;
  return std::clamp<std::size_t>(100'000 / std::max<std::size_t>(boxes, 1), 4, 32);
}

std::vector<std::size_t> turns(std::size_t entries, std::size_t round) {
  std::vector<std::size_t> order(entries);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), std::mt19937_64(round));
  return order;
}

bool has_time(const Effort& effort, std::size_t round, double milliseconds) {
  constexpr std::size_t always = 2;
  return round < always || milliseconds < effort.case_seconds * 1e3;
}

bool has_another_round(const Measurement& measurement, const Effort& effort, std::size_t limit) {
  const std::size_t rounds = measurement.samples_ms.size() / measurement.samples_per_round;
  if (measurement.outcome == Outcome::failed || !measurement.reason.empty() ||
      rounds >= std::min(limit, effort.max_rounds))
    return false;
  return limit != no_limit || rounds < effort.min_rounds ||
         sum_of(measurement.samples_ms) < effort.share_seconds * 1e3;
}

std::size_t round_limit(const Measurement& measurement, std::span<const Measurement> all,
                        const Effort& effort, double slow_seconds) {
  if (measurement.samples_ms.empty()) return no_limit;
  const double own = min_first_round(all, AlgorithmKind::own);
  const double peer = min_first_round(all, AlgorithmKind::peer);
  // Without a peer, no algorithm counts as far behind; without one of ours, only peers count.
  const double close = std::max({far_from_seconds * 1e3, effort.far_ratio * peer,
                                 own < std::numeric_limits<double>::infinity() ? effort.far_ratio * own : 0});
  if (round_times(measurement).front() > close) return effort.far_rounds;
  return sum_of(measurement.samples_ms) > slow_seconds * 1e3 ? effort.slow_rounds : no_limit;
}

std::optional<Estimate> estimate_above(double budget, std::size_t boxes,
                                       const std::function<double(std::size_t)>& seconds_for) {
  if (boxes <= boxes_worth_estimating) return std::nullopt;
  const std::size_t few = boxes / 20;
  const double few_seconds = seconds_for(few);
  const double worst = scaled(few_seconds, few, boxes, 2);
  if (worst <= budget) return std::nullopt;

  const std::size_t more = boxes / 5;
  if (scaled(few_seconds, few, more, 2) > budget) return Estimate{worst, few, 2};
  const double more_seconds = seconds_for(more);
  const double ratio = static_cast<double>(more) / static_cast<double>(few);
  const double growth = std::log(more_seconds / few_seconds) / std::log(ratio);
  const double exponent = growth >= 1.8 ? 2 : std::max(growth, 1.0);
  const Estimate estimate{scaled(more_seconds, more, boxes, exponent), more, exponent};
  return estimate.seconds > budget ? std::optional(estimate) : std::nullopt;
}

std::string text(const Estimate& estimate) {
  return fmt::format("estimated {} from {} boxes, scaled by n^{:.2f}", duration(estimate.seconds),
                     grouped(estimate.from), estimate.exponent);
}

}  // namespace broadside::lab
