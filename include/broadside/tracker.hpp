// PairTracker: changes to pairs begun and ended, frame after frame; and DiffTracker, which makes any finder a
// tracker.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "broadside/box.hpp"
#include "broadside/error.hpp"
#include "broadside/executor.hpp"
#include "broadside/export.hpp"
#include "broadside/filter.hpp"
#include "broadside/finder.hpp"
#include "broadside/pair.hpp"
#include "broadside/sinks.hpp"

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

  /// Those that were put into `ignored` or taken from it since the frame before, as `changed` lists boxes.
  /// Not needed where the frame before had no set.
  std::span<const Pair> ignored_changed{};
};

/// What changed from one frame to the next, as a tracker's algorithm sees it. A pair holds where two boxes
/// are present, overlap and accept each other.
template <int D, typename Real = float>
struct Change {
  std::span<const Box<D, Real>>
      before;                         ///< boxes of the frame before; as long as `now`, filled up with absent
  std::span<const Box<D, Real>> now;  ///< boxes of this frame, likewise; each one present or absent
  std::span<const BoxId> changed;     ///< places where the two, or their filters, may differ, each once
  std::span<const std::uint8_t> flags;  ///< for each place, 1 if it is in `changed`

  /// Nothing kept from earlier frames can be relied on: what a tracker keeps is built anew from `before`.
  bool rebuild = false;

  std::span<const Filter> filters_before{};  ///< likewise; both empty where there are no filters
  std::span<const Filter> filters_now{};     ///<

  /// The frame as the caller gave it, for trackers that check it: what is not listed is not in `now`. Null
  /// where there is none.
  const Frame<D, Real>* frame = nullptr;

  /// Whether the pair held in the frame before, and whether it holds in this one.
  bool held(BoxId a, BoxId b) const noexcept { return holds(before, filters_before, a, b); }
  bool holds(BoxId a, BoxId b) const noexcept { return holds(now, filters_now, a, b); }

  /// Writes the pair to the sink it belongs to: `begun` if it holds and did not, `ended` if it did and does
  /// not, none if nothing changed.
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

namespace core {
template <int D>
class CandidateTracker;
}  // namespace core

/// Follows boxes frame after frame and reports which pairs began and which ended.
///
/// One thread at a time. Memory: two copies of the boxes and what the algorithm keeps. Cost of an update
/// around the algorithm's: O(changed), whatever the number of boxes.
template <int D, typename Real = float>
class BROADSIDE_PUBLIC PairTracker {
  static_assert(detail::SupportedBox<D, Real>::value);

 public:
  PairTracker();
  PairTracker(const PairTracker&) = delete;
  PairTracker& operator=(const PairTracker&) = delete;
  virtual ~PairTracker();

  /// Takes the next frame; writes to `begun` the pairs that hold now and did not before, to `ended` those
  /// that did and do not now, each sorted by id, each once; flushes both. The two may be the same sink.
  ///
  /// Throws before anything has changed: InvalidInput if a changed box is invalid (unless bad_input() says
  /// otherwise); InvalidFrame if an id in `changed` lies beyond both this frame's array and the last one's,
  /// or if there are filters and not one for each box. If a sink throws or memory runs out, the frame counts
  /// as not taken: the next update rebuilds, takes every box for changed and delivers the events since the
  /// last whole update.
  void update(const Frame<D, Real>& frame, PairSink& begun, PairSink& ended);

  /// The same with two functions instead of sinks, each of a Pair or of a std::span<const Pair>.
  template <PairCallback Begun, PairCallback Ended>
  void update(const Frame<D, Real>& frame, Begun&& begun, Ended&& ended) {
    PairFunction<Begun&> begun_sink(begun);
    PairFunction<Ended&> ended_sink(ended);
    update(frame, begun_sink, ended_sink);
  }

  /// What update() does about changed boxes that are invalid: it throws, unless set_bad_input() says
  /// otherwise.
  BadInput bad_input() const noexcept;
  void set_bad_input(BadInput bad_input) noexcept;

