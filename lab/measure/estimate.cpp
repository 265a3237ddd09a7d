// How long an algorithm would take on boxes that are too many to try.
#include "lab/measure/estimate.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lab/numbers.hpp"

namespace broadside::lab {
namespace {

double scaled(double seconds, std::size_t from, std::size_t to, double exponent) {
  return seconds * std::pow(static_cast<double>(to) / static_cast<double>(from), exponent);
}

}  // namespace

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
