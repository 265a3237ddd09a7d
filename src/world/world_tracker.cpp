// WorldTracker: the tracker of a world, which restore() leads to another frame.
#include "world/world_tracker.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "core/former_names.hpp"

namespace broadside::detail {

/// Gives a world Tracker::update_checked(). A public header cannot name a class of broadside::world: a user's
/// global variable `world` would be ambiguous after `using namespace broadside`.
struct CheckedUpdate {
  template <int D, typename Real>
  static std::optional<Statistics> of(Tracker<D, Real>& tracker, const Frame<D, Real>& frame, PairSink& begun,
                                      PairSink& ended) {
    return tracker.update_checked(frame, begun, ended);
  }
};

}  // namespace broadside::detail

namespace broadside::world {

template <int D, typename Real>
WorldTracker<D, Real>::WorldTracker(const WorldOptions& options)
    : is_own_(true), spec_(options.algorithm), tracker_(make(spec_, options.shadow)) {
  spec_ = core::canonical_spec(spec_);
}

template <int D, typename Real>
WorldTracker<D, Real>::WorldTracker(Tracker<D, Real> tracker, const WorldOptions& options)
    : is_own_(false), tracker_(make(std::move(tracker), options.shadow)) {}

template <int D, typename Real>
void WorldTracker<D, Real>::update(const Frame<D, Real>& frame, PairEvents& events) {
  lead_back();
  const std::size_t begun_before = events.begun.size();
  const std::size_t ended_before = events.ended.size();
  try {
    PairCollector begun_pairs(events.begun);
    PairCollector ended_pairs(events.ended);
    if (Plain* const plain = std::get_if<Plain>(&tracker_))
      statistics_ = detail::CheckedUpdate::of(*plain, frame, begun_pairs, ended_pairs);
    else
      take(frame, begun_pairs, ended_pairs);
  } catch (...) {
    // The next update reports these again.
    events.begun.resize(begun_before);
    events.ended.resize(ended_before);
    throw;
  }
  if (begun_before + ended_before > 0) events = events.netted();
}

/// Takes any frame, without the promises of Tracker::update_checked().
template <int D, typename Real>
void WorldTracker<D, Real>::take(const Frame<D, Real>& frame, PairSink& begun, PairSink& ended) {
  statistics_ = std::visit([&](auto& tracker) { return tracker.update(frame, begun, ended); }, tracker_);
}

template <int D, typename Real>
Frame<D, Real> WorldTracker<D, Real>::last_frame() const noexcept {
  return way_back_ ? way_back_->frame() : tracker().last_frame();
}

template <int D, typename Real>
void WorldTracker<D, Real>::renew(const Frame<D, Real>& frame) {
  if (!is_own_) return;
  WorldTracker fresh = remade(spec_);
  PairCounter known;
  fresh.take(frame, known, known);
  *this = std::move(fresh);
}

template <int D, typename Real>
WorldTracker<D, Real> WorldTracker<D, Real>::remade(const Spec& spec) const {
  WorldOptions options;
  options.algorithm = spec;
  options.shadow = std::get_if<Plain>(&tracker_) == nullptr;
  WorldTracker other(options);
  other.set_workers(workers());
  return other;
}

template <int D, typename Real>
void WorldTracker<D, Real>::lead_to(const Taken& frame, std::optional<std::vector<Pair>> known,
                                    const std::function<void(const std::vector<Pair>&)>& check) {
  lead_back();
  way_back_ = std::make_unique<Taken>(tracker().last_frame());
  try {
    if (!known) {
      lead(Taken{});
      known.emplace();
    }
    check(symmetric_difference(*known, lead(frame)));
  } catch (...) {
    try {
      lead_back();
    } catch (...) {
      // The next update tries again.
    }
    throw;
  }
  way_back_.reset();
}

/// Leads the tracker back if lead_to() left it elsewhere, or throws and leaves it there.
template <int D, typename Real>
void WorldTracker<D, Real>::lead_back() {
  if (!way_back_) return;
  lead(*way_back_);
  way_back_.reset();
}

/// Gives the tracker a frame that lists only the differences from its last one. Returns the events: the
/// pairs that hold in exactly one of the two, sorted.
template <int D, typename Real>
std::vector<Pair> WorldTracker<D, Real>::lead(const Taken& to) {
  const Frame<D, Real> from = tracker().last_frame();
  Frame<D, Real> frame = to.frame();
  std::vector<BoxId> places;
  for (std::uint32_t i = 0; i < std::min(from.boxes.size(), frame.boxes.size()); ++i) {
    // After an update that failed there may be fewer filters than boxes; then all are taken anew.
    const bool filters_differ =
        i < from.filters.size() && i < frame.filters.size() && from.filters[i] != frame.filters[i];
    if (from.boxes[i] != frame.boxes[i] || filters_differ) places.push_back(BoxId{i});
  }
  frame.changed = places;
  std::vector<Pair> toggled;
  const auto add_missing = [&toggled](const IgnoredPairs* set, const IgnoredPairs* other) {
    if (set == nullptr || other == nullptr) return;
    set->for_each([&](Pair pair) {
      if (!other->contains(pair)) toggled.push_back(pair);
    });
  };
  add_missing(from.ignored, frame.ignored);
  add_missing(frame.ignored, from.ignored);
  frame.ignored_changed = toggled;
  PairEvents events;
  PairCollector begun_sink(events.begun);
  PairCollector ended_sink(events.ended);
  take(frame, begun_sink, ended_sink);
  return symmetric_difference(events.begun, events.ended);
}

template class WorldTracker<2, float>;
template class WorldTracker<2, double>;
template class WorldTracker<3, float>;
template class WorldTracker<3, double>;

}  // namespace broadside::world
