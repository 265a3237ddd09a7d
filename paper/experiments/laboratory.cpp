// What experiments measure with.
#include "paper/experiments/laboratory.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "lab/measure/compare.hpp"
#include "lab/measure/paired_ratio.hpp"
#include "lab/measure/samples.hpp"

namespace broadside::lab {
namespace {

Cell count_cell(const Measurement& measurement, std::uint64_t Statistics::*count) {
  return measurement.statistics ? Cell(static_cast<double>(*measurement.statistics.*count)) : Cell();
}

}  // namespace

Effort Laboratory::effort() const {
  if (quick_) {
    return {.budget_seconds = 0.25,
            .history_seconds = 0.5,
            .share_seconds = 0.01,
            .least_rounds = 3,
            .most_rounds = 50,
            .slow_seconds = 0.1,
            .slow_history_seconds = 0.1,
            .slow_rounds = 1};
  }
  return {.budget_seconds = 2,
          .history_seconds = 4,
          .share_seconds = 0.1,
          .least_rounds = 5,
          .most_rounds = 200,
          .slow_seconds = 1,
          .slow_history_seconds = 1,
          .slow_rounds = 1};
}

CaseResult Laboratory::measure(const std::string& algorithms, const CaseRequest& request) const {
  return measure(algorithms, request, effort());
}

CaseResult Laboratory::measure(const std::string& algorithms, const CaseRequest& request,
                               const Effort& effort) const {
  return measure(*catalogue_, algorithms, request, effort, CompareOptions{}.find);
}

CaseResult Laboratory::measure(const std::string& algorithms, const Scene& scene,
                               const CaseRequest& request) const {
  const auto find = [&](std::string_view) { return NamedScene{scene, Spec(request.scene, {})}; };
  return measure(*catalogue_, algorithms, request, effort(), find);
}

CaseResult Laboratory::measure(const Catalogue& catalogue, const std::string& algorithms,
                               const CaseRequest& request, const Effort& effort) const {
  return measure(catalogue, algorithms, request, effort, CompareOptions{}.find);
}

CaseResult Laboratory::measure(const Catalogue& catalogue, const std::string& algorithms,
                               const CaseRequest& request, const Effort& effort,
                               const FindScene& find) const {
  CompareOptions options;
  options.algorithms = algorithms;
  options.plan = {request};
  options.find = find;
  options.effort = effort;
  options.watch = watch_;
  Comparison comparison = compare(catalogue, options);
  if (comparison.stopped) throw Stopped();
  if (comparison.cases.empty())
    throw std::runtime_error(fmt::format("scene '{}' could not be measured", request.scene));
  for (const Measurement& measurement : comparison.cases[0].measurements) {
    if (measurement.outcome == Outcome::failed)
      throw std::runtime_error(fmt::format("scene '{}': {}", request.scene, measurement.reason));
  }
  steadiness_.add(steadiness_of(comparison.cases[0]));
  return std::move(comparison.cases[0]);
}

std::string list_of(const std::vector<std::string>& specs) {
  return fmt::format("{}", fmt::join(specs, ","));
}

const Measurement& measurement_of(const CaseResult& result, std::string_view spec) {
  const auto found = std::ranges::find(result.measurements, spec, &Measurement::algorithm);
  if (found == result.measurements.end()) {
    std::vector<std::string_view> known;
    for (const Measurement& measurement : result.measurements) known.push_back(measurement.algorithm);
    throw std::invalid_argument(
        fmt::format("'{}' was not measured; expected one of: {}", spec, fmt::join(known, ", ")));
  }
  return *found;
}

Cell time_cell(const Measurement& measurement) {
  return measurement.samples_ms.empty() ? Cell() : Cell(median(measurement.samples_ms));
}

std::vector<Cell> ratio_cells(const CaseResult& result, const Measurement& measurement,
                              const Measurement& other) {
  if (measurement.samples_ms.empty() || other.samples_ms.empty()) return {Cell(), Cell(), Cell()};
  const PairedRatio ratio = paired_ratio(result.of, measurement, other);
  const Interval interval = ratio.interval.value_or(Interval{ratio.median, ratio.median});
  return {ratio.median, interval.low, interval.high};
}

Cell tests_cell(const Measurement& measurement) { return count_cell(measurement, &Statistics::tests); }

Cell references_cell(const Measurement& measurement) {
  return count_cell(measurement, &Statistics::references);
}

Cell bytes_cell(const Measurement& measurement) {
  return measurement.own_bytes ? Cell(static_cast<double>(*measurement.own_bytes)) : Cell();
}

Cell over(const Cell& cell, double divisor) {
  const double* const number = std::get_if<double>(&cell);
  return number == nullptr ? cell : Cell(*number / divisor);
}

}  // namespace broadside::lab
