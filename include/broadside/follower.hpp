// Follower: the interface of an algorithm that follows boxes frame after frame in a structure that stays. A
// Tracker is what users call.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "broadside/box.hpp"
#include "broadside/executor.hpp"
#include "broadside/export.hpp"
#include "broadside/filter.hpp"
#include "broadside/pair.hpp"
#include "broadside/searcher.hpp"

namespace broadside {

/// What changed from one frame to the next, as a follower sees it. A pair holds where two boxes are present,
/// overlap and accept each other.
template <int D, typename Real = float>
struct Change {
  /// The boxes of the frame before and of this one, each present or absent. The shorter array is filled up
  /// with absent boxes.
  std::span<const Box<D, Real>> before;
  std::span<const Box<D, Real>> now;

  /// The places where the two, or their filters, may differ, each once; and for each place, 1 if it is
  /// listed.
  std::span<const BoxId> changed;
  std::span<const std::uint8_t> flags;

  /// Nothing kept from earlier frames can be relied on: the follower builds its structure from `before`.
  bool rebuild = false;

  /// The filters of both frames, likewise; both empty where there are no filters.
  std::span<const Filter> filters_before{};
  std::span<const Filter> filters_now{};

  /// Asks for candidates instead of events: the pairs of each changed box with all other boxes that overlap
  /// the box as it was or as it is. Only for an algorithm with Algorithm::gives_candidates.
  bool wants_candidates = false;

  /// Threads and checkpoint, as in SearchInput.
  const Workers& workers = default_workers;

  /// Whether the pair held in the frame before, and whether it holds in this one.
  [[nodiscard]] bool held(BoxId a, BoxId b) const noexcept { return holds(before, filters_before, a, b); }
  [[nodiscard]] bool holds(BoxId a, BoxId b) const noexcept { return holds(now, filters_now, a, b); }

  /// Writes the pair to `begun` if it holds now and did not before, to `ended` if it held before and does not
  /// now, and nowhere if nothing changed.
  void report(BoxId a, BoxId b, PairSink& begun, PairSink& ended) const {
    const bool is = holds(a, b);
    if (is != held(a, b)) (is ? begun : ended).add(a, b);
  }

 private:
  static bool holds(std::span<const Box<D, Real>> boxes, std::span<const Filter> filters, BoxId a,
                    BoxId b) noexcept {
    const Box<D, Real>& first = boxes[index(a)];
    const Box<D, Real>& second = boxes[index(b)];
    return overlap(first, second) && is_present(first) && is_present(second) &&
           (filters.empty() || accepts(filters[index(a)], filters[index(b)]));
  }
};

template <int D, typename Real>
class BoxIndex;

/// Follows boxes of floats in a structure of its own.
///
/// Tracker does the rest: it checks the frame, keeps both states of each box, takes care of quarantined boxes
/// and ignored pairs, sorts the events and delivers each once. A follower has one caller at a time.
template <int D>
class BROADSIDE_PUBLIC Follower {
 public:
  Follower() = default;
  Follower(const Follower&) = delete;
  Follower& operator=(const Follower&) = delete;
  virtual ~Follower() = default;

  /// Takes a frame, and writes to `begun` the pairs that hold now and did not before, to `ended` those that
  /// did and do not now, in any order. An event may be written more than once. Candidates, if
  /// change.wants_candidates, all go to `begun`. Returns what it did, or nothing if it does not count. After
  /// an exception the next change has `rebuild`.
  ///
  /// Ids must be below change.now.size(); otherwise the behaviour is undefined. A missing or wrong event is
  /// passed on: ShadowTracker and WorldOptions::shadow find such faults.
  virtual std::optional<Statistics> follow(const Change<D>& change, PairSink& begun, PairSink& ended) = 0;

  /// The boxes of the last frame for queries (see queries.hpp), if the follower keeps such an index anyway.
  [[nodiscard]] virtual const BoxIndex<D, float>* box_index() const noexcept { return nullptr; }

  /// The bytes kept from frame to frame.
  [[nodiscard]] virtual std::size_t bytes() const noexcept { return 0; }
};

}  // namespace broadside
