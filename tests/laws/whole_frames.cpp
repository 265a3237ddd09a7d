// Frames with all that a tracker can be given, and what it must answer.
#include "whole_frames.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "tests/support/rng.hpp"

namespace broadside::laws {
namespace {

std::vector<Pair> symmetric_difference(const std::vector<Pair>& a, const std::vector<Pair>& b) {
  std::vector<Pair> pairs;
  std::ranges::set_symmetric_difference(a, b, std::back_inserter(pairs));
  return pairs;
}

/// What differs first between a list of events and what it should be.
std::string first_difference(const std::vector<Pair>& found, const std::vector<Pair>& expected) {
  const auto [at, should] = std::mismatch(found.begin(), found.end(), expected.begin(), expected.end());
  const auto text = [](const std::vector<Pair>& pairs, std::vector<Pair>::const_iterator place) {
    if (place == pairs.end()) return std::string("nothing");
    return "(" + std::to_string(index(place->first)) + ", " + std::to_string(index(place->second)) + ")";
  };
  return ": event " + std::to_string(at - found.begin()) + " is " + text(found, at) + "; expected " +
         text(expected, should);
}

/// The pairs as a caller may list them: in no order, with the boxes of each in either one, some twice.
std::vector<Pair> listed_somehow(std::vector<Pair> pairs) {
  Rng rng(pairs.size());
  for (std::size_t i = pairs.size(); i > 0; --i) {
    if (rng.one_in(4)) pairs.push_back(pairs[i - 1]);
    if (rng.one_in(2)) std::swap(pairs[i - 1].first, pairs[i - 1].second);
  }
  rng.shuffle(pairs);
  return pairs;
}

}  // namespace

template <int D, typename Real>
std::vector<BoxId> changed_places(const WholeFrame<D, Real>& from, const WholeFrame<D, Real>& to) {
  std::vector<BoxId> changed = to.listed;
  std::erase_if(changed, [&](BoxId id) { return index(id) >= std::max(from.boxes.size(), to.boxes.size()); });
  const auto differ = [&](std::size_t i) {
    return from.boxes[i] != to.boxes[i] ||
           (!from.filters.empty() && !to.filters.empty() && from.filters[i] != to.filters[i]);
  };
  for (std::size_t i = 0; i < std::min(from.boxes.size(), to.boxes.size()); ++i) {
    if (differ(i)) changed.push_back(BoxId(i));
  }
  Rng(changed.size()).shuffle(changed);
  return changed;
}

template <int D, typename Real>
std::vector<Pair> pairs_of(const WholeFrame<D, Real>& frame) {
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < frame.boxes.size(); ++i) {
    if (!is_present(frame.boxes[i])) continue;
    for (std::size_t j = i + 1; j < frame.boxes.size(); ++j) {
      if (is_present(frame.boxes[j]) && overlap(frame.boxes[i], frame.boxes[j]))
        pairs.push_back({BoxId(i), BoxId(j)});
    }
  }
  if (!frame.filters.empty()) {
    std::erase_if(pairs, [&](Pair pair) {
      return !accepts(frame.filters[index(pair.first)], frame.filters[index(pair.second)]);
    });
  }
  if (frame.ignored) {
    std::erase_if(pairs, [&](Pair pair) { return std::ranges::binary_search(*frame.ignored, pair); });
  }
  return pairs;
}

template <int D, typename Real>
std::string divergence(Tracker<D, Real>& tracker, std::span<const WholeFrame<D, Real>> frames,
                       const RunUpdate& run) {
  WholeFrame<D, Real> last{};  // the one handed in before, whether taken or not
  std::vector<Pair> held;      // after the last whole update
  std::size_t whole_size = 0;  // how many boxes that had
  IgnoredPairs ignored;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const WholeFrame<D, Real>& frame = frames[i];
    std::vector<BoxId> changed = changed_places(last, frame);
    // After a failed update only the last whole frame's boxes are sure to be known.
    std::erase_if(changed, [&](BoxId id) { return index(id) >= std::max(whole_size, frame.boxes.size()); });
    // Pairs that are ignored from the first frame on in which any can be need not be listed.
    std::vector<Pair> ignored_changed;
    if (frame.ignored) {
      if (last.ignored) ignored_changed = listed_somehow(symmetric_difference(*last.ignored, *frame.ignored));
      ignored.clear();
      for (const Pair pair : *frame.ignored) ignored.insert(pair);
    }
    LimitedCollector begun(frame.begun_room);
    LimitedCollector ended(frame.ended_room);
    last = frame;
    const auto update = [&] {
      tracker.update(
          {frame.boxes, changed, frame.filters, frame.ignored ? &ignored : nullptr, ignored_changed}, begun,
          ended);
    };
    try {
      if (!run)
        update();
      else if (!run(update))
        continue;
    } catch (const SinkIsFull&) {
      continue;
    }
    std::vector<Pair> now = pairs_of(frame);
    std::vector<Pair> should_begin;
    std::vector<Pair> should_end;
    std::ranges::set_difference(now, held, std::back_inserter(should_begin));
    std::ranges::set_difference(held, now, std::back_inserter(should_end));
    for (const auto& [found, expected, what] : {std::tuple(&begun.pairs(), &should_begin, "begun"),
                                                std::tuple(&ended.pairs(), &should_end, "ended")}) {
      if (*found != *expected)
        return "frame " + std::to_string(i) + ", " + what + first_difference(*found, *expected);
    }
    held = std::move(now);
    whole_size = frame.boxes.size();
  }
  return "";
}

template std::vector<BoxId> changed_places(const WholeFrame<2>&, const WholeFrame<2>&);
template std::vector<BoxId> changed_places(const WholeFrame<3>&, const WholeFrame<3>&);
template std::vector<Pair> pairs_of(const WholeFrame<2>&);
template std::vector<Pair> pairs_of(const WholeFrame<3>&);
template std::vector<Pair> pairs_of(const WholeFrame<2, double>&);
template std::vector<Pair> pairs_of(const WholeFrame<3, double>&);
template std::string divergence(Tracker<2>&, std::span<const WholeFrame<2>>, const RunUpdate&);
template std::string divergence(Tracker<3>&, std::span<const WholeFrame<3>>, const RunUpdate&);
template std::string divergence(Tracker<2, double>&, std::span<const WholeFrame<2, double>>,
                                const RunUpdate&);
template std::string divergence(Tracker<3, double>&, std::span<const WholeFrame<3, double>>,
                                const RunUpdate&);
}  // namespace broadside::laws
