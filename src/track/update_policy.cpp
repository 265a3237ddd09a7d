// FollowPolicy and EnlargePolicy: which of four ways a tracker takes in a frame.
#include "track/update_policy.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>

namespace broadside::track {
namespace {

// The costs of tests beyond these were measured with 50,000 boxes, one in a hundred moving, in stacks of
// plates, lines and clusters: docs/lab-notes.md.
constexpr double usual_tests = 64;
constexpr double usual_references = 4;

/// The cost of a candidate that double boxes must decide in any structure; and of one that a structure tests
/// again in both frames, beyond the usual number per mover.
constexpr double cost_of_shared_candidate = 15;
constexpr double cost_of_candidate = 5;
constexpr double usual_candidates = 64;

/// With each measurement, every structure's known cost moves by this fraction towards its expected value,
/// since the boxes may have changed.
constexpr double forgotten = 0.01;

/// Following may take this many times as long as finding all pairs anew before a frame takes another way.
/// Above 1, so that a structure whose movers cost about as much as finding is not given up by chance.
constexpr double max_over_finding = 2;

/// Fewer movers say little about the cost of one.
constexpr std::size_t telling_movers = 64;

/// Up to this number of changed boxes, a structure goes on following whatever the costs.
constexpr std::size_t few_movers = 8;

// Thresholds of enlarged boxes: docs/lab-notes.md, "Enlarged boxes within trackers", has the measurements.

/// With fewer boxes, finding all pairs anew takes no longer than keeping candidates.
constexpr std::size_t min_enlarged = 512;

/// Boxes are enlarged only if at least one in this number changes.
constexpr std::size_t many_movers = 8;

/// They stay enlarged while at least one in this number changes. Hysteresis: a lower limit than for the
/// start, so that a count near it does not flip each frame.
constexpr std::size_t too_few_movers = 16;

/// The number of candidates that can be tested in the time that a mover takes without its tests, and in the
/// time of each of its tests. Boxes are no longer enlarged after this number of frames in a row in which
/// following would cost less.
constexpr double candidates_per_mover = 96;
constexpr double candidates_per_test = 1.5;
constexpr std::size_t max_calm_frames = 8;

/// In the time of one candidate's test, the structure that compares all compares a mover with this number of
/// boxes. The value leaves some room before boxes are no longer enlarged.
constexpr double compared_per_candidate = 4;

/// The fraction of changed boxes that may leave their enlarged boxes, and the number of frames over which it
/// is averaged: boxes that move alike leave in the same frame.
constexpr double max_left = 0.1;
constexpr double averaged_frames = 16;
constexpr std::size_t min_pause = 16;
constexpr std::size_t max_pause = 1024;
constexpr std::size_t max_pause_after_limit = 16 * max_pause;

}  // namespace

FollowPolicy::FollowPolicy(Update update, const FindCosts& finding,
                           const std::vector<StructureCosts>& structures, bool shares_candidates)
    : update_(update), finding_(finding), of_box_(finding.box), shared_candidates_{shares_candidates} {
  for (const StructureCosts& structure : structures)
    structures_.push_back({structure, structure.costs.mover});
  // The structure that compares all is only for few boxes or many tests.
  const auto usual =
      std::find_if_not(structures_.begin(), structures_.end(), std::mem_fn(&StructureCosts::compares_all));
  if (usual != structures_.end()) current_ = static_cast<std::size_t>(usual - structures_.begin());
}

bool FollowPolicy::follows(std::size_t boxes, std::size_t changed, bool rebuild) {
  take_count(boxes);
  if (structures_.empty()) return false;
  const auto movers = static_cast<double>(changed);
  const std::size_t best = cheapest();
  const double finding = cost_of_finding();
  break_even_ =
      std::max(few_movers, static_cast<std::size_t>(finding / cost_of_mover(follows_ ? current_ : best)));
  if (update_ != Update::automatic) return update_ == Update::follow;
  // In the first frame all boxes are new, and after a failed one nothing is known.
  if (rebuild) return false;
  const bool is_best = follows_ && best == current_;
  if (changed <= few_movers && is_best) return true;
  if (is_best) return finding > movers * cost_of_mover(current_);
  const double now = follows_ ? std::min(finding, movers * cost_of_mover(current_)) : finding;
  const double saving = now - movers * cost_of_mover(best);
  const bool goes_on = follows_ && now < finding;
  if (saving <= 0) return goes_on;
  // Starting to follow has a cost as well. It starts once the savings missed so far would have paid for that,
  // which may be at once. So little is lost if few and many boxes move in alternation.
  change_.saved += saving;
  const double patience = best == current_ ? 1 : change_.patience;
  if (change_.saved < patience * static_cast<double>(boxes) * structures_[best].costs.start) return goes_on;
  change_.saved = 0;
  if (best != current_) use(best);
  return true;
}

/// Hysteresis: "few" boxes may become a quarter more before another structure takes over.
void FollowPolicy::take_count(std::size_t boxes) {
  boxes_ = boxes;
  const bool were_few = std::exchange(are_few_, false);
  if (update_ != Update::automatic || structures_.size() < 2) return;
  for (std::size_t i = 0; i < structures_.size(); ++i) {
    const std::size_t max = structures_[i].max_boxes;
    if (max == 0 || boxes > (were_few ? max + max / 4 : max)) continue;
    are_few_ = true;
    if (current_ == i) continue;
    use(i);
    settle();
  }
  if (were_few && !are_few_) lost();
}

double FollowPolicy::cost_of_mover(std::size_t structure) const {
  const KnownStructure& known = structures_[structure];
  const double alone = known.compares_all()
                           ? known.costs.mover_alone + known.costs.further_test * static_cast<double>(boxes_)
                           : known.of_mover;
  return alone + shared_candidates_.of_mover;
}

void FollowPolicy::found(std::size_t boxes, std::size_t pairs, const std::optional<Statistics>& statistics) {
  follows_ = false;
  const auto per_box = [&](auto count) {
    return static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(1, boxes));
  };
  of_box_ = finding_.box + finding_.pair * per_box(pairs);
  if (!statistics) return;
  const double tests = per_box(statistics->tests) - 2 * per_box(pairs);
  of_box_ += finding_.further_test * std::max(0.0, tests - usual_tests) +
             finding_.further_reference * std::max(0.0, per_box(statistics->references) - usual_references);
}

