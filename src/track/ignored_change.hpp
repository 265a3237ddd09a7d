// IgnoredChange: the ignored pairs of the last whole frame, and those that become ignored or no longer are.
#pragma once

#include <cstddef>
#include <vector>

#include "broadside/filter.hpp"
#include "broadside/follower.hpp"
#include "broadside/tracker.hpp"

namespace broadside::track {

class IgnoredChange {
 public:
  /// Takes the set of the next frame. `takes_all`: every difference is looked for, not only what is listed.
  template <int D, typename Real>
  void take(const Frame<D, Real>& frame, bool takes_all) {
    take(frame.ignored, frame.ignored_changed, takes_all);
  }

  /// Drops the events of ignored pairs, and adds events of pairs that became ignored or no longer are.
  template <int D, typename Real>
  void apply(const Change<D, Real>& change, std::vector<Pair>& begun, std::vector<Pair>& ended) const;

  /// Makes the set of the next frame that of the last whole one, in two steps: the first takes memory and can
  /// be undone, the second does neither.
  void insert();
  void undo_insert() noexcept;
  void keep() noexcept;

  /// The set of the last whole frame, or null if it had none.
  const IgnoredPairs* last() const noexcept { return had_set_ ? &pairs_ : nullptr; }

  std::size_t bytes() const noexcept {
    return (toggled_.capacity() + sorting_.capacity()) * sizeof(Pair) + pairs_.bytes();
  }

 private:
  void take(const IgnoredPairs* now, std::span<const Pair> listed, bool takes_all);

  IgnoredPairs pairs_;         // those of the last whole frame
  bool had_set_ = false;       // whether that had a set
  bool has_set_ = false;       // whether the next frame has
  std::vector<Pair> toggled_;  // pairs that are ignored in one of the two frames, sorted by take()
  std::size_t newly_ = 0;      // after insert(): the first ones of toggled_ are those newly ignored
  std::vector<Pair> sorting_;
};

}  // namespace broadside::track
