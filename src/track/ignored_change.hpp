// IgnoredChange: the ignored pairs of the last whole frame, and those that become ignored or no longer are.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "broadside/filter.hpp"
#include "broadside/follower.hpp"
#include "broadside/pair.hpp"

#include "core/grow.hpp"
#include "core/sort_pairs.hpp"

namespace broadside::track {

class IgnoredChange {
 public:
  /// Takes the next frame's set, or null, and the pairs listed as changed. `takes_all`: looks for all
  /// differences, not only those listed.
  void take(const IgnoredPairs* now, std::span<const Pair> listed, bool takes_all) {
    has_set_ = now != nullptr;
    newly_ = 0;
    toggled_.clear();
    const auto take_one = [&](Pair pair) {
      if (pair.second < pair.first) std::swap(pair.first, pair.second);
      const bool is_ignored = now != nullptr && now->contains(pair);
      if (is_ignored != pairs_.contains(pair)) toggled_.push_back(pair);
    };
    if (takes_all || has_set_ != had_set_) {
      pairs_.for_each(take_one);
      if (now != nullptr) now->for_each(take_one);
    } else {
      for (const Pair pair : listed) take_one(pair);
    }
    core::sort_unique(toggled_, sorting_);
  }

  /// Drops the events of ignored pairs, and adds events of pairs that became ignored or no longer are.
  template <int D, typename Real>
  void apply(const Change<D, Real>& change, std::vector<Pair>& begun, std::vector<Pair>& ended) const {
    if (toggled_.empty() && pairs_.empty()) return;
    const auto is_dropped = [this](Pair pair) {
      return pairs_.contains(pair) || std::binary_search(toggled_.begin(), toggled_.end(), pair);
    };
    std::erase_if(begun, is_dropped);
    std::erase_if(ended, is_dropped);
    for (const Pair pair : toggled_) {
      if (index(pair.second) >= change.now.size()) continue;
      if (pairs_.contains(pair)) {
        if (change.holds(pair.first, pair.second)) begun.push_back(pair);
      } else {
        if (change.held(pair.first, pair.second)) ended.push_back(pair);
      }
    }
  }

  /// insert() and keep() make the next frame's set that of the last whole frame. insert() allocates memory
  /// and can be undone; keep() does not and cannot.
  void insert() {
    const auto middle = std::partition(toggled_.begin(), toggled_.end(),
                                       [this](Pair pair) { return !pairs_.contains(pair); });
    newly_ = static_cast<std::size_t>(middle - toggled_.begin());
    for (const Pair pair : std::span(toggled_).first(newly_)) pairs_.insert(pair);
  }

  void undo_insert() noexcept {
    for (const Pair pair : std::span(toggled_).first(newly_)) pairs_.erase(pair);
  }

  void keep() noexcept {
    for (const Pair pair : std::span(toggled_).subspan(newly_)) pairs_.erase(pair);
    had_set_ = has_set_;
  }

  /// The set of the last whole frame, or null if it had none.
  const IgnoredPairs* last() const noexcept { return had_set_ ? &pairs_ : nullptr; }

  std::size_t bytes() const noexcept { return core::bytes_of(toggled_, sorting_) + pairs_.bytes(); }

 private:
  IgnoredPairs pairs_;         // of the last whole frame
  bool had_set_ = false;       // whether that frame had a set
  bool has_set_ = false;       // whether the next frame has one
  std::vector<Pair> toggled_;  // pairs that are ignored in one of the two frames, sorted by take()
  std::size_t newly_ = 0;      // after insert(): the number of newly ignored pairs, first in toggled_
  std::vector<Pair> sorting_;
};

}  // namespace broadside::track
