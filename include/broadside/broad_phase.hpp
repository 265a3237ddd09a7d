// The two interfaces behind which every algorithm stands: PairFinder (boxes to pairs) and PairTracker
// (changes to pairs begun and ended), and DiffTracker, which makes any finder a tracker.
//
// The law that joins them: for every algorithm, after any history, the events accumulated = find() on the
// boxes as they are now = brute force, as sets, each pair exactly once.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/executor.hpp"
#include "broadside/pair.hpp"

namespace broadside {

/// What one search did, in the paper's units of cost.
struct Statistics {
  std::uint64_t tests = 0;       ///< pairs of boxes compared
  std::uint64_t references = 0;  ///< entries of boxes in cells, leaves or lists
};

/// Finds every overlapping pair in an array of boxes, from nothing, at each call.
///
/// A finder keeps its scratch memory between calls, and nothing else that can be observed. To be called by
/// one thread at a time; it may itself use several, which shows in nothing but the time.
template <int D, typename Real = float>
class PairFinder {
 public:
  PairFinder() = default;
  PairFinder(const PairFinder&) = delete;
  PairFinder& operator=(const PairFinder&) = delete;
  virtual ~PairFinder() = default;

  /// Writes each pair of overlapping boxes to `pairs` once, as ids = places in `boxes`, and flushes it. The
  /// order is fixed by the algorithm and the boxes, whatever the workers. Absent boxes pair with nothing.
  ///
  /// Throws InvalidInput, naming index and values, before anything is written if a box has a NaN, or min >
  /// max without being absent; and what the sink throws.
  void find(std::span<const Box<D, Real>> boxes, PairSink& pairs);

  /// Writes each pair of a box of `left` and an overlapping one of `right` once, and flushes. A pair's first
  /// is a place in `left` and its second one in `right`, so the two may be equal. No pair within a set is
  /// ever written; the library's own algorithms do not even look for one. Throws as find() does.
  void find_between(std::span<const Box<D, Real>> left, std::span<const Box<D, Real>> right, PairSink& pairs);

  /// The same for two sets that lie one behind the other: the first `left_count` <= boxes.size() boxes are
  /// the left set. Where none is absent this saves copying them.
  void find_between(std::span<const Box<D, Real>> boxes, std::size_t left_count, PairSink& pairs);

  /// What the last find() did; empty where the algorithm does not count.
  const std::optional<Statistics>& statistics() const noexcept { return statistics_; }

  /// Who does the work: one thread, unless the spec or set_workers() says otherwise. An algorithm without the
  /// tunable `threads` uses the calling thread alone.
  const Workers& workers() const noexcept { return workers_; }
  void set_workers(const Workers& workers) {
    workers_ = workers;
    workers_changed();
  }

  /// Where the algorithm is one that chooses: what it chose for the last find(), and why, in a sentence.
  /// Empty for others.
  virtual std::string explanation() const { return {}; }

 protected:
  /// For find_valid: what this search did.
  void count(const Statistics& statistics) { statistics_ = statistics; }

  /// For find_valid: lets another finder do this search, with the same workers. Its statistics are then this
  /// finder's.
  void search_with(PairFinder& other, std::span<const Box<D, Real>> boxes, PairSink& pairs);

  /// For find_valid: 0 if every overlapping pair is asked for. Else the boxes before this place are the left
  /// set and the others the right one, and pairs within a set need not be written: they will be dropped.
  std::size_t left_count() const noexcept { return left_count_; }

 private:
  /// What an algorithm writes. `boxes` are all present: min <= max, no NaN, perhaps infinite. Pairs are of
  /// places in `boxes`. No need to flush.
  virtual void find_valid(std::span<const Box<D, Real>> boxes, PairSink& pairs) = 0;

  /// Where a finder works through another one, it hands workers() on.
  virtual void workers_changed() {}

  /// Checks the boxes, and returns how many are absent.
  std::size_t check(std::span<const Box<D, Real>> boxes) const;

  /// Appends the present ones of `boxes` to present_ and their places to ids_.
  void take_present(std::span<const Box<D, Real>> boxes);

