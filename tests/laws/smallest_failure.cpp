// Failing inputs made small: whatever can go goes, as long as the failure remains.
#include "smallest_failure.hpp"

#include <algorithm>
#include <exception>
#include <string>
#include <utility>

#include <fmt/format.h>

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

template <int D>
testing::AssertionResult tracks_the_frames(const Algorithm& algorithm, const Spec& spec,
                                           std::vector<WholeFrame<D>> frames) {
  std::string failure;
  std::size_t tries = 0;
  const auto fails = [&](const std::vector<WholeFrame<D>>& some) {
    if (++tries > 3000) return false;
    std::string found;
    try {
      Tracker<D> tracker(algorithm, spec);
      found = divergence<D, float>(tracker, some);
    } catch (const std::exception& error) {
      found = std::string("throws: ") + error.what();
    }
    if (!found.empty()) failure = found;
    return !found.empty();
  };
  if (!fails(frames)) return testing::AssertionSuccess();
  const auto try_without = [&](auto change) {
    std::vector<WholeFrame<D>> fewer = frames;
    change(fewer);
    if (fails(fewer)) frames = std::move(fewer);
  };
  for (std::size_t part = frames.size() / 2; part > 0; part /= 2) {
    for (std::size_t first = 0; first + part <= frames.size(); first += part)
      try_without([&](auto& fewer) {
        fewer.erase(fewer.begin() + std::ptrdiff_t(first), fewer.begin() + std::ptrdiff_t(first + part));
      });
  }
  const auto in_each = [&](auto change) {
    try_without([&](auto& fewer) {
      for (WholeFrame<D>& frame : fewer) change(frame);
    });
  };
  in_each([](WholeFrame<D>& frame) { frame.filters.clear(); });
  in_each([](WholeFrame<D>& frame) { frame.ignored.reset(); });
  in_each([](WholeFrame<D>& frame) { frame.listed.clear(); });
  in_each([](WholeFrame<D>& frame) { frame.begun_room = frame.ended_room = no_limit; });
  std::size_t places = 0;
  for (const WholeFrame<D>& frame : frames) places = std::max(places, frame.boxes.size());
  for (std::size_t part = places; part > 0; part /= 2) {
    for (std::size_t first = 0; first < places; first += part)
      in_each([&](WholeFrame<D>& frame) {
        for (std::size_t i = first; i < std::min(first + part, frame.boxes.size()); ++i)
          frame.boxes[i] = absent_box<D>();
      });
  }
  fails(frames);
  std::string text = spec.text() + ": " + failure;
  for (const WholeFrame<D>& frame : frames) {
    text += fmt::format("\nframe of {} boxes, sinks of {} and {}, {}; present:", frame.boxes.size(),
                        std::ptrdiff_t(frame.begun_room), std::ptrdiff_t(frame.ended_room),
                        frame.ignored ? fmt::format("{} pairs ignored", frame.ignored->size()) : "no set");
    for (std::size_t i = 0; i < frame.boxes.size(); ++i) {
      if (is_absent(frame.boxes[i])) continue;
      text += fmt::format("\n  {}: {{{{{}}}, {{{}}}}}", i, fmt::join(frame.boxes[i].min, ", "),
                          fmt::join(frame.boxes[i].max, ", "));
      if (frame.filters.empty()) continue;
      const Filter& filter = frame.filters[i];
      text += fmt::format(" filter {:x} {:x} {} {}", filter.category, filter.mask, filter.group,
                          filter.is_static ? "static" : "");
    }
  }
  return testing::AssertionFailure() << text;
}

template testing::AssertionResult finds_the_pairs(const Algorithm&, const Spec&, std::vector<Box<2>>);
template testing::AssertionResult finds_the_pairs(const Algorithm&, const Spec&, std::vector<Box<3>>);
template testing::AssertionResult tracks_the_pairs(const Algorithm&, const Spec&, lab::History<2>);
template testing::AssertionResult tracks_the_pairs(const Algorithm&, const Spec&, lab::History<3>);
template testing::AssertionResult tracks_the_frames(const Algorithm&, const Spec&,
                                                    std::vector<WholeFrame<2>>);
template testing::AssertionResult tracks_the_frames(const Algorithm&, const Spec&,
                                                    std::vector<WholeFrame<3>>);

}  // namespace broadside::laws
