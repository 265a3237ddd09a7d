// Pairs on disk: runs of sorted pairs, and all of them in order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include "broadside/out_of_core.hpp"
#include "broadside/pair.hpp"

#include "blocks.hpp"
#include "core/sort_pairs.hpp"

namespace broadside::out_of_core {

inline void sort(std::vector<Pair>& pairs, std::vector<Pair>& scratch) { core::sort(pairs, scratch); }
inline void sort(std::vector<LargePair>& pairs, std::vector<LargePair>&) {
  std::sort(pairs.begin(), pairs.end());
}

/// A run is read this many bytes at a time.
constexpr std::size_t run_block_bytes = std::size_t{1} << 16;

/// Writes sorted pairs as a run, and returns its number of blocks.
template <typename P>
std::uint64_t write_run(const std::filesystem::path& path, std::span<const P> pairs) {
  BlockWriter writer(path);
  constexpr std::size_t pairs_a_block = run_block_bytes / sizeof(P);
  while (!pairs.empty()) {
    const std::span<const P> block = pairs.first(std::min(pairs.size(), pairs_a_block));
    writer.append(std::as_bytes(block));
    pairs = pairs.subspan(block.size());
  }
  return writer.blocks();
}

struct Run {
  std::filesystem::path path;
  std::uint64_t blocks;
};

/// Hands on the pairs of one run after the other.
template <typename P>
void read_runs(const std::vector<Run>& runs, const std::function<void(std::span<const P>)>& take) {
  std::vector<std::byte> bytes;
  for (const Run& run : runs)
    for (BlockReader reader(run.path, run.blocks); reader.next(bytes);)
      take({reinterpret_cast<const P*>(bytes.data()), bytes.size() / sizeof(P)});
}

/// Hands on the pairs of all runs in order, with about `memory` bytes, or a block of each run where that is
/// more.
///
/// Blocks are pooled in the order of their last pairs. All that is not beyond the last pooled pair of any run
/// is then complete: it is sorted, and handed on.
template <typename P>
void merge_runs(const std::vector<Run>& runs, std::uint64_t memory,
                const std::function<void(std::span<const P>)>& take) {
  struct Head {
    P last;  // of what is pooled of the run
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
  // Half is for the scratch of sorting; what stays of each run is sorted again, so that it should be little.
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
    sort(pool, scratch);
    const auto complete =
        heads.empty() ? pool.end() : std::upper_bound(pool.begin(), pool.end(), heads.top().last);
    take({pool.data(), static_cast<std::size_t>(complete - pool.begin())});
    pool.erase(pool.begin(), complete);
  }
}

}  // namespace broadside::out_of_core
