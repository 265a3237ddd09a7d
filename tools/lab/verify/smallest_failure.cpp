// Finds the smallest history of boxes on which an algorithm fails.
#include <exception>
#include <new>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "broadside/debug/minimise.hpp"

#include "lab/measure/benchmark.hpp"
#include "lab/measure/reference.hpp"
#include "lab/verify/verify.hpp"
#include "lab/verify/verify_history.hpp"

namespace broadside::lab {
namespace {

/// While a failure is minimised, the expected pairs of at most this many boxes come from brute force.
constexpr std::size_t max_boxes_made_smaller_by_definition = 2'000;

}  // namespace

template <int D, typename Real>
std::string fault_on(const History<D, Real>& history, const Entry& entry, std::span<const Algorithm> known) {
  const Algorithm& algorithm = *entry.algorithm;
  const std::string name = entry.spec.text();
  const auto expected = [&](std::span<const Box<D, Real>> boxes) {
    const Reference reference(algorithm, known, boxes.size(), max_boxes_made_smaller_by_definition);
    return reference.pairs<D, Real>(boxes);
  };
  return fault_of(name, [&]() -> std::string {
    Finder<D, Real> finder(algorithm, entry.spec);
    std::vector<Box<D, Real>> boxes = history.boxes;
    for (std::size_t frame = 0; frame <= history.steps.size(); ++frame) {
      if (frame > 0) lab::apply(history.steps[frame - 1], boxes);
      if (const auto divergence = check_finder<D, Real>(finder, boxes, name, expected, frame))
        return divergence->text;
    }
    if (history.steps.empty()) return {};
    Tracker<D, Real> tracker(algorithm, entry.spec);
    const auto divergence = check_tracker<D, Real>(tracker, history, name, expected);
    return divergence ? divergence->text : "";
  });
}

template <int D, typename Real>
std::optional<History<D, Real>> smallest_failure(const History<D, Real>& history, std::size_t frame,
                                                 const Entry& entry, std::span<const Algorithm> known,
                                                 const VerifyOptions& options) {
  const auto fails = [&](const History<D, Real>& some) {
    options.watch.at(
        fmt::format("{}, making the failure smaller: {} frames", entry.spec.text(), some.steps.size() + 1));
    return !fault_on<D, Real>(some, entry, known).empty();
  };
  const Stopwatch watch;
  const auto stop = [&] { return watch.milliseconds() > options.budget_seconds * 1e3; };
  History<D, Real> alone{history.boxes, {}};
  for (std::size_t i = 0; i < frame; ++i) lab::apply(history.steps[i], alone.boxes);
  if (fails(alone)) {
    minimise(
        alone.boxes,
        [&](std::span<const Box<D, Real>> boxes) {
          return fails({{boxes.begin(), boxes.end()}, {}});
        },
        stop);
    return alone;
  }
  History<D, Real> all = history;
  all.steps.resize(frame);
  if (!fails(all)) return std::nullopt;
  minimise(all, fails, stop);
  return all;
}

template std::string fault_on(const History<2, float>&, const Entry&, std::span<const Algorithm>);
template std::optional<History<2, float>> smallest_failure(const History<2, float>&, std::size_t,
                                                           const Entry&, std::span<const Algorithm>,
                                                           const VerifyOptions&);
template std::string fault_on(const History<2, double>&, const Entry&, std::span<const Algorithm>);
template std::optional<History<2, double>> smallest_failure(const History<2, double>&, std::size_t,
                                                            const Entry&, std::span<const Algorithm>,
                                                            const VerifyOptions&);
template std::string fault_on(const History<3, float>&, const Entry&, std::span<const Algorithm>);
template std::optional<History<3, float>> smallest_failure(const History<3, float>&, std::size_t,
                                                           const Entry&, std::span<const Algorithm>,
                                                           const VerifyOptions&);
template std::string fault_on(const History<3, double>&, const Entry&, std::span<const Algorithm>);
template std::optional<History<3, double>> smallest_failure(const History<3, double>&, std::size_t,
                                                            const Entry&, std::span<const Algorithm>,
                                                            const VerifyOptions&);

}  // namespace broadside::lab
