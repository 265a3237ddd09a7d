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
  /// All boxes. A box is added, moved or removed by changing its place in the array (an absent box is no
  /// box). An array longer than before adds boxes, which need not be listed; a shorter one makes the missing
  /// ones absent.
  std::span<const Box<D, Real>> boxes;

  /// The places whose boxes or filters may differ from the frame before, in any order; one listed twice is
  /// harmless. A change that is not listed is not seen. In a tracker's first frame everything has changed.
  std::span<const BoxId> changed{};

  /// A filter for each box, or none at all: then every box has the standard one.
  std::span<const Filter> filters{};

  /// The pairs that do not count, or null for none.
  const IgnoredPairs* ignored = nullptr;

  /// The pairs that were added to `ignored` or removed from it since the frame before, in any order. Not
  /// needed if the frame before had no set.
  std::span<const Pair> ignored_changed{};
};

namespace world {
template <int D, typename Real>
class WorldTracker;
}  // namespace world

/// Follows boxes frame after frame and reports which pairs began and which ended.
///
/// A tracker brings the pairs up to date in one of four ways: it compares all boxes where they are few; it
/// follows what changed in a structure that stays; it tests the kept pairs of enlarged boxes; or it finds all
/// pairs anew and tells the difference. It chooses by counts alone, so that the same history always goes the
/// same way.
///
/// One thread at a time. Memory: two copies of the boxes and what the algorithm keeps. Cost of an update
/// besides the algorithm's: O(changed), whatever the number of boxes. A tracker that was moved from may only
/// be assigned to or destroyed.
template <int D, typename Real = float>
class BROADSIDE_PUBLIC Tracker final {
  static_assert(detail::SupportedBox<D, Real>::value);

 public:
  /// A tracker by one of algorithms(), from a spec such as "grid:update=follow" or
  /// GridOptions{.update = Update::follow}. Throws InvalidSpec, which names all algorithms if there is none
  /// of that name.
  explicit Tracker(const Spec& spec = {});

  /// A tracker by `algorithm` with the values in `spec`; the name in `spec` is ignored. Throws InvalidSpec if
  /// a value is wrong or the algorithm does not support D dimensions.
  Tracker(const Algorithm& algorithm, const Spec& spec);

  /// A tracker by a searcher of your own, which finds all pairs anew in each frame. Cost of a frame: one
  /// search and one pass over the pairs of both frames; the pairs are stored. Throws std::invalid_argument if
  /// it is null.
  explicit Tracker(std::unique_ptr<Searcher<D>> searcher);

  /// A tracker by a follower of your own, which gets every frame. For boxes of floats only. Throws
  /// std::invalid_argument if it is null.
  explicit Tracker(std::unique_ptr<Follower<D>> follower) requires std::is_same_v<Real, float>;

  Tracker(Tracker&& other) noexcept;
  Tracker& operator=(Tracker&& other) noexcept;
  ~Tracker();

  /// Takes the next frame; writes to `begun` the pairs that hold now and did not before, to `ended` those
  /// that did and do not now, each sorted by id, each once; flushes both. The two may be the same sink.
  /// Returns what the update did; nothing if the algorithm does not count.
  ///
  /// Throws before anything has changed: InvalidInput if a changed box is invalid (unless bad_input() says
  /// otherwise); InvalidFrame if an id in `changed` lies beyond both this frame's array and the last one's,
  /// or if there are filters and not one for each box. If a sink throws or memory runs out, the frame counts
  /// as not taken: the next update rebuilds, takes every box as changed and delivers the events since the
  /// last whole update.
  std::optional<Statistics> update(const Frame<D, Real>& frame, PairSink& begun, PairSink& ended);

  /// The same with two functions instead of sinks, each of a Pair or of a std::span<const Pair>.
  template <PairCallback Begun, PairCallback Ended>
  std::optional<Statistics> update(const Frame<D, Real>& frame, Begun&& begun, Ended&& ended) {
    PairFunction<Begun&> begun_sink(begun);
    PairFunction<Ended&> ended_sink(ended);
    return update(frame, static_cast<PairSink&>(begun_sink), static_cast<PairSink&>(ended_sink));
  }

  /// What update() does about changed boxes that are invalid: it throws, unless set_bad_input() says
  /// otherwise.
  [[nodiscard]] BadInput bad_input() const noexcept;
  void set_bad_input(BadInput bad_input) noexcept;

  /// The places whose boxes have been invalid since they last changed, ascending, and so count as absent.
  /// Valid until the next update.
  [[nodiscard]] std::span<const BoxId> quarantined() const noexcept;

  /// The frame that the last whole update() took, with nothing listed: what the next one's events start from.
  /// Without boxes before the first. Valid until the next update().
  [[nodiscard]] Frame<D, Real> last_frame() const noexcept;

  /// The boxes of the last whole update() for queries (see queries.hpp), where the algorithm keeps such an
  /// index anyway; else null. Valid until the next update().
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
  template <int, typename>
  friend class world::WorldTracker;

  /// For worlds, as update(): each box that `changed` lists is listed once, and is valid or absent.
  std::optional<Statistics> update_checked(const Frame<D, Real>& frame, PairSink& begun, PairSink& ended);

  class State;
  std::unique_ptr<State> state_;
};

}  // namespace broadside