void FollowPolicy::followed(std::size_t changed, const std::optional<Statistics>& statistics) {
  follows_ = true;
  if (cheapest() == current_) change_.saved = 0;
  if (!statistics) return;
  seen_.movers += changed;
  seen_.tests += statistics->tests;
  seen_.candidates += statistics->hits;
  if (seen_.movers < telling_movers) return;
  for (KnownStructure& known : structures_)
    known.of_mover += forgotten * (known.costs.mover - known.of_mover);
  const WorkSinceMeasured seen = std::exchange(seen_, {});
  const auto movers = static_cast<double>(seen.movers);
  const double tests = static_cast<double>(seen.tests) / movers;
  const double candidates = static_cast<double>(seen.candidates) / movers;
  const FollowCosts& costs = structures_[current_].costs;
  double& of_mover = structures_[current_].of_mover;
  of_mover = costs.mover_alone + costs.test * std::min(tests, usual_tests) +
             costs.further_test * std::max(0.0, tests - usual_tests);
  if (shared_candidates_.exist)
    shared_candidates_.of_mover = cost_of_shared_candidate * candidates;
  else
    of_mover += cost_of_candidate * std::max(0.0, candidates - usual_candidates);
}

std::uint64_t FollowPolicy::max_tests() const {
  constexpr auto unlimited = std::numeric_limits<std::uint64_t>::max();
  const KnownStructure& known = structures_[current_];
  if (update_ != Update::automatic || known.compares_all() || !(known.costs.further_test > 0))
    return unlimited;
  const double tests = max_over_finding * cost_of_finding() / known.costs.further_test;
  return tests < static_cast<double>(unlimited) / 2 ? static_cast<std::uint64_t>(tests) : unlimited;
}

