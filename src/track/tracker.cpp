// Tracker.
#include "broadside/tracker.hpp"

#include <algorithm>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "broadside/algorithm.hpp"
#include "broadside/error.hpp"
#include "broadside/sinks.hpp"

#include "algorithms/registry.hpp"
#include "core/float_environment.hpp"
#include "core/input_check.hpp"
#include "core/lean.hpp"
#include "core/sort_pairs.hpp"
#include "core/tunables.hpp"
#include "find/checked_searcher.hpp"
#include "track/tracker_state.hpp"

namespace broadside {
namespace {

/// Changes whose boxes are copied in the time that a search takes for a box.
constexpr std::size_t changes_per_box = 8;

/// Whether it has the tunable `update` as the library's algorithms have it: others have one of their own.
bool chooses_update(const Algorithm& algorithm) {
  return std::ranges::any_of(algorithm.tunables, [](const Tunable& tunable) {
    return tunable.name == "update" && std::ranges::find(tunable.choices, "follow") != tunable.choices.end();
  });
}

/// The ways that an algorithm offers, by its settings.
template <int D, typename Real>
track::TrackerPlan<D> plan_of(const Algorithm& algorithm, const Settings& settings) {
  const bool is_float = std::is_same_v<Real, float>;
  const bool chooses = chooses_update(algorithm);
  track::TrackerPlan<D> plan;
  plan.tests_doubles = algorithm.tests_doubles;
  plan.find_costs = algorithm.in<D>().find_costs;
  if (is_float || algorithm.gives_candidates) {
    for (const FollowerChoice<D>& choice : algorithm.in<D>().followers) {
      plan.structures.push_back({choice.name,
                                 [make = choice.make, settings] { return make(settings); },
                                 {choice.costs, choice.max_boxes}});
    }
  }
  if (plan.structures.empty())
    plan.update = Update::rebuild;
  else
    plan.update = chooses ? core::update_of(settings) : Update::follow;
  plan.explains = chooses && !plan.structures.empty();
  // Also where it is not used: it says whether the algorithm does the dimension.
  std::unique_ptr<Searcher<D>> searcher = find::searcher_of<D>(algorithm, settings);
  if (plan.update != Update::follow) plan.searcher = std::move(searcher);
  return plan;
}

}  // namespace

template <int D, typename Real>
void Tracker<D, Real>::State::check(const Frame<D, Real>& frame) const {
  core::check_frame(frame, frames_.size(), is_dirty_, bad_input);
}

template <int D, typename Real>
std::optional<Statistics> Tracker<D, Real>::State::update(const Frame<D, Real>& frame, bool lists_once,
                                                          PairSink& begun, PairSink& ended) {
  const bool rebuild = std::exchange(is_dirty_, true);  // until the end of this update
  parallel_.start(workers, frame.changed.size() / changes_per_box);
  frames_.take(frame, rebuild, lists_once, parallel_);
  ignored_.take(frame, rebuild);
  find_events(frames_.change(rebuild, workers));
  deliver(begun, ended);
  frames_.keep(frame, parallel_);
  is_dirty_ = false;
  return statistics_;
}

/// Sets begun_ and ended_.
template <int D, typename Real>
void Tracker<D, Real>::State::find_events(const Change<D, Real>& change) {
  begun_.clear();
  ended_.clear();
  {
    PairCollector begun_pairs(begun_);
    PairCollector ended_pairs(ended_);
    statistics_ = updater_.update(change, begun_pairs, ended_pairs);
    begun_pairs.flush();
    ended_pairs.flush();
  }
  ignored_.apply(change, begun_, ended_);
  core::sort_unique(begun_, sorting_);
  core::sort_unique(ended_, sorting_);
}

/// All memory is taken before the events are delivered, so that nothing can fail after them.
template <int D, typename Real>
void Tracker<D, Real>::State::deliver(PairSink& begun, PairSink& ended) {
  try {
    ignored_.insert();
    frames_.prepare_to_keep();
    const core::CallersEnvironment callers;
    begun.put(begun_);
    ended.put(ended_);
  } catch (...) {
    ignored_.undo_insert();
    begun.discard();
    ended.discard();
    throw;
  }
  ignored_.keep();
}

template <int D, typename Real>
Frame<D, Real> Tracker<D, Real>::State::last_frame() const noexcept {
  return {frames_.last_boxes(), {}, frames_.last_filters(), ignored_.last(), {}};
}

template <int D, typename Real>
std::size_t Tracker<D, Real>::State::bytes() const noexcept {
  return frames_.bytes() + ignored_.bytes() + updater_.bytes() +
         (begun_.capacity() + ended_.capacity() + sorting_.capacity()) * sizeof(Pair);
}

template <int D, typename Real>
Tracker<D, Real>::Tracker(const Algorithm& algorithm, const Spec& spec) {
  const Settings settings = algorithm::settings_of(algorithm, spec);
  state_ = std::make_unique<State>(plan_of<D, Real>(algorithm, settings),
                                   algorithm::threads_of(algorithm, settings));
}

template <int D, typename Real>
Tracker<D, Real>::Tracker(const Spec& spec) : Tracker(algorithm::require_algorithm(spec.name), spec) {}

template <int D, typename Real>
Tracker<D, Real>::Tracker(std::unique_ptr<Searcher<D>> searcher) {
  if (!searcher) throw std::invalid_argument("Tracker was given a null searcher; expected a searcher");
  track::TrackerPlan<D> plan;
  plan.update = Update::rebuild;
  plan.searcher = find::checked<D>(std::move(searcher));
  plan.explains = false;
  state_ = std::make_unique<State>(std::move(plan), 1);
}

template <int D, typename Real>
Tracker<D, Real>::Tracker(std::unique_ptr<Follower<D>> follower) requires std::is_same_v<Real, float> {
  if (!follower) throw std::invalid_argument("Tracker was given a null follower; expected a follower");
  track::TrackerPlan<D> plan;
  plan.update = Update::follow;
  plan.structures.push_back({});
  plan.follower = std::move(follower);
  plan.explains = false;
  state_ = std::make_unique<State>(std::move(plan), 1);
}

template <int D, typename Real>
Tracker<D, Real>::Tracker(Tracker&& other) noexcept = default;
template <int D, typename Real>
Tracker<D, Real>& Tracker<D, Real>::operator=(Tracker&& other) noexcept = default;
template <int D, typename Real>
Tracker<D, Real>::~Tracker() = default;

template <int D, typename Real>
std::optional<Statistics> Tracker<D, Real>::update(const Frame<D, Real>& frame, PairSink& begun,
                                                   PairSink& ended) {
  const core::DefaultEnvironment environment;
  state_->check(frame);
  return state_->update(frame, false, begun, ended);
}

template <int D, typename Real>
std::optional<Statistics> Tracker<D, Real>::update_checked(const Frame<D, Real>& frame, PairSink& begun,
                                                           PairSink& ended) {
  const core::DefaultEnvironment environment;
  return state_->update(frame, true, begun, ended);
}

template <int D, typename Real>
BadInput Tracker<D, Real>::bad_input() const noexcept {
  return state_->bad_input;
}

template <int D, typename Real>
void Tracker<D, Real>::set_bad_input(BadInput bad_input) noexcept {
  state_->bad_input = bad_input;
}

template <int D, typename Real>
std::span<const BoxId> Tracker<D, Real>::quarantined() const noexcept {
  return state_->quarantined();
}

template <int D, typename Real>
Frame<D, Real> Tracker<D, Real>::last_frame() const noexcept {
  return state_->last_frame();
}

template <int D, typename Real>
const BoxIndex<D, Real>* Tracker<D, Real>::box_index() const noexcept {
  return state_->box_index();
}

template <int D, typename Real>
std::string Tracker<D, Real>::explanation() const {
  return state_->explanation();
}

template <int D, typename Real>
std::size_t Tracker<D, Real>::bytes() const noexcept {
  return core::is_lean ? 0 : state_->bytes();
}

template <int D, typename Real>
const Workers& Tracker<D, Real>::workers() const noexcept {
  return state_->workers;
}

template <int D, typename Real>
void Tracker<D, Real>::set_workers(const Workers& workers) {
  if constexpr (!core::is_lean) state_->workers = workers;
}

template class Tracker<2, float>;
template class Tracker<2, double>;
template class Tracker<3, float>;
template class Tracker<3, double>;

}  // namespace broadside
