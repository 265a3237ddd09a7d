// Statistics of a list of measured times.
#include "lab/measure/samples.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace broadside::lab {
namespace {

std::vector<double> sorted(std::span<const double> samples) {
  if (samples.empty()) throw std::invalid_argument("0 samples; expected at least 1");
  std::vector<double> copy(samples.begin(), samples.end());
  std::sort(copy.begin(), copy.end());
  return copy;
}

}  // namespace

double median(std::span<const double> samples) {
  const std::vector<double> order = sorted(samples);
  const std::size_t middle = order.size() / 2;
  return order.size() % 2 == 1 ? order[middle] : (order[middle - 1] + order[middle]) / 2;
}

double percentile(std::span<const double> samples, double fraction) {
  const std::vector<double> order = sorted(samples);
  const double rank = std::ceil(fraction * static_cast<double>(order.size()));
  return order[static_cast<std::size_t>(std::clamp(rank, 1.0, static_cast<double>(order.size()))) - 1];
}

double geometric_mean(std::span<const double> numbers) {
  if (numbers.empty()) throw std::invalid_argument("0 numbers; expected at least 1");
  double sum = 0;
  for (const double number : numbers) sum += std::log(number);
  return std::exp(sum / static_cast<double>(numbers.size()));
}

}  // namespace broadside::lab
