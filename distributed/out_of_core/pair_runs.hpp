// Pairs on disk: sorted runs, and their merge.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
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
constexpr std::size_t run_block_bytes = std::size_t{1} << 16;

/// Writes sorted pairs as a run, and returns its number of blocks.
template <typename P>
std::uint64_t write_run(const std::filesystem::path& path, std::span<const P> pairs) {
  BlockWriter writer(path);
  constexpr std::size_t pairs_per_block = run_block_bytes / sizeof(P);
  while (!pairs.empty()) {
    const std::span<const P> block = pairs.first(std::min(pairs.size(), pairs_per_block));
    writer.append(std::as_bytes(block));
    pairs = pairs.subspan(block.size());
  }
  return writer.blocks();
}

/// Collects the pairs of a part; sorts and writes them as a run whenever they fill the memory.
template <typename P>
class RunWriter {
 public:
  /// `memory` in bytes, half of which is for sorting.
  RunWriter(const WorkFolder& folder, Part& part, std::uint64_t memory)
      : folder_(folder), part_(part), max_pairs_(std::max<std::uint64_t>(memory / (2 * sizeof(P)), 4096)) {
    part_.runs.clear();
    part_.pairs = 0;
    pairs_.reserve(max_pairs_);
  }

  /// May be called by several threads at once.
  void add(std::span<const P> pairs) {
    const std::lock_guard lock(mutex_);
    if (pairs_.size() + pairs.size() > max_pairs_) flush();
    pairs_.insert(pairs_.end(), pairs.begin(), pairs.end());
  }

  /// Writes what has been collected.
  void flush() {
    if (pairs_.empty()) return;
    sort_pairs(pairs_, scratch_);
    part_.pairs += pairs_.size();
    part_.runs.push_back(write_run<P>(folder_.pair_file(part_, part_.runs.size()), pairs_));
    pairs_.clear();
  }

 private:
  const WorkFolder& folder_;
  Part& part_;
  std::size_t max_pairs_;
  std::mutex mutex_;
  std::vector<P> pairs_;
  std::vector<P> scratch_;
};

struct Run {
  std::filesystem::path path;
  std::uint64_t blocks;
};

/// Visits the pairs of one run after the other.
template <typename P>
void read_runs(const std::vector<Run>& runs, const std::function<void(std::span<const P>)>& visit) {
  std::vector<std::byte> bytes;
  for (const Run& run : runs)
    for (BlockReader reader(run.path, run.blocks); reader.next(bytes);)
      visit({reinterpret_cast<const P*>(bytes.data()), bytes.size() / sizeof(P)});
}

/// Visits the pairs of all runs in ascending order, in about `memory` bytes, or in a few blocks of each run
/// where that is more.
///
/// Reads blocks into a pool, always the next block of the run whose last pooled pair is the lowest. Every
/// pair up to that one is then in the pool: these are sorted and visited.
template <typename P>
void merge_runs(const std::vector<Run>& runs, std::uint64_t memory,
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
    const std::span<const P> block(reinterpret_cast<const P*>(bytes.data()), bytes.size() / sizeof(P));
    pool.insert(pool.end(), block.begin(), block.end());
    heads.push({block.back(), run});
  };
  // Half of the memory is for sorting. Pairs that stay in the pool are sorted again, so the pool is several
  // times as large as what can stay.
  const std::size_t room =
      std::max<std::size_t>(memory / (2 * sizeof(P)), 4 * runs.size() * (run_block_bytes / sizeof(P)));
  pool.reserve(room + run_block_bytes / sizeof(P));
  for (std::size_t run = 0; run < runs.size(); ++run) {
    readers.emplace_back(runs[run].path, runs[run].blocks);
    pool_next(run);
  }
  while (!pool.empty()) {
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

}  // namespace broadside::out_of_core
