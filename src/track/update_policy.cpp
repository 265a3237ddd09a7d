// FollowPolicy: whether a frame's changes are followed in a structure that stays, or all pairs found anew.
#include "interface/follow_policy.hpp"

#include <algorithm>
#include <utility>

#include "core/lean.hpp"

namespace broadside::core {
namespace {

// The costs of tests beyond these were measured with 50,000 boxes, one in a hundred moving, in stacks of
// plates, lines and clusters: docs/lab-notes.md.
constexpr double usual_tests = 64;
constexpr double usual_references = 4;
constexpr double cost_of_a_candidate = 15;  // a pair that boxes of doubles have to decide, in any structure

/// The part of the way back to its expected value that a structure's cost takes each time another one is
/// weighed: the boxes may have changed.
constexpr double forgotten = 0.01;

/// Fewer movers say little about what one costs.
constexpr std::size_t telling_movers = 64;

/// Up to this number of changed boxes, a structure that follows goes on without a look at costs.
constexpr std::size_t few_movers = 8;

}  // namespace

Tunable update_tunable() {
  return {.name = "update",
          .summary = unless_lean(
              "for tracking only: follow the boxes that changed, or find all pairs anew in each frame"),
          .standard = "auto",
          .type = Tunable::Type::choice,
          .choices = {"follow", "rebuild"}};
}

Update update_of(const Settings& settings) {
  if (settings.is_auto("update")) return Update::automatic;
  return settings.text("update") == "follow" ? Update::follow : Update::rebuild;
}

FollowPolicy::FollowPolicy(Update update, const FindCosts& finding, std::vector<FollowCosts> following)
    : update_(update), finding_(finding), following_(std::move(following)), of_box_(finding.box) {
  for (const FollowCosts& costs : following_) of_mover_.push_back(costs.mover);
}

bool FollowPolicy::follows(std::size_t boxes, std::size_t changed, bool rebuild) {
  const auto movers = static_cast<double>(changed);
  const std::size_t best = cheapest();
  const double finding = static_cast<double>(boxes) * of_box_;
  const auto following = [&](std::size_t structure) { return of_mover_[structure] + candidates_of_mover_; };
  break_even_ =
      std::max(few_movers, static_cast<std::size_t>(finding / following(follows_ ? current_ : best)));
  if (update_ != Update::automatic) return update_ == Update::follow;
  // In the first frame all boxes are new, and after a failed one nothing is known.
  if (rebuild) return false;
  const bool is_best = follows_ && best == current_;
  if (changed <= few_movers && is_best) return true;
  if (is_best) return finding > movers * following(current_);
  const double now = follows_ ? std::min(finding, movers * following(current_)) : finding;
  const double saving = now - movers * following(best);
  const bool goes_on = follows_ && now < finding;
  if (saving <= 0) return goes_on;
  // Starting to follow has a cost as well. It is done at once where the frame costs no more for it, else as
  // soon as it would have paid: so little is lost where few and many boxes move in alternation.
  saved_ += saving;
  const double patience = best == current_ ? 1 : patience_;
  if (saved_ < patience * static_cast<double>(boxes) * following_[best].start) return goes_on;
  saved_ = 0;
  if (best != current_) use(best);
  return true;
}

void FollowPolicy::found(std::size_t boxes, std::size_t pairs, const std::optional<Statistics>& statistics) {
  follows_ = false;
  const auto a_box = [&](auto count) {
    return static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(1, boxes));
  };
  of_box_ = finding_.box + finding_.pair * a_box(pairs);
  if (!statistics) return;
  const double tests = a_box(statistics->tests) - 2 * a_box(pairs);
  of_box_ += finding_.further_test * std::max(0.0, tests - usual_tests) +
             finding_.further_reference * std::max(0.0, a_box(statistics->references) - usual_references);
}

void FollowPolicy::followed(std::size_t changed, const std::optional<Statistics>& statistics) {
  follows_ = true;
  if (cheapest() == current_) saved_ = 0;
  if (!statistics) return;
  seen_movers_ += changed;
  seen_tests_ += static_cast<double>(statistics->tests);
  seen_hits_ += static_cast<double>(statistics->hits);
  if (seen_movers_ < telling_movers) return;
  for (std::size_t i = 0; i < following_.size(); ++i)
    of_mover_[i] += forgotten * (following_[i].mover - of_mover_[i]);
  const auto movers = static_cast<double>(std::exchange(seen_movers_, 0));
  const double tests = std::exchange(seen_tests_, 0) / movers;
  const FollowCosts& costs = following_[current_];
  of_mover_[current_] = costs.mover_alone + costs.test * std::min(tests, usual_tests) +
                        costs.further_test * std::max(0.0, tests - usual_tests);
  candidates_of_mover_ = cost_of_a_candidate * std::exchange(seen_hits_, 0) / movers;
}

void FollowPolicy::lost() {
  follows_ = false;
  saved_ = 0;
}

std::size_t FollowPolicy::cheapest() const {
  return static_cast<std::size_t>(std::ranges::min_element(of_mover_) - of_mover_.begin());
}

void FollowPolicy::use(std::size_t structure) {
  follows_ = false;
  current_ = structure;
  patience_ *= 2;
  seen_movers_ = 0;
  seen_tests_ = 0;
  seen_hits_ = 0;
}

}  // namespace broadside::core
