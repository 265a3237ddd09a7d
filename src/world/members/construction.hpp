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
#include "core/former_names.hpp"
#include "core/lean.hpp"
#include "core/message.hpp"
#include "core/number_text.hpp"
#include "world/state.hpp"

namespace broadside {
namespace {

/// One of the distances that boxes are enlarged by, as a number of the world's type.
template <typename Real>
Real checked_distance(const char* name, const double& number) {
  const core::DefaultEnvironment environment;
  const volatile Real rounded = static_cast<Real>(number);
  if (!(rounded >= 0) || !std::isfinite(rounded)) {
    throw std::invalid_argument(core::message({"the ", name, " of a world is ", core::text_of(number),
                                               "; expected a finite number of at least 0"}));
  }
  return rounded;
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
      margins{.margin = checked_distance<Real>("margin", its_options.margin),
              .relative = checked_distance<Real>("relative margin", its_options.relative_margin),
              .frames = checked_distance<Real>("number of predicted frames", its_options.predicted_frames),
              .has_margin = its_options.margin > 0,
              .has_relative = its_options.relative_margin > 0},
      is_own_tracker(is_own),
      tracker(core::is_lean || is_own || !its_tracker || !its_options.shadow
                  ? std::move(its_tracker)
                  : std::make_unique<ShadowTracker<D, Real>>(std::move(its_tracker))),
      first_generation(its_options.first_generation),
      is_refining(refines_by_boxes()) {
  if constexpr (!core::is_lean) {
    // Worlds with equivalent options write the same bytes into snapshots, also after a restore().
    if (is_own)
      options.algorithm = core::canonical_spec(options.algorithm);
    else
      options.algorithm = default_algorithm;
  }
  if (!tracker) throw std::invalid_argument("World was given a null tracker; expected a tracker");
  if (options.events == WorldEvents::enlarged && !has_margin()) {
    throw std::invalid_argument(
        "a world is to tell of enlarged boxes and enlarges none; expected a margin, a relative margin or a "
        "number of predicted frames above 0");
  }
}

template <int D, typename Real>
std::unique_ptr<PairTracker<D, Real>> World<D, Real>::State::make_own_tracker(const WorldOptions& options) {
  if (!core::is_lean && options.shadow) return std::make_unique<ShadowTracker<D, Real>>(options.algorithm);
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
