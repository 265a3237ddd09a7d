// ShadowTracker: any tracker with brute force beside it.
#include "broadside/debug/shadow.hpp"

#include <utility>

#include "core/float_environment.hpp"
#include "debug/shadow_check.hpp"

namespace broadside {

template <int D, typename Real>
struct BROADSIDE_HIDDEN ShadowTracker<D, Real>::State {
  State(Tracker<D, Real> its_tracker, std::string name, Make make, const ShadowOptions& options)
      : tracker(std::move(its_tracker)), check(std::move(name), std::move(make), options) {}

  Tracker<D, Real> tracker;
  core::ShadowCheck<D, Real> check;
  bool is_whole = false;          // whether the last update's events were delivered
  std::vector<Pair> delivered{};  // if not: the pairs that hold by those that were
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

/// An update that the tracker would refuse changes nothing; after one that lists too little, all is taken
/// anew. The tracker may have taken a frame that a sink of this one's caller has not: then the next events
/// start from the pairs that were delivered.
template <int D, typename Real>
std::optional<Statistics> ShadowTracker<D, Real>::update(const Frame<D, Real>& frame, PairSink& begun,
                                                         PairSink& ended) {
  State& state = *state_;
  const bool was_whole = state.is_whole;
  core::EventPairs events;
  try {
    const core::DefaultEnvironment environment;
    if (was_whole) state.delivered = state.check.pairs();
    events = state.check.update(state.tracker, frame, !was_whole);
    state.is_whole = false;
    if (!was_whole) events = core::events_between(state.delivered, state.check.pairs());
  } catch (...) {
    state.is_whole = state.is_whole && state.check.is_whole();
    throw;
  }
  try {
    begun.put(events.begun);
    ended.put(events.ended);
  } catch (...) {
    begun.discard();
    ended.discard();
    throw;
  }
  state.is_whole = true;
  return state.check.statistics();
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
