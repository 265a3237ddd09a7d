// ShadowTracker: any tracker with brute force beside it.
#include "broadside/debug/shadow.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <span>

#include "broadside/algorithm.hpp"
#include "broadside/debug/minimise.hpp"
#include "broadside/error.hpp"

#include "debug/definition.hpp"
#include "debug/frame_log.hpp"
#include "debug/tracker_fault.hpp"
#include "interface/box_text.hpp"

namespace broadside {
namespace {

using Pairs = std::vector<Pair>;

[[noreturn]] void refuse_unlisted(std::size_t frame, const std::string& what) {
  throw InvalidFrame("frame " + std::to_string(frame) + ": " + what +
                     ", and is not listed; expected every change in the frame's lists");
}

/// Throws if a box or a filter in the frame is not the one that trackers see.
template <int D, typename Real>
void check_listed(const Change<D, Real>& change, std::size_t frame) {
  const Frame<D, Real>& given = *change.frame;
  for (std::size_t i = 0; i < given.boxes.size(); ++i) {
    const Box<D, Real>& box = given.boxes[i];
    const Box<D, Real>& seen = change.now[i];
    const bool is_box = is_present(box) || is_absent(box);
    // What is no box can only have been let in as an absent one.
    if (box != seen && (is_box || !is_absent(seen)))
      refuse_unlisted(frame, "box " + std::to_string(i) + " had " + core::text_of(seen) + ", has now " +
                                 core::text_of(box));
    if (!given.filters.empty() && given.filters[i] != change.filters_now[i])
      refuse_unlisted(frame, "box " + std::to_string(i) + " has another filter than before");
  }
}

/// The pairs that are ignored in one of the two frames, sorted.
Pairs difference(const IgnoredPairs& before, const IgnoredPairs& now) {
  Pairs pairs;
  const auto add_missing = [&pairs](const IgnoredPairs& from, const IgnoredPairs& in) {
    from.for_each([&](Pair pair) {
      if (!in.contains(pair)) pairs.push_back(pair);
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

}  // namespace

template <int D, typename Real>
struct BROADSIDE_HIDDEN ShadowTracker<D, Real>::State {
  std::unique_ptr<PairTracker<D, Real>> tracker;
  Make make;
  std::string name;
  ShadowOptions options;
  core::FrameLog<D, Real> log;
  Pairs pairs{};           // those that hold since the tracker's last update, by the definition
  IgnoredPairs ignored{};  // then, likewise
  bool had_ignored = false;
  std::optional<core::Fault> fault{};  // in the last frame of the log
  Pairs now{};                         // the pairs of that frame
  std::exception_ptr divergence{};     // which tells all about it

  /// Throws the divergence. Where there is no memory to tell it, that is thrown, and told the next time.
  [[noreturn]] void diverge() {
    if (!divergence) divergence = std::make_exception_ptr(explained());
    std::rethrow_exception(divergence);
  }

  DivergenceOf<D, Real> explained() const {
    const std::size_t number = log.count() - 1;
    const History<D, Real> kept = log.history();
    Replay<D, Real> replay(kept);
    for (const Step<D, Real>& step : kept.steps) replay.next(step);
    const Frame<D, Real> frame = replay.frame();
    std::string text = name + " " + text_of(*fault) + " in frame " + std::to_string(number);
    for (const BoxId id : {fault->pair.first, fault->pair.second}) {
      const bool is_there = index(id) < frame.boxes.size() && !is_absent(frame.boxes[index(id)]);
      text += "; box " + std::to_string(index(id)) +
              (is_there ? " has " + core::text_of(frame.boxes[index(id)]) : " is absent");
    }
    const bool holds = std::ranges::binary_search(now, fault->pair);
    text += std::string("; expected, by the definition: the pair ") + (holds ? "holds" : "does not hold") +
            ", and before this frame it " +
            (std::ranges::binary_search(pairs, fault->pair) ? "held" : "did not");

    std::optional<History<D, Real>> small;
    if (make) small = core::smallest_fault<D, Real>(kept, make, options.tests);
    const bool reproduced = small.has_value();
    if (reproduced) {
      text += "\nthe smallest history found in whose last frame it errs:\n";
    } else {
      text +=
          make ? "\na new one does not err in the last " + std::to_string(kept.steps.size() + 1) + " frames"
               : "\nthere is no other one to try histories on";
      text += "; in them, these two boxes:\n";
      const std::array<std::size_t, 2> places = {index(fault->pair.first), index(fault->pair.second)};
      small = only<D, Real>(places, kept);
    }
    text += text_of(*small);
    return {Divergence(text, fault->pair, number, holds), std::move(*small), reproduced};
  }
};

template <int D, typename Real>
ShadowTracker<D, Real>::ShadowTracker(std::unique_ptr<PairTracker<D, Real>> tracker, Make make,
                                      std::string name, const ShadowOptions& options) {
  if (!tracker) throw std::invalid_argument("ShadowTracker was given a null tracker; expected a tracker");
  this->set_workers(tracker->workers());
  state_ = std::make_unique<State>(State{std::move(tracker), std::move(make), std::move(name), options,
                                         core::FrameLog<D, Real>(options.frames, options.bytes)});
}

template <int D, typename Real>
ShadowTracker<D, Real>::ShadowTracker(std::string_view spec, const ShadowOptions& options)
    : ShadowTracker(
          make_tracker<D, Real>(spec), [name = std::string(spec)] { return make_tracker<D, Real>(name); },
          std::string(spec), options) {}

template <int D, typename Real>
ShadowTracker<D, Real>::ShadowTracker(Make make, const ShadowOptions& options)
    : ShadowTracker(make(), make, "the tracker", options) {}

template <int D, typename Real>
ShadowTracker<D, Real>::ShadowTracker(std::unique_ptr<PairTracker<D, Real>> tracker,
                                      const ShadowOptions& options)
    : ShadowTracker(std::move(tracker), {}, "the tracker", options) {}

template <int D, typename Real>
ShadowTracker<D, Real>::~ShadowTracker() = default;

template <int D, typename Real>
void ShadowTracker<D, Real>::update_valid(const Change<D, Real>& change, PairSink& begun, PairSink& ended) {
  State& state = *state_;
  if (state.fault) state.diverge();
  const Frame<D, Real> seen{change.now, change.changed, change.filters_now};
  const Frame<D, Real>& given = change.frame != nullptr ? *change.frame : seen;
  static const IgnoredPairs none;
  const Pairs toggled = difference(state.ignored, given.ignored != nullptr ? *given.ignored : none);
  if (change.frame != nullptr) {
    check_listed(change, state.log.count());
    if (!change.rebuild && state.had_ignored == (given.ignored != nullptr))
      check_listed(toggled, given.ignored_changed, state.log.count());
  }

  // The tracker may have taken a frame that this one, whose sink threw, has not: it goes on from its own,
  // which may have had fewer boxes. Those that this frame has no more it knows to be gone.
  std::vector<BoxId> changed;
  std::ranges::copy_if(change.changed, std::back_inserter(changed),
                       [&given](BoxId id) { return index(id) < given.boxes.size(); });
  const Frame<D, Real> frame{change.now.first(given.boxes.size()), changed, given.filters, given.ignored,
                             toggled};
  // Whatever takes memory comes before the tracker is asked, so that what it takes is known here as well.
  Pairs now = core::pairs_by_definition(frame);
  const core::EventPairs expected = core::events_between(state.pairs, now);
  IgnoredPairs ignored = given.ignored != nullptr ? *given.ignored : IgnoredPairs();
  state.log.prepare(frame, toggled);
  const core::EventPairs events = core::events_of(*state.tracker, frame);
  this->count(state.tracker->statistics());
  state.log.add();
  state.fault = core::fault_of(events, expected);
  if (state.fault) {
    state.now = std::move(now);
    state.diverge();
  }
  state.pairs = std::move(now);
  state.ignored = std::move(ignored);
  state.had_ignored = given.ignored != nullptr;

  if (!change.rebuild) {
    begun.put(events.begun);
    ended.put(events.ended);
    return;
  }
  const Frame<D, Real> before{change.before, {}, change.filters_before};
  for (const Pair pair : core::pairs_by_definition(before))
    change.report(pair.first, pair.second, begun, ended);
  for (const Pair pair : state.pairs) change.report(pair.first, pair.second, begun, ended);
}

template <int D, typename Real>
std::string ShadowTracker<D, Real>::explanation() const {
  return state_->tracker->explanation();
}

template <int D, typename Real>
void ShadowTracker<D, Real>::workers_changed() {
  if (state_) state_->tracker->set_workers(this->workers());
}

template <int D, typename Real>
std::size_t ShadowTracker<D, Real>::algorithm_bytes() const noexcept {
  return state_->tracker->bytes() + state_->log.bytes() + state_->pairs.capacity() * sizeof(Pair);
}

template class ShadowTracker<2, float>;
template class ShadowTracker<2, double>;
template class ShadowTracker<3, float>;
template class ShadowTracker<3, double>;

}  // namespace broadside