  std::vector<Box<D, Real>> present_;  // the boxes without the absent ones; unused while one set has none
  std::vector<BoxId> ids_;             // and their places in the caller's array
  std::size_t left_count_ = 0;
  std::optional<Statistics> statistics_;
  Workers workers_;
};

/// The boxes of one frame, and which of them changed since the frame before.
template <int D, typename Real = float>
struct Frame {
  /// All boxes. A box is added, moved or removed by changing its place in the array (an absent box is no
  /// box). An array longer than before adds boxes, which need not be listed; a shorter one makes the missing
  /// ones absent.
  std::span<const Box<D, Real>> boxes;

  /// The places whose boxes may differ from the frame before, in any order; one listed twice is harmless. A
  /// change that is not listed is not seen. In a tracker's first frame everything has changed.
  std::span<const BoxId> changed;
};

/// What changed from one frame to the next, as a tracker's algorithm sees it.
template <int D, typename Real = float>
struct Change {
  std::span<const Box<D, Real>>
      before;  ///< boxes of the frame before; as long as `now`, filled up with absent boxes
  std::span<const Box<D, Real>> now;    ///< boxes of this frame, likewise; each one present or absent
  std::span<const BoxId> changed;       ///< places where the two may differ, each once
  std::span<const std::uint8_t> flags;  ///< for each place, 1 if it is in `changed`
  bool rebuild;  ///< nothing kept from earlier frames can be relied on; every place is in `changed`
};

/// Follows boxes frame after frame and reports which pairs began and which ended.
///
/// One thread at a time. Memory: two copies of the boxes and what the algorithm keeps.
template <int D, typename Real = float>
class PairTracker {
 public:
  PairTracker() = default;
  PairTracker(const PairTracker&) = delete;
  PairTracker& operator=(const PairTracker&) = delete;
  virtual ~PairTracker() = default;

  /// Takes the next frame; writes to `begun` the pairs that overlap now and did not before, to `ended` those
  /// that did and do not now, each sorted by id, each once; flushes both. The two may be the same sink.
  ///
  /// Throws InvalidInput before anything has changed if a changed box is invalid, or if an id in `changed`
  /// lies beyond both this frame's array and the last one's. If a sink throws, the frame counts as not taken:
  /// the next update rebuilds, takes every box for changed and delivers the events since the last whole
  /// update.
  void update(const Frame<D, Real>& frame, PairSink& begun, PairSink& ended);

  /// What the last update() did; empty where the algorithm does not count.
  const std::optional<Statistics>& statistics() const noexcept { return statistics_; }

  /// As a PairFinder's.
  const Workers& workers() const noexcept { return workers_; }
  void set_workers(const Workers& workers) {
    workers_ = workers;
    workers_changed();
  }

 protected:
  /// For update_valid: what this update did.
  void count(const std::optional<Statistics>& statistics) { statistics_ = statistics; }

 private:
  /// What an algorithm writes: the events of `change`, each once, in any order.
  virtual void update_valid(const Change<D, Real>& change, PairSink& begun, PairSink& ended) = 0;

  /// Where a tracker works through a finder, it hands workers() on.
  virtual void workers_changed() {}

  std::vector<Box<D, Real>> before_;  // the boxes of the last whole update
  std::vector<Box<D, Real>> now_;
  std::vector<BoxId> changed_;
  std::vector<std::uint8_t> flags_;
  std::vector<Pair> begun_;
  std::vector<Pair> ended_;
  bool dirty_ = true;  // the last update did not end, or there was none
  std::optional<Statistics> statistics_;
  Workers workers_;
};

/// Makes any finder a tracker: finds all pairs in each frame and tells what differs from the frame before.
///
/// Cost a frame: one find() and one pass over the pairs of both frames; the pairs are stored.
template <int D, typename Real = float>
class DiffTracker final : public PairTracker<D, Real> {
 public:
  explicit DiffTracker(std::unique_ptr<PairFinder<D, Real>> finder);

 private:
  void update_valid(const Change<D, Real>& change, PairSink& begun, PairSink& ended) override;
  void workers_changed() override { finder_->set_workers(this->workers()); }

  std::unique_ptr<PairFinder<D, Real>> finder_;
  std::vector<Pair> pairs_;  // those of the frame before
  std::vector<Pair> found_;
};

}  // namespace broadside
