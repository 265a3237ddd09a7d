// Parallel: shares a search's work among threads. Pairs and their order do not depend on the thread count.
#pragma once

#include <cstddef>
#include <functional>
#include <thread>
#include <vector>

#include "broadside/executor.hpp"
#include "broadside/pair.hpp"
#include "broadside/searcher.hpp"

#include "core/delivery.hpp"

namespace broadside::core {

/// A half-open range of indices.
struct Range {
  std::size_t begin;
  std::size_t end;

  std::size_t size() const noexcept { return end - begin; }
};

/// Adds what one search did to the sum of several.
inline void add(Statistics& sum, const Statistics& more) noexcept {
  sum.tests += more.tests;
  sum.references += more.references;
  sum.cells += more.cells;
  sum.hits += more.hits;
}

/// Shares work among workers. A worker is one task of the executor, which takes piece after piece. It runs in
/// one thread, so scratch memory by worker needs no lock. With one worker everything runs in the calling
/// thread, as if this class were not there.
///
/// The parts of a search must depend on the boxes alone, never on the number of workers. Keeps its memory for
/// reuse. For one thread at a time.
class Parallel {
 public:
  Parallel();
  ~Parallel();
  Parallel(const Parallel&) = delete;
  Parallel& operator=(const Parallel&) = delete;

  /// Sets the number of workers for a search that takes about as long as visiting `boxes` boxes.
  void start(const Workers& workers, std::size_t boxes);

  std::size_t workers() const noexcept { return workers_; }

  /// The checkpoint to which a worker reports the pairs it compares. In the caller's thread it calls the
  /// caller's checkpoint. In other threads it ends the work once there is an exception. Null if there is
  /// none.
  Checkpoint* checkpoint(std::size_t worker) noexcept {
    return checkpoints_.empty() ? nullptr : &checkpoints_[worker].value;
  }

  /// One thread, for a whole search within a part of this one: with the checkpoint of a worker.
  Workers within_part() const {
    return {.checkpoint = checkpoint_ ? workers_checkpoint_ : std::function<void()>()};
  }

  /// Calls body(range, worker) for ranges that together are [0, count), several at the same time. Rethrows
  /// an exception of a body; of several, the first in order.
  template <typename Body>
  void for_ranges(std::size_t count, const Body& body) {
    if (workers() > 1)
      return share_ranges(count,
                          [&body](std::size_t, Range range, std::size_t worker) { body(range, worker); });
    body(Range{0, count}, std::size_t{0});
  }

  /// How many ranges for_numbered_ranges() makes.
  std::size_t range_count() const noexcept { return workers() == 1 ? 1 : ranges_per_worker * workers_; }

  /// Range `number`, below range_count(), of [0, count): the same in every call until the next start().
  Range range(std::size_t number, std::size_t count) const noexcept;

  /// Calls body(number, range, worker) for each numbered range, like for_ranges().
  template <typename Body>
  void for_numbered_ranges(std::size_t count, const Body& body) {
    if (workers() > 1) return share_ranges(count, std::cref(body));
    body(std::size_t{0}, Range{0, count}, std::size_t{0});
  }

  /// Searches [0, parts) for pairs: search(range, worker, sink) writes the pairs of a few consecutive parts,
  /// and returns its statistics. `pairs` gets them part by part in order, in this thread, while others still
  /// search. If `pairs` can be cloned, each worker fills a clone instead. Returns the sum of the statistics.
  ///
  /// Keeps at most 64 MiB of pairs that wait for earlier ones. A worker that finds no room drops the pairs of
  /// its parts, which are then searched again. So `search` must be exception-safe: its sink may throw.
  /// Rethrows an exception of a search or the sink; of several, the first in order.
  template <typename Search>
  Statistics search(std::size_t parts, PairSink& pairs, const Search& search) {
    if (workers_ > 1) return share_search(parts, pairs, std::cref(search));
    if (checkpoint_) return search_by_pieces(parts, pairs, std::cref(search));
    return search(Range{0, parts}, std::size_t{0}, pairs);
  }

 private:
  /// Fine enough that no worker waits long for the last one, coarse enough that taking one costs nothing.
  static constexpr std::size_t ranges_per_worker = 4;
  static constexpr std::size_t pieces_per_worker = 32;

  /// With a checkpoint, a piece has about this many boxes at most, so that checkpoints are frequent.
  static constexpr std::size_t boxes_between_checkpoints = 1024;

  using RangeBody = std::function<void(std::size_t, Range, std::size_t)>;
  using Search = std::function<Statistics(Range, std::size_t, PairSink&)>;

  class Errors;
  class SharedSearch;

  void choose_workers(const Workers& workers);
  void share_ranges(std::size_t count, const RangeBody& body);
  Statistics share_search(std::size_t parts, PairSink& pairs, const Search& search);
  Statistics search_by_pieces(std::size_t parts, PairSink& pairs, const Search& search);

  /// How many pieces a search of `parts` parts is cut into.
  std::size_t pieces_of(std::size_t parts) const noexcept;

  /// Calls the caller's checkpoint, if there is one. Only for the caller's thread.
  void pass_checkpoint() const;

  /// For a worker: calls the caller's checkpoint or, in another thread, ends the work after an exception.
  void pass_workers_checkpoint() const;

  /// Runs body(worker) on every worker and returns when all have ended. `body` must not throw; it notes
  /// exceptions in `errors`. The caller's thread calls its checkpoint while it waits for others.
  void run_workers(Errors& errors, const std::function<void(std::size_t)>& body);

  class Waiting;

  /// A checkpoint in its own cache line.
  struct alignas(64) WorkersCheckpoint {
    Checkpoint value;
  };

  Executor* executor_ = nullptr;
  std::size_t workers_ = 1;
  std::size_t boxes_ = 0;
  std::function<void()> checkpoint_;
  std::function<void()> workers_checkpoint_ = [this] { pass_workers_checkpoint(); };
  std::vector<WorkersCheckpoint> checkpoints_;  // by worker; empty without a checkpoint
  std::thread::id caller_;
  const Errors* errors_ = nullptr;  // of the workers
  PairBlocks blocks_;
};

}  // namespace broadside::core
