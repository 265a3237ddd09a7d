// Tracker: takes frames, finds events, delivers them, and keeps its state whole if anything throws.
#include "broadside/tracker.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "broadside/algorithm.hpp"

#include "algorithms/registry.hpp"
#include "core/float_environment.hpp"
#include "core/grow.hpp"
#include "core/input_check.hpp"
#include "core/parallel.hpp"
#include "core/sort_pairs.hpp"
#include "core/tunables.hpp"
#include "find/search.hpp"
#include "track/frame_states.hpp"
#include "track/ignored_change.hpp"
#include "track/updater.hpp"

namespace broadside {
namespace {

/// The number of changed boxes that are copied in the time that a search takes per box.
constexpr std::size_t changes_per_box = 8;

/// Whether it has the library's tunable `update`; other algorithms may have their own of that name.
bool chooses_update(const Algorithm& algorithm) {
  return std::any_of(algorithm.tunables.begin(), algorithm.tunables.end(), [](const Tunable& tunable) {
    return tunable.name == "update" &&
           std::find(tunable.choices.begin(), tunable.choices.end(), "follow") != tunable.choices.end();
  });
}

/// The ways to update pairs that an algorithm offers with these settings.
template <int D, typename Real>
track::TrackerPlan<D> plan_of(const Algorithm& algorithm, const Settings& settings) {
  const bool is_float = std::is_same_v<Real, float>;
  const bool chooses = chooses_update(algorithm);
  track::TrackerPlan<D> plan;
  plan.find_costs = algorithm.in<D>().find_costs;
  if (is_float || algorithm.gives_candidates) {
    const auto& followers = algorithm.in<D>().followers;
    plan.structures.assign(followers.begin(), followers.end());
    plan.settings = settings;
  }
  if (plan.structures.empty())
    plan.update = Update::rebuild;
  else
    plan.update = chooses ? core::update_of(settings) : Update::follow;
  plan.explains = chooses && !plan.structures.empty();
  // Made even if it is not used: this throws if the algorithm does not support the dimension.
  find::Searchers<D> searchers = find::searchers_of<D>(algorithm, settings);
  if (plan.update != Update::follow) plan.searchers = std::move(searchers);
  return plan;
}

}  // namespace

/// What every tracker does around an Updater.
template <int D, typename Real>
class BROADSIDE_HIDDEN Tracker<D, Real>::State {
 public:
  State(track::TrackerPlan<D> plan, std::size_t threads)
      : workers{.threads = threads}, updater(std::move(plan)) {}

  /// Takes a frame. `lists_once`: each changed box is listed once, and is valid or absent. `lists_all`:
  /// core::is_whole() holds.
  std::optional<Statistics> update(const Frame<D, Real>& frame, bool lists_once, bool lists_all,
                                   PairSink& begun_sink, PairSink& ended_sink) {
    const bool rebuild = std::exchange(is_dirty, true);  // until the end of this update
    parallel.start(workers, frame.changed.size() / changes_per_box);
    frames.take(frame, rebuild, lists_once, lists_all, parallel);
    ignored.take(frame.ignored, frame.ignored_changed, rebuild);
    find_events(frames.change(rebuild, workers));
    deliver(begun_sink, ended_sink);
    frames.keep(frame, parallel);
    is_dirty = false;
    return statistics;
  }

  /// Sets `begun` and `ended`.
  void find_events(const Change<D, Real>& change) {
    begun.clear();
    ended.clear();
    {
      PairCollector begun_pairs(begun);
      PairCollector ended_pairs(ended);
      statistics = updater.update(change, begun_pairs, ended_pairs);
      begun_pairs.flush();
      ended_pairs.flush();
    }
    ignored.apply(change, begun, ended);
    core::sort_unique(begun, sorting);
    core::sort_unique(ended, sorting);
  }

  /// Allocates all memory before it delivers events, so that nothing can fail afterwards.
  void deliver(PairSink& begun_sink, PairSink& ended_sink) {
    try {
      ignored.insert();
      frames.prepare_to_keep();
      const core::CallersEnvironment callers;
      begun_sink.put(begun);
      ended_sink.put(ended);
    } catch (...) {
      ignored.undo_insert();
      begun_sink.discard();
      ended_sink.discard();
      throw;
    }
    ignored.keep();
  }

  BadInput bad_input = BadInput::reject;
  Workers workers;
  track::FrameStates<D, Real> frames;
  track::IgnoredChange ignored;
  track::Updater<D, Real> updater;
  std::optional<Statistics> statistics;
  std::vector<Pair> begun;
  std::vector<Pair> ended;
  std::vector<Pair> sorting;
  core::Parallel parallel;
  bool is_dirty = true;  // there was no update yet, or the last one failed
};

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
  plan.searchers.first = find::checked(std::move(searcher));
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
  const bool lists_all = core::is_whole(frame, state_->frames.size());
  core::check_frame(frame, state_->frames.size(), state_->is_dirty, state_->bad_input, lists_all);
  return state_->update(frame, false, lists_all, begun, ended);
}

template <int D, typename Real>
std::optional<Statistics> Tracker<D, Real>::update_checked(const Frame<D, Real>& frame, PairSink& begun,
                                                           PairSink& ended) {
  const core::DefaultEnvironment environment;
  return state_->update(frame, true, core::is_whole(frame, state_->frames.size()), begun, ended);
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
bool Tracker<D, Real>::touching() const noexcept {
  return state_->frames.touching;
}

template <int D, typename Real>
void Tracker<D, Real>::set_touching(bool touching) {
  if (state_->frames.size() != 0)
    throw std::logic_error("touching was set after the first update of a tracker; expected it before");
  state_->frames.touching = touching;
}

template <int D, typename Real>
std::span<const BoxId> Tracker<D, Real>::quarantined() const noexcept {
  return state_->frames.quarantined();
}

template <int D, typename Real>
Frame<D, Real> Tracker<D, Real>::last_frame() const noexcept {
  return {state_->frames.last_boxes(), {}, state_->frames.last_filters(), state_->ignored.last(), {}};
}

template <int D, typename Real>
const BoxIndex<D, Real>* Tracker<D, Real>::box_index() const noexcept {
  return state_->is_dirty ? nullptr : state_->updater.box_index();
}

template <int D, typename Real>
std::string Tracker<D, Real>::explanation() const {
  return state_->updater.explanation();
}

template <int D, typename Real>
std::size_t Tracker<D, Real>::bytes() const noexcept {
  return state_->frames.bytes() + state_->ignored.bytes() + state_->updater.bytes() +
         core::bytes_of(state_->begun, state_->ended, state_->sorting);
}

template <int D, typename Real>
const Workers& Tracker<D, Real>::workers() const noexcept {
  return state_->workers;
}

template <int D, typename Real>
void Tracker<D, Real>::set_workers(const Workers& workers) {
  state_->workers = workers;
}

template class Tracker<2, float>;
template class Tracker<2, double>;
template class Tracker<3, float>;
template class Tracker<3, double>;

}  // namespace broadside
