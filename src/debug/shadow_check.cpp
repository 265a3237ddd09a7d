// ShadowCheck.
#include "debug/shadow_check.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <utility>

#include "broadside/debug/minimise.hpp"
#include "broadside/error.hpp"

#include "core/input_check.hpp"
#include "debug/definition.hpp"

namespace broadside::core {
namespace {

using Pairs = std::vector<Pair>;

[[noreturn]] void refuse_unlisted(std::size_t frame, const std::string& what) {
  throw InvalidFrame("frame " + std::to_string(frame) + ": " + what +
                     ", and is not listed; expected every change in the frame's lists");
}

/// Throws if a box that is not listed, or its filter, is not the one that the tracker knows. Such boxes are
/// in both frames.
template <int D, typename Real>
void check_unlisted(const Frame<D, Real>& last, const Frame<D, Real>& frame,
                    std::span<const std::uint8_t> is_listed, std::size_t number) {
  for (std::size_t i = 0; i < std::min(last.boxes.size(), frame.boxes.size()); ++i) {
    if (is_listed[i] != 0) continue;
    const Box<D, Real>& box = frame.boxes[i];
    const Box<D, Real>& known = last.boxes[i];
    // An invalid box can only have been let in as an absent one.
    if (box != known && !(is_invalid(box) && is_absent(known)))
      refuse_unlisted(number,
                      "box " + std::to_string(i) + " had " + text_of(known) + ", has now " + text_of(box));
    if (!frame.filters.empty() && frame.filters[i] != last.filters[i])
      refuse_unlisted(number, "box " + std::to_string(i) + " has another filter than before");
  }
}

/// The pairs that are ignored in one of the two frames, sorted. A null pointer is an empty set.
Pairs difference(const IgnoredPairs* before, const IgnoredPairs* now) {
  Pairs pairs;
  const auto add_missing = [&pairs](const IgnoredPairs* from, const IgnoredPairs* in) {
    if (from == nullptr) return;
    from->for_each([&](Pair pair) {
      if (in == nullptr || !in->contains(pair)) pairs.push_back(pair);
    });
  };
  add_missing(before, now);
  add_missing(now, before);
  std::ranges::sort(pairs);
  return pairs;
}

void check_listed(const Pairs& toggled, std::span<const Pair> listed, std::size_t frame) {
  IgnoredPairs named;
  for (const Pair pair : listed) named.insert(pair);
  for (const Pair pair : toggled) {
    if (named.contains(pair)) continue;
    refuse_unlisted(frame, "the pair (" + std::to_string(index(pair.first)) + ", " +
                               std::to_string(index(pair.second)) + ") is newly ignored or no longer");
  }
}

void hand_on(const EventPairs& events, PairSink& begun, PairSink& ended) {
  try {
    begun.put(events.begun);
    ended.put(events.ended);
  } catch (...) {
    begun.discard();
    ended.discard();
    throw;
  }
}

}  // namespace

template <int D, typename Real>
std::optional<Statistics> ShadowCheck<D, Real>::update(Tracker<D, Real>& tracker, const Frame<D, Real>& frame,
                                                       PairSink& begun, PairSink& ended) {
  if (fault_) diverge(*fault_, faulty_);
  const bool lists_count = std::exchange(is_whole_, false);
  const Frame<D, Real> last = tracker.last_frame();
  const Pairs toggled = difference(last.ignored, frame.ignored);
  Frame<D, Real> checked = frame;
  if (!lists_count) checked.changed = {};
  try {
    check_frame(checked, last.boxes.size(), !lists_count, tracker.bad_input());
  } catch (...) {  // nothing has changed
    is_whole_ = lists_count;
    throw;
  }
  // With the first filters, or without the last ones, every box has changed.
  if (lists_count && frame.filters.empty() == last.filters.empty())
    list_changed(last, frame);
  else
    list_all(std::max(frame.boxes.size(), last.boxes.size()));
  if (lists_count && (frame.ignored != nullptr) == (last.ignored != nullptr))
    check_listed(toggled, frame.ignored_changed, log_.count());

  // Whatever takes memory comes before the tracker is asked, so that what it takes is known here as well.
  boxes_.assign(frame.boxes.begin(), frame.boxes.end());
  for (Box<D, Real>& box : boxes_) {
    if (is_invalid(box)) box = absent_box<D, Real>();
  }
  if (log_.count() == 0) pairs_ = pairs_by_definition(last);
  std::vector<BoxId> present = changed_;
  std::erase_if(present, [&](BoxId id) { return index(id) >= frame.boxes.size(); });
  const Frame<D, Real> seen{boxes_, present, frame.filters, frame.ignored, toggled};
  Pairs now = pairs_by_definition(seen);
  const EventPairs expected = events_between(pairs_, now);
  log_.prepare(seen, toggled);
  EventPairs events;
  // As soon as all are there and right, they are handed on. If a sink then throws, the tracker has not taken
  // the frame either.
  const auto collect_in = [&](std::vector<Pair>& some) {
    return [&](std::span<const Pair> pairs) {
      some.insert(some.end(), pairs.begin(), pairs.end());
      if (events == expected) hand_on(events, begun, ended);
    };
  };
  const std::optional<Statistics> statistics =
      tracker.update({frame.boxes, changed_, frame.filters, frame.ignored, toggled}, collect_in(events.begun),
                     collect_in(events.ended));
  log_.add();
  fault_ = fault_of(events, expected);
  if (fault_) {
    faulty_ = std::move(now);
    diverge(*fault_, faulty_);
  }
  pairs_ = std::move(now);
  is_whole_ = true;
  return statistics;
}

template <int D, typename Real>
void ShadowCheck<D, Real>::list_all(std::size_t size) {
  changed_.resize(size);
  for (std::size_t i = 0; i < size; ++i) changed_[i] = BoxId(i);
}

/// Lists what the frame does, and the boxes that it need not list, each once.
template <int D, typename Real>
void ShadowCheck<D, Real>::list_changed(const Frame<D, Real>& last, const Frame<D, Real>& frame) {
  const std::size_t size = std::max(frame.boxes.size(), last.boxes.size());
  std::vector<std::uint8_t> is_listed(size);
  changed_.clear();
  const auto list = [&](std::size_t place) {
    if (std::exchange(is_listed[place], std::uint8_t{1}) == 0) changed_.push_back(BoxId(place));
  };
  for (const BoxId id : frame.changed) list(index(id));
  for (std::size_t i = std::min(frame.boxes.size(), last.boxes.size()); i < size; ++i) list(i);
  check_unlisted<D, Real>(last, frame, is_listed, log_.count());
}

/// Throws the divergence. Where there is no memory to tell it, that is thrown, and told the next time.
template <int D, typename Real>
void ShadowCheck<D, Real>::diverge(const Fault& fault, const Pairs& now) {
  if (!divergence_) divergence_ = std::make_exception_ptr(explained(fault, now));
  std::rethrow_exception(divergence_);
}

template <int D, typename Real>
DivergenceOf<D, Real> ShadowCheck<D, Real>::explained(const Fault& fault, const Pairs& now) const {
  const std::size_t number = log_.count() - 1;
  const History<D, Real> kept = log_.history();
  Replay<D, Real> replay(kept);
  for (const Step<D, Real>& step : kept.steps) replay.next(step);
  const Frame<D, Real> frame = replay.frame();
  std::string text = name_ + " " + text_of(fault) + " in frame " + std::to_string(number);
  for (const BoxId id : {fault.pair.first, fault.pair.second}) {
    const bool is_there = index(id) < frame.boxes.size() && !is_absent(frame.boxes[index(id)]);
    text += "; box " + std::to_string(index(id)) +
            (is_there ? " has " + text_of(frame.boxes[index(id)]) : " is absent");
  }
  const bool holds = std::ranges::binary_search(now, fault.pair);
  text += std::string("; expected, by the definition: the pair ") + (holds ? "holds" : "does not hold") +
          ", and before this frame it " +
          (std::ranges::binary_search(pairs_, fault.pair) ? "held" : "did not");

  std::optional<History<D, Real>> small;
  if (make_) small = smallest_fault<D, Real>(kept, make_, options_.tests);
  const bool reproduced = small.has_value();
  if (reproduced) {
    text += "\nthe smallest history found in whose last frame it errs:\n";
  } else {
    text += make_
                ? "\na new one does not err in the last " + std::to_string(kept.steps.size() + 1) + " frames"
                : "\nthere is no other one to try histories on";
    text += "; in them, these two boxes:\n";
    const std::array<std::size_t, 2> places = {index(fault.pair.first), index(fault.pair.second)};
    small = only<D, Real>(places, kept);
  }
  text += broadside::text_of(*small);
  return {Divergence(text, fault.pair, number, holds), std::move(*small), reproduced};
}

template class ShadowCheck<2, float>;
template class ShadowCheck<2, double>;
template class ShadowCheck<3, float>;
template class ShadowCheck<3, double>;

}  // namespace broadside::core
