// World: how one is made, moved and given workers.
#pragma once

#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "broadside/debug/shadow.hpp"
#include "broadside/world.hpp"

#include "core/float_environment.hpp"
#include "world/state.hpp"

namespace broadside {
namespace {

template <typename Real>
Real rounded(const double& number) noexcept {
  const core::DefaultEnvironment environment;
  const volatile Real result = static_cast<Real>(number);
  return result;
}

WorldOptions with_algorithm(std::string_view spec) {
  WorldOptions options;
  options.algorithm = spec;
  return options;
}

}  // namespace

template <int D, typename Real>
World<D, Real>::World(std::string_view spec) : World(with_algorithm(spec)) {}

template <int D, typename Real>
World<D, Real>::World(const WorldOptions& options)
    : state_(std::make_unique<State>(State::make_own_tracker(options), options, true)) {}

template <int D, typename Real>
World<D, Real>::World(std::unique_ptr<PairTracker<D, Real>> tracker, const WorldOptions& options)
    : state_(std::make_unique<State>(std::move(tracker), options, false)) {}

template <int D, typename Real>
World<D, Real>::World(World&& other) noexcept = default;
template <int D, typename Real>
World<D, Real>& World<D, Real>::operator=(World&& other) noexcept = default;
template <int D, typename Real>
World<D, Real>::~World() = default;

template <int D, typename Real>
World<D, Real>::State::State(std::unique_ptr<PairTracker<D, Real>> its_tracker,
                             const WorldOptions& its_options, bool is_own)
    : options(its_options),
      margin(rounded<Real>(its_options.margin)),
      is_own_tracker(is_own),
      tracker(is_own || !its_tracker || !its_options.shadow
                  ? std::move(its_tracker)
                  : std::make_unique<ShadowTracker<D, Real>>(std::move(its_tracker))),
      first_generation(its_options.first_generation),
      is_refining(margin > 0) {
  if (!tracker) throw std::invalid_argument("World was given a null tracker; expected a tracker");
  if (!(margin >= 0) || !std::isfinite(margin)) {
    throw std::invalid_argument("the margin of a world is " + std::to_string(options.margin) +
                                "; expected a finite number of at least 0");
  }
}

template <int D, typename Real>
std::unique_ptr<PairTracker<D, Real>> World<D, Real>::State::make_own_tracker(const WorldOptions& options) {
  if (options.shadow) return std::make_unique<ShadowTracker<D, Real>>(options.algorithm);
  return make_tracker<D, Real>(options.algorithm);
}

template <int D, typename Real>
const Workers& World<D, Real>::workers() const noexcept {
  return state_->tracker->workers();
}

template <int D, typename Real>
void World<D, Real>::set_workers(const Workers& workers) {
  state_->tracker->set_workers(workers);
}

}  // namespace broadside
