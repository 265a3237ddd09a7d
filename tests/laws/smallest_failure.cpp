// Failing inputs made small: whatever can go goes, as long as the failure remains.
#include "smallest_failure.hpp"

#include <algorithm>
#include <exception>
#include <string>
#include <utility>

#include "broadside/debug/history.hpp"
#include "broadside/debug/minimise.hpp"

#include "lab/verify/verify.hpp"

namespace broadside::laws {
namespace {

/// A failure's text; empty if there is none.
using Failure = std::string;

template <typename Check>
Failure failure_of(Check check) {
  try {
    const auto divergence = check();
    return divergence ? divergence->text : "";
  } catch (const std::exception& error) {
    return std::string("throws: ") + error.what();
  }
}

}  // namespace

template <int D>
testing::AssertionResult finds_the_pairs(const Algorithm& algorithm, const Spec& spec,
                                         std::vector<Box<D>> boxes) {
  Failure failure;
  const auto fails = [&](std::span<const Box<D>> some) {
    const Failure found = failure_of([&] {
      Finder<D> finder(algorithm, spec);
      return lab::check_finder<D>(finder, some, spec.text());
    });
    if (!found.empty()) failure = found;
    return !found.empty();
  };
  if (!fails(boxes)) return testing::AssertionSuccess();
  minimise(boxes, fails);
  return testing::AssertionFailure() << failure << "\n" << text_of(History<D>{boxes, {}});
}

template <int D>
testing::AssertionResult tracks_the_pairs(const Algorithm& algorithm, const Spec& spec,
                                          lab::History<D> history) {
  Failure failure;
  const auto fails = [&](const lab::History<D>& some) {
    const Failure found = failure_of([&] {
      Tracker<D> tracker(algorithm, spec);
      return lab::check_tracker<D>(tracker, some, spec.text());
    });
    if (!found.empty()) failure = found;
    return !found.empty();
  };
  if (!fails(history)) return testing::AssertionSuccess();
  minimise(history, fails);
  return testing::AssertionFailure() << failure << "\n" << text_of(history);
}

template testing::AssertionResult finds_the_pairs(const Algorithm&, const Spec&, std::vector<Box<2>>);
template testing::AssertionResult finds_the_pairs(const Algorithm&, const Spec&, std::vector<Box<3>>);
template testing::AssertionResult tracks_the_pairs(const Algorithm&, const Spec&, lab::History<2>);
template testing::AssertionResult tracks_the_pairs(const Algorithm&, const Spec&, lab::History<3>);

}  // namespace broadside::laws
