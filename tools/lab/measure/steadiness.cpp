// Whether measured times can be trusted.
#include "lab/measure/steadiness.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "lab/measure/samples.hpp"
#include "lab/numbers.hpp"

namespace broadside::lab {
namespace {

/// On a quiet machine, spreads reach up to 1.42.
constexpr double greatest_spread = 1.5;

}  // namespace

double ProcessorShare::value() const {
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin_;
  return passed.count() > 0 ? (platform::processor_seconds() - used_) / passed.count() : 1;
}

bool is_busy(double share) {
  constexpr double min_quiet_share = 0.9;
  return share < min_quiet_share;
}

std::string busy_hint(double share) {
  if (!is_busy(share)) return "";
  return fmt::format(
      "busy: others had the processor for {:.0f} % of the time; times are too long, and not by the same "
      "factor: quiet the machine and measure again\n",
      100 * (1 - share));
}

std::optional<double> spread(std::span<const double> samples, std::size_t period) {
  constexpr std::size_t fewest_repetitions = 3;
  if (samples.size() < period + fewest_repetitions) return std::nullopt;
  std::vector<double> spreads;
  std::vector<double> same;
  for (std::size_t first = 0; first < period && first + period < samples.size(); ++first) {
    same.clear();
    for (std::size_t i = first; i < samples.size(); i += period) same.push_back(samples[i]);
    const double min_time = std::ranges::min(same);
    spreads.push_back(min_time > 0 ? median(same) / min_time : 1);
  }
  return median(spreads);
}

bool is_unsteady(const Case& of, const Measurement& measurement) {
  const std::size_t seeds = std::max<std::size_t>(of.seeds.size(), 1);
  const std::size_t period = of.mode == Mode::find ? seeds : seeds * std::max<std::size_t>(of.frames, 1);
  return spread(measurement.samples_ms, period).value_or(1) > greatest_spread;
}

Steadiness steadiness_of(const CaseResult& result) {
  Steadiness steadiness;
  for (const Measurement& measurement : result.measurements) {
    if (measurement.samples_ms.empty()) continue;
    ++steadiness.measurements;
    if (is_unsteady(result.of, measurement)) ++steadiness.unsteady;
  }
  return steadiness;
}

std::string hint_of(const Steadiness& steadiness, std::string_view more) {
  if (steadiness.unsteady == 0) return "";
  return fmt::format(
      "unsteady: {} of {}, whose median sample is far above the least; quiet the machine and measure "
      "again{}{}\n",
      grouped(steadiness.unsteady), counted(steadiness.measurements, "measurement", "measurements"),
      more.empty() ? "" : ", ", more);
}

}  // namespace broadside::lab
