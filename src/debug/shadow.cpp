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
    statistics = state_->check.update(state_->tracker, frame, begun, ended);
  }
  // Where there were no events, they may hold what their owner has put there.
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
