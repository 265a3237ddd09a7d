// Pairs on disk: sorted runs, and their merge.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <mutex>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include "broadside/large_pair.hpp"
#include "broadside/pair.hpp"

#include "blocks.hpp"
#include "work_folder.hpp"

namespace broadside::out_of_core {

/// Size of a run's blocks in bytes.
constexpr std::size_t run_block_bytes = std::size_t{1} << 15;

/// Appends sorted pairs to a run.
template <typename P>
void append_blocks(BlockWriter& writer, std::span<const P> pairs) {
  constexpr std::size_t pairs_per_block = run_block_bytes / sizeof(P);
  while (!pairs.empty()) {
    const std::span<const P> block = pairs.first(std::min(pairs.size(), pairs_per_block));
    writer.append(std::as_bytes(block));
    pairs = pairs.subspan(block.size());
  }
}

/// Collects the pairs of a part; sorts and writes them as a run whenever they fill the memory.
template <typename P>
class RunWriter {
 public:
  /// `memory` is in bytes; half of it is for sorting. With `counts_only`, pairs are only counted.
  RunWriter(const WorkFolder& folder, PartRecord& part, std::uint64_t memory, bool counts_only)
      : folder_(folder),
        part_(part),
        max_pairs_(std::max<std::uint64_t>(memory / (2 * sizeof(P)), 4096)),
        counts_only_(counts_only) {
    part_.runs.clear();
    part_.pairs = 0;
    if (counts_only_) return;
    // Sorting may swap the two vectors, and neither should have to grow.
    pairs_.reserve(max_pairs_);
    scratch_.reserve(max_pairs_);
  }

  /// Thread-safe.
  void add(std::span<const P> pairs) {
    const std::lock_guard lock(mutex_);
    if (counts_only_) {
      part_.pairs += pairs.size();
      return;
    }
    if (pairs_.size() + pairs.size() > max_pairs_) flush();
    pairs_.insert(pairs_.end(), pairs.begin(), pairs.end());
  }

  /// Writes the collected pairs.
  void flush() {
    if (pairs_.empty()) return;
    sort_pairs(pairs_, scratch_);
    part_.pairs += pairs_.size();
    BlockWriter writer(folder_.pair_file(part_, part_.runs.size()));
    append_blocks<P>(writer, pairs_);
    part_.runs.push_back(writer.blocks());
    pairs_.clear();
  }

 private:
  const WorkFolder& folder_;
  PartRecord& part_;
  std::size_t max_pairs_;
  bool counts_only_;
  std::mutex mutex_;
  std::vector<P> pairs_;
  std::vector<P> scratch_;
};

struct PairRun {
  std::filesystem::path path;
  std::uint64_t blocks;
};

/// k-way merge: visits the pairs of all runs in ascending order, with about `memory` bytes, or a few blocks
/// per run if that is more.
///
/// Reads blocks into a pool, always the next block of the run whose last pooled pair is the lowest. Every
/// pair up to that one is then in the pool; these are sorted and visited.
template <typename P>
void merge_at_once(std::span<const PairRun> runs, std::uint64_t memory,
                   const std::function<void(std::span<const P>)>& visit) {
  struct Head {
    P last;  // the last pooled pair of the run
    std::size_t run;
    bool operator>(const Head& other) const { return last > other.last; }
  };
  std::priority_queue<Head, std::vector<Head>, std::greater<>> heads;
  std::vector<BlockReader> readers;
  std::vector<P> pool;
  std::vector<P> scratch;
  std::vector<std::byte> bytes;
  const auto pool_next = [&](std::size_t run) {
    if (!readers[run].next(bytes)) return;
    const std::size_t before = pool.size();
    pool.resize(before + bytes.size() / sizeof(P));
    std::memcpy(pool.data() + before, bytes.data(), (pool.size() - before) * sizeof(P));
    heads.push({pool.back(), run});
  };
  // Half of the memory is for sorting. Pairs that stay in the pool are sorted again, so the pool is several
  // times as large as the maximum that can stay.
  const std::size_t room =
      std::max<std::size_t>(memory / (2 * sizeof(P)), 4 * runs.size() * (run_block_bytes / sizeof(P)));
  // Sorting may swap the two vectors, and neither should have to grow.
  for (std::vector<P>* const pairs : {&pool, &scratch}) pairs->reserve(room + run_block_bytes / sizeof(P));
  for (std::size_t run = 0; run < runs.size(); ++run) {
    readers.emplace_back(runs[run].path, runs[run].blocks);
    pool_next(run);
  }
  // The pool can become empty before the last run ends: then all other runs have ended.
  while (!pool.empty() || !heads.empty()) {
    while (!heads.empty() && pool.size() < room) {
      const std::size_t run = heads.top().run;
      heads.pop();
      pool_next(run);
    }
    sort_pairs(pool, scratch);
    const auto complete =
        heads.empty() ? pool.end() : std::upper_bound(pool.begin(), pool.end(), heads.top().last);
    visit({pool.data(), static_cast<std::size_t>(complete - pool.begin())});
    pool.erase(pool.begin(), complete);
  }
}

/// The maximum number of runs that this much memory can merge at once.
constexpr std::size_t max_fan_in(std::uint64_t memory) {
  return std::max<std::size_t>(4, static_cast<std::size_t>(memory / (8 * run_block_bytes)));
}

/// Visits the pairs of all runs in ascending order, with about `memory` bytes. If there are too many runs for
/// that, it first merges some of them into longer ones in the work folder.
template <typename P>
void merge_runs(const WorkFolder& folder, std::vector<PairRun> runs, std::uint64_t memory,
                const std::function<void(std::span<const P>)>& visit) {
  const std::size_t fan_in = max_fan_in(memory);
  std::vector<std::filesystem::path> merged;
  while (runs.size() > fan_in) {
    // Merges no more than necessary for the remaining runs to be merged at once.
    const std::size_t some = std::min(fan_in, runs.size() - fan_in + 1);
    merged.push_back(folder.merged_file(merged.size()));
    BlockWriter writer(merged.back());
    const std::span<const PairRun> first = std::span<const PairRun>(runs).first(some);
    merge_at_once<P>(first, memory, [&](std::span<const P> pairs) { append_blocks(writer, pairs); });
    std::error_code error;
    for (const PairRun& run : first)
      if (std::ranges::find(merged, run.path) != merged.end()) std::filesystem::remove(run.path, error);
    runs.erase(runs.begin(), runs.begin() + static_cast<std::ptrdiff_t>(some));
    runs.push_back({merged.back(), writer.blocks()});
  }
  merge_at_once<P>(runs, memory, visit);
  std::error_code error;
  for (const std::filesystem::path& file : merged) std::filesystem::remove(file, error);
}

}  // namespace broadside::out_of_core
