// Follower: the interface of an algorithm that follows boxes from frame to frame in a persistent structure.
// Users call a Tracker.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "broadside/box.hpp"
#include "broadside/executor.hpp"
#include "broadside/export.hpp"
#include "broadside/filter.hpp"
#include "broadside/pair.hpp"
#include "broadside/searcher.hpp"

namespace broadside {

/// What changed from one frame to the next. A pair holds in a frame if both boxes are present, overlap and
/// accept each other by their filters.
template <int D, typename Real = float>
struct Change {
  /// The boxes of the previous frame and of this one. Some may be absent. Both arrays have the same size:
  /// absent boxes fill up the shorter one.
  std::span<const Box<D, Real>> before;
  std::span<const Box<D, Real>> now;

  /// The indexes at which boxes or filters may have changed, each once. flags[i] is 1 if i is among them,
  /// else 0.
  std::span<const BoxId> changed;
  std::span<const std::uint8_t> flags;

  /// Whether the follower must discard what it kept from earlier frames, and build its structure from
  /// `before`.
  bool rebuild = false;

  /// The filters of both frames, by index; empty if there are none.
  std::span<const Filter> filters_before{};
  std::span<const Filter> filters_now{};

  /// Whether to write candidates instead of events: the pairs of each changed box with every other box that
  /// it overlapped before or overlaps now. Only set for an algorithm with Algorithm::gives_candidates.
  bool wants_candidates = false;

  /// The number of tests beyond which another way costs less. A follower may ignore it, or return once it has
  /// made more tests. The tracker then takes another way, and the follower's next change has `rebuild`.
  std::uint64_t max_tests = std::numeric_limits<std::uint64_t>::max();

  /// The threads to use and the checkpoint to call, as in SearchInput.
  const Workers& workers = default_workers;

  /// Whether the pair held in the previous frame, and whether it holds in this one.
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

/// The part of a Tracker that you write for an algorithm of your own: it follows moving boxes in a structure
/// that persists from frame to frame.
///
/// Tracker does the rest: it checks the frame, keeps both states of each box, handles quarantined boxes and
/// ignored pairs, sorts the events and delivers each once. Only one thread at a time calls a follower.
template <int D>
class BROADSIDE_PUBLIC Follower {
 public:
  Follower() = default;
  Follower(const Follower&) = delete;
  Follower& operator=(const Follower&) = delete;
  virtual ~Follower() = default;

  /// Brings the structure up to date with the frame. Writes to `begun` the pairs that hold now and did not
  /// before, and to `ended` the pairs that held before and do not now, in any order; repeated events do no
  /// harm. It suffices to call change.report() for every pair of a changed box that may be one of these. If
  /// change.wants_candidates, writes all candidates to `begun`. Returns what it did, or nothing if it does
  /// not count. After an exception, the next change has `rebuild`.
  ///
  /// Ids must be below change.now.size(); otherwise the behaviour is undefined. Tracker does not notice
  /// missing or wrong events: ShadowTracker and WorldOptions::shadow find such faults.
  virtual std::optional<Statistics> follow(const Change<D>& change, PairSink& begun, PairSink& ended) = 0;

  /// An index of the last frame's boxes for queries (see index.hpp), if the follower keeps one anyway.
  [[nodiscard]] virtual const BoxIndex<D, float>* box_index() const noexcept { return nullptr; }

  /// The memory kept from frame to frame, in bytes.
  [[nodiscard]] virtual std::size_t bytes() const noexcept { return 0; }
};

}  // namespace broadside
