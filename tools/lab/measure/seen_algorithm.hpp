// SeenAlgorithm: an algorithm whose searchers or followers the lab can inspect while a Finder or Tracker uses
// them.
#pragma once

#include <memory>
#include <utility>

#include "broadside/algorithm.hpp"

#include "lab/peers/filtering.hpp"
#include "lab/peers/tear_down.hpp"
#include "paper/listings/phases.hpp"

namespace broadside::lab {

/// Not copyable, because the algorithm's factories write to this object.
class SeenAlgorithm {
 public:
  /// A copy of `algorithm` whose factories record the objects they make: searchers for a Finder, or followers
  /// for a Tracker. Listings record their phases if `records_phases`.
  enum class Sees { searchers, followers };
  SeenAlgorithm(Algorithm algorithm, Sees sees, bool records_phases)
      : algorithm_(std::move(algorithm)), records_phases_(records_phases) {
    watch(algorithm_.in_2d, sees);
    watch(algorithm_.in_3d, sees);
  }
  SeenAlgorithm(const SeenAlgorithm&) = delete;
  SeenAlgorithm& operator=(const SeenAlgorithm&) = delete;

  const Algorithm& algorithm() const noexcept { return algorithm_; }

  /// The structure left by a peer's last search; null if there is none.
  peers::TearDown* structure() const noexcept { return structure_; }

  /// The searcher of a library with its own means to filter; null for others.
  peers::Filtering* filtering() const noexcept { return filtering_; }

  /// The phases of a listing's last search or frame; null if they are not recorded.
  const paper::Phases* phases() const noexcept {
    return phased_ != nullptr && records_phases_ ? &phased_->phases() : nullptr;
  }

 private:
  template <int D>
  void watch(Strategies<D>& strategies, Sees sees) {
    if (sees == Sees::searchers) {
      watch(strategies.searcher);
      return;
    }
    for (FollowerChoice<D>& choice : strategies.followers) watch(choice.make);
  }

  template <typename Make>
  void watch(Make& make) {
    if (!make) return;
    make = [this, original = std::move(make)](const Settings& settings) {
      auto strategy = original(settings);
      structure_ = dynamic_cast<peers::TearDown*>(strategy.get());
      filtering_ = dynamic_cast<peers::Filtering*>(strategy.get());
      phased_ = dynamic_cast<paper::Phased*>(strategy.get());
      if (phased_ != nullptr && records_phases_) phased_->record_phases();
      return strategy;
    };
  }

  Algorithm algorithm_;
  bool records_phases_;
  peers::TearDown* structure_ = nullptr;
  peers::Filtering* filtering_ = nullptr;
  paper::Phased* phased_ = nullptr;
};

}  // namespace broadside::lab
