// PeerFollower: follows boxes with a library that moves its boxes and then reports all pairs, not only new
// ones.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "broadside/follower.hpp"
#include "broadside/sinks.hpp"

namespace broadside::lab::peers {

/// Converts the pairs that a library reports after its boxes moved to events. Keeps the pairs from frame to
/// frame.
template <int D>
class PeerFollower : public Follower<D> {
 public:
  std::optional<Statistics> follow(const Change<D>& change, PairSink& begun, PairSink& ended) final {
    if (change.rebuild) {
      build(change.before, change.now);
      pairs_.clear();
      // There is rarely a previous frame.
      if (std::ranges::any_of(change.before, is_present<D, float>)) {
        find({.before = change.before,
              .now = change.before,
              .changed = change.changed,
              .flags = change.flags,
              .rebuild = true,
              .workers = change.workers},
             pairs_);
      }
    }
    move(change);
    find(change, found_);
    // Whether the pair held in the other frame follows from its boxes.
    const auto rested = [&change](Pair pair) {
      return (change.flags[index(pair.first)] | change.flags[index(pair.second)]) == 0;
    };
    // Without filters, a pair in a list overlapped in the list's frame, so only the other frame is checked.
    const bool unfiltered = change.filters_before.empty() && change.filters_now.empty();
    auto kept = pairs_.begin();
    for (const Pair pair : pairs_) {
      if (rested(pair))
        *kept++ = pair;
      else if (!change.holds(pair.first, pair.second) && (unfiltered || change.held(pair.first, pair.second)))
        ended.add(pair.first, pair.second);
    }
    pairs_.erase(kept, pairs_.end());
    for (const Pair pair : found_) {
      if (rested(pair)) continue;
      pairs_.push_back(pair);
      if (!change.held(pair.first, pair.second) && (unfiltered || change.holds(pair.first, pair.second)))
        begun.add(pair.first, pair.second);
    }
    return std::nullopt;
  }

 private:
  /// Removes all boxes and adds the present ones of `boxes`. `now` holds the next frame's boxes, for
  /// libraries that need the world's size in advance.
  virtual void build(std::span<const Box<D>> boxes, std::span<const Box<D>> now) = 0;

  /// Applies every change.
  virtual void move(const Change<D>& change) = 0;

  /// Writes each overlapping pair of `change.now` once; may leave out pairs of two unchanged boxes.
  virtual void collide(const Change<D>& change, PairSink& pairs) = 0;

  void find(const Change<D>& change, std::vector<Pair>& pairs) {
    pairs.clear();
    PairCollector collector(pairs);
    collide(change, collector);
    collector.flush();
  }

  std::vector<Pair> pairs_;  // of the previous frame
  std::vector<Pair> found_;
};

}  // namespace broadside::lab::peers
