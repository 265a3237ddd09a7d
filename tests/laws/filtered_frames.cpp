// Histories with filters and ignored pairs, and the law of trackers on them.
#include "filtered_frames.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <exception>
#include <iterator>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "lab/verify/verify.hpp"
#include "tests/support/rng.hpp"

namespace broadside::laws {
namespace {

/// Few filters, so that many accept each other and many do not.
Filter any_filter(Rng& rng) {
  if (rng.one_in(3)) return {};
  constexpr std::array<std::uint32_t, 4> masks = {0xffffffffU, 1, 3, 0x80000001U};
  constexpr std::array<std::uint32_t, 3> categories = {1, 2, 0x80000000U};
  return {.category = rng.one_of<std::uint32_t>(categories),
          .mask = rng.one_of<std::uint32_t>(masks),
          .group = rng.one_in(3) ? rng.whole(-2, 2) : 0,
          .is_static = rng.one_in(4)};
}

/// The pairs that are ignored while a history goes on.
class Ignored {
 public:
  void toggle(Pair pair) {
    const auto place = std::ranges::lower_bound(pairs_, pair);
    if (place != pairs_.end() && *place == pair)
      pairs_.erase(place);
    else
      pairs_.insert(place, pair);
  }

  void clear() { pairs_.clear(); }
  const std::vector<Pair>& pairs() const { return pairs_; }

 private:
  std::vector<Pair> pairs_;
};

}  // namespace

template <int D>
std::vector<WholeFrame<D>> whole_frames(const lab::History<D>& history) {
  std::vector<WholeFrame<D>> frames(1);
  frames[0].boxes = history.boxes;
  for (const lab::Step<D>& step : history.steps) {
    WholeFrame<D> frame;
    frame.boxes = frames.back().boxes;
    lab::apply(step, frame.boxes);
    std::ranges::copy_if(step.changed, std::back_inserter(frame.listed),
                         [&](BoxId id) { return index(id) < frame.boxes.size(); });
    frames.push_back(std::move(frame));
  }
  return frames;
}

template <int D>
std::vector<WholeFrame<D>> with_filters(std::vector<WholeFrame<D>> frames, std::uint64_t seed) {
  Rng rng(seed);
  std::size_t places = 2;
  for (const WholeFrame<D>& frame : frames) places = std::max(places, frame.boxes.size());
  std::vector<Filter> filters(places);
  for (Filter& filter : filters) filter = any_filter(rng);
  Ignored ignored;
  bool filters_given = rng.one_in(2);
  bool ignored_given = rng.one_in(2);
  for (WholeFrame<D>& frame : frames) {
    if (rng.one_in(12)) filters_given = !filters_given;
    if (rng.one_in(12)) ignored_given = !ignored_given;
    if (rng.one_in(2)) {
      for (std::size_t count = rng.one_in(20) ? places : rng.below(10); count > 0; --count)
        filters[rng.below(places)] = any_filter(rng);
    }
    if (rng.one_in(30)) ignored.clear();
    if (rng.one_in(2)) {
      // Pairs of boxes that overlap, and of any places, of which some are not there.
      const std::vector<Pair> overlapping = lab::reference_pairs<D>(frame.boxes);
      for (std::size_t count = rng.below(8); count > 0; --count) {
        const auto a = BoxId(rng.below(places));
        const auto b = BoxId(rng.below(places));
        if (!overlapping.empty() && !rng.one_in(3))
          ignored.toggle(rng.one_of<Pair>(overlapping));
        else if (a != b)
          ignored.toggle({std::min(a, b), std::max(a, b)});
      }
    }
    if (filters_given) frame.filters.assign(filters.begin(), filters.begin() + frame.boxes.size());
    if (ignored_given) frame.ignored = ignored.pairs();
    if (rng.one_in(8)) frame.begun_room = rng.below(4);
    if (rng.one_in(8)) frame.ended_room = rng.below(4);
  }
  return frames;
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

template std::vector<WholeFrame<2>> whole_frames(const lab::History<2>&);
template std::vector<WholeFrame<3>> whole_frames(const lab::History<3>&);
template std::vector<WholeFrame<2>> with_filters(std::vector<WholeFrame<2>>, std::uint64_t);
template std::vector<WholeFrame<3>> with_filters(std::vector<WholeFrame<3>>, std::uint64_t);
template testing::AssertionResult tracks_the_frames(const Algorithm&, const Spec&,
                                                    std::vector<WholeFrame<2>>);
template testing::AssertionResult tracks_the_frames(const Algorithm&, const Spec&,
                                                    std::vector<WholeFrame<3>>);

}  // namespace broadside::laws
