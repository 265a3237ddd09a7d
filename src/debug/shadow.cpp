// ShadowTracker: checks a tracker's events against brute force, and minimises what fails.
#include "broadside/debug/shadow.hpp"

#include <algorithm>
#include <array>

#include "broadside/debug/minimise.hpp"
#include "broadside/error.hpp"

#include "core/float_environment.hpp"
#include "core/input_check.hpp"
#include "debug/frame_log.hpp"
#include "debug/tracker_fault.hpp"

namespace broadside {
namespace {

using debug::EventPairs;
using debug::Pairs;
using debug::WrongEvent;

[[noreturn]] void refuse_unlisted(std::size_t frame, const std::string& what) {
  throw InvalidFrame("frame " + std::to_string(frame) + ": " + what +
                     ", and is not listed; expected every change to be listed");
}

/// Throws if an unlisted box or its filter differs from the one that the tracker knows. Looks only at boxes
/// in both frames: all others are listed.
template <int D, typename Real>
void check_unlisted(const Frame<D, Real>& last, const Frame<D, Real>& frame,
                    std::span<const std::uint8_t> is_listed, std::size_t number) {
  for (std::size_t i = 0; i < std::min(last.boxes.size(), frame.boxes.size()); ++i) {
    if (is_listed[i] != 0) continue;
    const Box<D, Real>& box = frame.boxes[i];
    const Box<D, Real>& known = last.boxes[i];
    // The tracker knows an invalid box only as an absent one.
    if (box != known && !(core::is_invalid(box) && is_absent(known)))
      refuse_unlisted(number, "box " + std::to_string(i) + " had " + core::text_of(known) + ", now has " +
                                  core::text_of(box));
    if (!frame.filters.empty() && frame.filters[i] != last.filters[i])
      refuse_unlisted(number, "box " + std::to_string(i) + " has a different filter than before");
  }
}

/// The pairs that are ignored in exactly one of the two frames, sorted. A null pointer is an empty set.
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
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

void check_listed(const Pairs& toggled, std::span<const Pair> listed, std::size_t frame) {
  IgnoredPairs named;
  for (const Pair pair : listed) named.insert(pair);
  for (const Pair pair : toggled) {
    if (!named.contains(pair))
      refuse_unlisted(frame, "the pair " + debug::text_of(pair) + " became ignored or is no longer ignored");
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
struct BROADSIDE_HIDDEN ShadowTracker<D, Real>::State {
  /// `name`: the tracker's name in messages. `make`, which may be empty, makes trackers to replay histories
  /// on.
  State(Tracker<D, Real> its_tracker, std::string name, Make make, const ShadowOptions& options)
      : tracker(std::move(its_tracker)),
        name_(std::move(name)),
        make_(std::move(make)),
        options_(options),
        log_(options.frames, options.bytes) {}

  /// Passes a frame to the tracker, and writes its events. In the first frame and after a failed one, the
  /// frame's lists do not count: everything may have changed.
  std::optional<Statistics> update(const Frame<D, Real>& frame, PairSink& begun, PairSink& ended) {
    if (fault_) diverge();
    const bool lists_count = std::exchange(is_whole_, false);
    const Frame<D, Real> last = tracker.last_frame();
    const Pairs toggled = difference(last.ignored, frame.ignored);
    Frame<D, Real> checked = frame;
    if (!lists_count) checked.changed = {};
    try {
      core::check_frame(checked, last.boxes.size(), !lists_count, tracker.bad_input());
    } catch (...) {  // nothing has changed
      is_whole_ = lists_count;
      throw;
    }
    // If filters appear or disappear, every box has changed.
    if (!lists_count || frame.filters.empty() != last.filters.empty()) {
      changed_.resize(std::max(frame.boxes.size(), last.boxes.size()));
      for (std::size_t i = 0; i < changed_.size(); ++i) changed_[i] = BoxId(i);
    } else {
      list_changed(last, frame);
    }
    if (lists_count && (frame.ignored != nullptr) == (last.ignored != nullptr))
      check_listed(toggled, frame.ignored_changed, log_.count());

    // Allocates memory first, so that this state misses no frame that the tracker takes.
    boxes_.assign(frame.boxes.begin(), frame.boxes.end());
    for (Box<D, Real>& box : boxes_) {
      if (core::is_invalid(box)) box = absent_box<D, Real>();
    }
    if (log_.count() == 0) pairs_ = debug::pairs_by_definition(last);
    std::vector<BoxId> present = changed_;
    std::erase_if(present, [&](BoxId id) { return index(id) >= frame.boxes.size(); });
    const Frame<D, Real> seen{boxes_, present, frame.filters, frame.ignored, toggled};
    Pairs now = debug::pairs_by_definition(seen);
    const EventPairs expected = debug::events_between(pairs_, now);
    log_.prepare(seen, toggled);
    EventPairs events;
    // Passes the events on as soon as all are there and right. If a sink then throws, the tracker has not
    // taken the frame either.
    const auto collect_in = [&](Pairs& some) {
      return [&](std::span<const Pair> pairs) {
        some.insert(some.end(), pairs.begin(), pairs.end());
        if (events == expected) hand_on(events, begun, ended);
      };
    };
    const std::optional<Statistics> statistics =
        tracker.update({frame.boxes, changed_, frame.filters, frame.ignored, toggled},
                       collect_in(events.begun), collect_in(events.ended));
    log_.add();
    fault_ = debug::fault_of(events, expected);
    if (fault_) {
      faulty_ = std::move(now);
      diverge();
    }
    pairs_ = std::move(now);
    is_whole_ = true;
    return statistics;
  }

  Tracker<D, Real> tracker;

 private:
  /// Lists the frame's listed changes and the boxes that it need not list, each once.
  void list_changed(const Frame<D, Real>& last, const Frame<D, Real>& frame) {
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

  /// Throws the divergence. If memory runs out while it is described, throws std::bad_alloc, and tries again
  /// next time.
  [[noreturn]] void diverge() {
    if (!divergence_) divergence_ = std::make_exception_ptr(explained());
    std::rethrow_exception(divergence_);
  }

  DivergenceOf<D, Real> explained() const {
    const Pair pair = fault_->pair;
    const std::size_t number = log_.count() - 1;
    const History<D, Real> kept = log_.history();
    Replay<D, Real> replay(kept);
    for (const Step<D, Real>& step : kept.steps) replay.next(step);
    const Frame<D, Real> frame = replay.frame();
    std::string text = name_ + " " + debug::text_of(*fault_) + " in frame " + std::to_string(number);
    for (const BoxId id : {pair.first, pair.second}) {
      const bool is_there = index(id) < frame.boxes.size() && !is_absent(frame.boxes[index(id)]);
      text += "; box " + std::to_string(index(id)) +
              (is_there ? " has " + core::text_of(frame.boxes[index(id)]) : " is absent");
    }
    const bool holds = std::binary_search(faulty_.begin(), faulty_.end(), pair);
    text += std::string("; expected, by the definition: the pair ") + (holds ? "holds" : "does not hold") +
            ", and before this frame it " +
            (std::binary_search(pairs_.begin(), pairs_.end(), pair) ? "held" : "did not");

    std::optional<History<D, Real>> small;
    if (make_) small = debug::smallest_fault<D, Real>(kept, make_, options_.tests);
    const bool reproduced = small.has_value();
    if (reproduced) {
      text += "\nthe smallest history found whose last frame shows the fault:\n";
    } else {
      text += make_ ? "\na new tracker does not fail in the last " + std::to_string(kept.steps.size() + 1) +
                          " frames"
                    : "\nthere is no other tracker to replay histories on";
      text += "; in the recorded frames, these two boxes:\n";
      const std::array<std::size_t, 2> places = {index(pair.first), index(pair.second)};
      small = only<D, Real>(places, kept);
    }
    text += text_of(*small);
    return {Divergence(text, pair, number, holds), std::move(*small), reproduced};
  }

  std::string name_;
  Make make_;
  ShadowOptions options_;
  debug::FrameLog<D, Real> log_;
  Pairs pairs_;                      // that hold since the last update, by the definition; sorted
  std::vector<Box<D, Real>> boxes_;  // of the frame, as the tracker sees them
  std::vector<BoxId> changed_;       // likewise
  bool is_whole_ = false;            // whether the last update ended
  std::optional<WrongEvent> fault_;  // in the last frame of the log
  Pairs faulty_;                     // the pairs of that frame
  std::exception_ptr divergence_;    // describes the fault
};

template <int D, typename Real>
ShadowTracker<D, Real>::ShadowTracker(const Spec& spec, const ShadowOptions& options)
    : state_(std::make_unique<State>(
          Tracker<D, Real>(spec), spec.text(), [spec] { return Tracker<D, Real>(spec); }, options)) {}

template <int D, typename Real>
ShadowTracker<D, Real>::ShadowTracker(Make make, const ShadowOptions& options)
    : state_(std::make_unique<State>(make(), "the tracker", make, options)) {}

template <int D, typename Real>
ShadowTracker<D, Real>::ShadowTracker(Tracker<D, Real> tracker, const ShadowOptions& options)
    : state_(std::make_unique<State>(std::move(tracker), "the tracker", Make(), options)) {}

template <int D, typename Real>
ShadowTracker<D, Real>::ShadowTracker(ShadowTracker&& other) noexcept = default;
template <int D, typename Real>
ShadowTracker<D, Real>& ShadowTracker<D, Real>::operator=(ShadowTracker&& other) noexcept = default;
template <int D, typename Real>
ShadowTracker<D, Real>::~ShadowTracker() = default;

template <int D, typename Real>
std::optional<Statistics> ShadowTracker<D, Real>::update(const Frame<D, Real>& frame, PairSink& begun,
                                                         PairSink& ended) {
  std::optional<Statistics> statistics;
  {
    const core::DefaultEnvironment environment;
    statistics = state_->update(frame, begun, ended);
  }
  // Without events, the sinks may still hold pairs that the caller added.
  begun.flush();
  ended.flush();
  return statistics;
}

template <int D, typename Real>
const Tracker<D, Real>& ShadowTracker<D, Real>::tracker() const noexcept {
  return state_->tracker;
}

template <int D, typename Real>
Tracker<D, Real>& ShadowTracker<D, Real>::tracker() noexcept {
  return state_->tracker;
}

template class ShadowTracker<2, float>;
template class ShadowTracker<2, double>;
template class ShadowTracker<3, float>;
template class ShadowTracker<3, double>;

}  // namespace broadside
