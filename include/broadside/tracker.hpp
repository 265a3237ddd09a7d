// Tracker: turns changes of boxes into pairs begun and ended, frame after frame.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>

#include "broadside/box.hpp"
#include "broadside/error.hpp"
#include "broadside/executor.hpp"
#include "broadside/export.hpp"
#include "broadside/filter.hpp"
#include "broadside/finder.hpp"
#include "broadside/follower.hpp"
#include "broadside/pair.hpp"
#include "broadside/searcher.hpp"
#include "broadside/sinks.hpp"
#include "broadside/spec.hpp"

namespace broadside {

/// The boxes of one frame, and what changed since the frame before.
template <int D, typename Real = float>
struct Frame {
  /// All boxes. To add, move or remove a box, change its element of the array; an absent box means no box. An
  /// array longer than before adds boxes, which need not be listed; a shorter one removes boxes.
  std::span<const Box<D, Real>> boxes;

  /// The indexes at which boxes or filters may differ from the frame before, in any order; repetitions are
  /// harmless. The tracker does not see unlisted changes. In its first frame everything has changed.
  std::span<const BoxId> changed{};

  /// One filter for each box; or none, and every box has the default filter.
  std::span<const Filter> filters{};

  /// The pairs that do not count, or null for none.
  const IgnoredPairs* ignored = nullptr;

  /// The pairs that were added to `ignored` or removed from it since the frame before, in any order. Not
  /// needed if the frame before had no set.
  std::span<const Pair> ignored_changed{};
};

namespace detail {
struct CheckedUpdate;
}  // namespace detail

/// Follows boxes frame after frame and reports which pairs began and which ended.
///
/// A tracker updates the pairs in one of four ways: it compares the changed boxes with all others, if there
/// are few boxes; it follows the changes in a persistent structure; it tests the kept pairs of enlarged
/// boxes; or it finds all pairs anew and reports the differences. Its choice depends on counts alone, so the
/// same history always leads to the same choices.
///
/// One thread at a time. Memory: two copies of the boxes and what the algorithm keeps. Cost of an update
/// besides the algorithm's: O(changed), independent of the number of boxes. A tracker that was moved from may
/// only be assigned to or destroyed.
template <int D, typename Real = float>
class BROADSIDE_PUBLIC Tracker final {
  static_assert(detail::SupportedBox<D, Real>::value);

 public:
  /// A tracker that uses one of algorithms(), from a spec such as "grid:update=follow" or
  /// GridOptions{.update = Update::follow}. Throws InvalidSpec if the spec is wrong. If the name is unknown,
  /// the message lists all algorithms.
  explicit Tracker(const Spec& spec = {});

  /// A tracker that uses `algorithm` with the values in `spec`; the name in `spec` is ignored. Throws
  /// InvalidSpec if a value is wrong or the algorithm does not support D dimensions.
  Tracker(const Algorithm& algorithm, const Spec& spec);

  /// A tracker that uses your own searcher to find all pairs anew in each frame, and stores them. Cost of a
  /// frame: one search and one pass over the pairs of both frames. Throws std::invalid_argument if it is
  /// null.
  explicit Tracker(std::unique_ptr<Searcher<D>> searcher);

  /// A tracker that passes every frame to your own follower. For boxes of floats only. Throws
  /// std::invalid_argument if it is null.
  explicit Tracker(std::unique_ptr<Follower<D>> follower) requires std::is_same_v<Real, float>;

  Tracker(Tracker&& other) noexcept;
  Tracker& operator=(Tracker&& other) noexcept;
  ~Tracker();

  /// Takes the next frame. Writes to `begun` the pairs that hold now and did not before, and to `ended` the
  /// pairs that held before and do not now, each once, sorted by id. Flushes both, which may be the same
  /// sink. Returns what the update did, or nothing if the algorithm does not count.
  ///
  /// Throws before anything has changed: InvalidInput if a changed box is invalid (unless bad_input() says
  /// otherwise); InvalidFrame if an id in `changed` lies beyond both this frame's array and the last one's,
  /// or if there are filters, but not one for each box. If a sink throws or memory runs out, the frame counts
  /// as not taken: the next update rebuilds, treats every box as changed and delivers the events since the
  /// last whole update.
  std::optional<Statistics> update(const Frame<D, Real>& frame, PairSink& begun, PairSink& ended);

  /// The same with two functions instead of sinks, each of a Pair or of a std::span<const Pair>.
  template <PairCallback Begun, PairCallback Ended>
  std::optional<Statistics> update(const Frame<D, Real>& frame, Begun&& begun, Ended&& ended) {
    PairFunction<Begun&> begun_sink(begun);
    PairFunction<Ended&> ended_sink(ended);
    return update(frame, static_cast<PairSink&>(begun_sink), static_cast<PairSink&>(ended_sink));
  }

  /// What update() does with invalid changed boxes: it throws, unless set_bad_input() says otherwise.
  [[nodiscard]] BadInput bad_input() const noexcept;
  void set_bad_input(BadInput bad_input) noexcept;

  /// Whether boxes that only touch overlap; true by default. Throws std::logic_error after the first
  /// update. If false, last_frame() and box_index() hold the boxes that half_open() returns.
  [[nodiscard]] bool touching() const noexcept;
  void set_touching(bool touching);

  /// The indexes, ascending, of the boxes that were invalid when they last changed. They count as absent.
  /// Valid until the next update.
  [[nodiscard]] std::span<const BoxId> quarantined() const noexcept;

  /// The frame that the last whole update() took, with empty lists of changes. The next update's events start
  /// from it. It has no boxes before the first update. Valid until the next update().
  [[nodiscard]] Frame<D, Real> last_frame() const noexcept;

  /// An index of the boxes of the last whole update() for queries (see queries.hpp), if the algorithm keeps
  /// one anyway; else null. Valid until the next update().
  [[nodiscard]] const BoxIndex<D, Real>* box_index() const noexcept;

  /// In one sentence, how the last update() was done and, if the algorithm chooses among others, what it
  /// chose. Empty for an algorithm that has only one way.
  [[nodiscard]] std::string explanation() const;

  /// The number of bytes held by the tracker and, as far as it reports them, by the algorithm.
  [[nodiscard]] std::size_t bytes() const noexcept;

  /// As Finder::workers() and Finder::set_workers().
  [[nodiscard]] const Workers& workers() const noexcept;
  void set_workers(const Workers& workers);

 private:
  friend struct detail::CheckedUpdate;

  /// update() for worlds, without checks: `changed` lists each box once, and these are valid or absent.
  std::optional<Statistics> update_checked(const Frame<D, Real>& frame, PairSink& begun, PairSink& ended);

  class State;
  std::unique_ptr<State> state_;
};

}  // namespace broadside