/// What the tests have cost is lost. Among the structures whose movers cost less than finding all pairs anew,
/// the cheapest one counts, its start included.
bool FollowPolicy::passed_max_tests(std::size_t changed, bool may_follow) {
  lost();
  seen_ = {};
  const auto movers = static_cast<double>(changed);
  structures_[current_].of_mover =
      std::max(structures_[current_].of_mover, max_over_finding * cost_of_finding() / movers);
  const auto cost_with_start = [&](std::size_t i) {
    return movers * cost_of_mover(i) + static_cast<double>(boxes_) * structures_[i].costs.start;
  };
  std::size_t best = current_;
  for (std::size_t i = 0; may_follow && i < structures_.size(); ++i) {
    if (structures_[i].compares_all() || movers * cost_of_mover(i) >= cost_of_finding()) continue;
    if (best == current_ || cost_with_start(i) < cost_with_start(best)) best = i;
  }
  if (best == current_) return false;
  use(best);
  return true;
}

void FollowPolicy::lost() noexcept {
  follows_ = false;
  change_.saved = 0;
}

std::size_t FollowPolicy::cheapest() const {
  if (are_few_) return current_;
  std::size_t best = 0;
  for (std::size_t i = 1; i < structures_.size(); ++i) {
    if (cost_of_mover(i) < cost_of_mover(best)) best = i;
  }
  return best;
}

void FollowPolicy::use(std::size_t structure) {
  follows_ = false;
  current_ = structure;
  change_.patience *= 2;
  seen_ = {};
}

bool EnlargePolicy::are_many(std::size_t boxes, std::size_t changed) noexcept {
  return boxes >= min_enlarged && changed >= boxes / many_movers;
}

bool EnlargePolicy::tries(std::size_t boxes, std::size_t changed) {
  if (!are_many(boxes, changed)) return false;
  if (pause_ == 0) return true;
  --pause_;
  return false;
}

void EnlargePolicy::started() noexcept {
  left_share_ = 0;
  calm_frames_ = 0;
  lasted_ = 0;
}

bool EnlargePolicy::goes_on(const EnlargedFrame& frame) {
  ++lasted_;
  const auto boxes = static_cast<double>(frame.boxes);
  const auto changed = static_cast<double>(frame.changed);
  const auto candidates = static_cast<double>(frame.candidates);
  // A mover is the first box of some candidates and the second of others, hence the 2.
  double following = changed * (candidates_per_mover + candidates_per_test * 2 * candidates / boxes);
  if (may_compare_all_) following = std::min(following, changed * boxes / compared_per_candidate);
  const bool is_calm = following < candidates || frame.changed < frame.boxes / too_few_movers;
  calm_frames_ = is_calm ? calm_frames_ + 1 : 0;
  left_share_ += (static_cast<double>(frame.left) / changed - left_share_) / averaged_frames;
  if (left_share_ <= max_left && calm_frames_ < max_calm_frames) return true;
  give_up(lasted_ > next_pause_ ? min_pause : std::min(2 * next_pause_, max_pause));
  return false;
}

/// A try that ends at a limit costs about as much as one that succeeds. The pause makes that less than a
/// hundredth of the cost of the frames until the next try. It doubles with each failure in a row, because the
/// same boxes will most likely exceed the limit again.
void EnlargePolicy::limit_passed() noexcept {
  give_up(std::clamp(2 * next_pause_, max_pause, max_pause_after_limit));
}

void EnlargePolicy::out_of_memory() noexcept { give_up(max_pause); }

void EnlargePolicy::interrupted() noexcept { give_up(min_pause); }

}  // namespace broadside::track