  /// The places whose boxes have been invalid since they last changed, ascending, and so count as absent.
  /// Valid until the next update.
  std::span<const BoxId> quarantined() const noexcept;

  /// The frame that the last whole update() took, with nothing listed: what the next one's events start from.
  /// Without boxes before the first. Valid until the next update().
  Frame<D, Real> last_frame() const noexcept;

  /// The boxes of the last whole update() for queries (see queries.hpp), where the algorithm keeps such an
  /// index anyway; else null. Valid until the next update().
  const BoxIndex<D, Real>* box_index() const noexcept;

  /// What the last update() did; empty where the algorithm does not count.
  const std::optional<Statistics>& statistics() const noexcept;

  /// Where the algorithm is one that chooses: what it chose for the last update(), and why, in a sentence.
  /// Empty for others.
  virtual std::string explanation() const { return {}; }

  /// For the library: what follows boxes for this tracker, if it can leave it to its caller to judge pairs.
  virtual core::CandidateTracker<D>* candidate_tracker() { return nullptr; }

  /// The bytes it holds: what every tracker keeps, and what the algorithm says that it keeps.
  std::size_t bytes() const noexcept;

  /// As a PairFinder's.
  const Workers& workers() const noexcept;
  void set_workers(const Workers& workers);

 protected:
  /// For update_valid: what this update did.
  void count(const std::optional<Statistics>& statistics);

  /// For update_valid: lets another tracker do this update, with the same workers. Its statistics are then
  /// this tracker's.
  void update_with(PairTracker& other, const Change<D, Real>& change, PairSink& begun, PairSink& ended);

  /// For a tracker that works through another: what that one's algorithm keeps, and its index.
  static std::size_t kept_bytes(const PairTracker& other) noexcept { return other.algorithm_bytes(); }
  static const BoxIndex<D, Real>* index_of(const PairTracker& other) noexcept {
    return other.algorithm_index();
  }

 private:
  template <int, typename>
  friend class World;

  /// For worlds, as update(): each box that `changed` lists is listed once, and is valid or absent.
  void update_checked(const Frame<D, Real>& frame, PairSink& begun, PairSink& ended);

  /// What an algorithm writes: the events of `change`, in any order. One may be written more than once.
  virtual void update_valid(const Change<D, Real>& change, PairSink& begun, PairSink& ended) = 0;

  /// Where a tracker works through a finder or another tracker, it hands workers() on.
  virtual void workers_changed() {}

  /// What box_index() gives after a whole update.
  virtual const BoxIndex<D, Real>* algorithm_index() const noexcept { return nullptr; }

  /// The bytes that the algorithm keeps from frame to frame.
  virtual std::size_t algorithm_bytes() const noexcept { return 0; }

  class State;
  std::unique_ptr<State> state_;
};

/// Makes a tracker of one of algorithms(), from a spec such as "grid:update=follow". Throws InvalidSpec,
/// naming the algorithms there are, if there is none of that name.
template <int D, typename Real = float>
BROADSIDE_PUBLIC std::unique_ptr<PairTracker<D, Real>> make_tracker(std::string_view spec);

/// Makes any finder a tracker: finds all pairs in each frame and tells what differs from the frame before.
///
/// Cost a frame: one find() and one pass over the pairs of both frames; the pairs are stored.
template <int D, typename Real = float>
class BROADSIDE_PUBLIC DiffTracker final : public PairTracker<D, Real> {
 public:
  explicit DiffTracker(std::unique_ptr<PairFinder<D, Real>> finder);
  ~DiffTracker() override;

  std::string explanation() const override { return finder_->explanation(); }

 private:
  void update_valid(const Change<D, Real>& change, PairSink& begun, PairSink& ended) override;
  void workers_changed() override { finder_->set_workers(this->workers()); }
  std::size_t algorithm_bytes() const noexcept override;

  struct Pairs;

  std::unique_ptr<PairFinder<D, Real>> finder_;
  std::unique_ptr<Pairs> pairs_;
};

}  // namespace broadside
