// Compares moved boxes with kept ones, written once for every instruction set.
//
// In blocks, each step runs for many boxes before the next one, so that none waits for memory. The first step
// lists and prefetches the blocks in question. The second compares a box, now and before, with the sixteen
// boxes of each block at once, and lists the blocks with hits without a branch. The third writes their pairs,
// without a branch for each.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/find_changes.cpp"
#include "kernels/find_changes.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/broadcast_box.hpp"

HWY_BEFORE_NAMESPACE();
namespace broadside::kernels::HWY_NAMESPACE {
namespace {

/// A moved box and a block with hits: the boxes that make an event or a candidate with it, as bits.
struct BlockHits {
  std::uint32_t moved;
  std::uint32_t block;
  std::uint16_t hits;
  std::uint16_t is;  ///< which boxes of the block it overlaps now
};

template <int D>
class MovedSearch {
 public:
  MovedSearch(const BlocksView<D>& blocks, std::span<const MovedBox<D>> moved, const core::ChangeSinks& sinks)
      : blocks_(blocks), moved_(moved), sinks_(sinks) {}

  core::ChangeWork in_blocks(std::span<const BlockTask> tasks) {
    for (const BlockTask& task : tasks) list(task.moved, task.block);
    return finish();
  }

  core::ChangeWork in_cells(const CellsView<D>& cells) {
    prefetches_ = !cells.are_cached;
    for (std::uint32_t i = 0; i < moved_.size(); ++i) {
      if (HWY_UNLIKELY(moved_[i].is_far)) {
        list(cells, i, moved_[i].before);
        list(cells, i, moved_[i].now);
      } else {
        list(cells, i, moved_[i].bounds);
      }
    }
    return finish();
  }

 private:
  HWY_INLINE void list(std::uint32_t moved, std::uint32_t block) {
    if (HWY_UNLIKELY(listed_ == max_listed)) compare();
    listed_tasks_[listed_++] = {moved, block};
    prefetch(block);
  }

  /// Lists the first block of each cell that may have boxes that overlap `box`.
  HWY_INLINE void list(const CellsView<D>& cells, std::uint32_t moved, const Box<D>& box) {
    for (const CellLevel<D>& level : cells.levels) {
      if (level.boxes == 0) continue;
      std::array<std::uint32_t, D> begin;
      std::array<std::uint32_t, D> count;
      bool is_small = true;
      for (int axis = 0; axis < D; ++axis) {
        begin[axis] = level.axes[axis](box.min[axis] - level.extent[axis]);
        count[axis] = level.axes[axis](box.max[axis]) - begin[axis] + 1;
        is_small &= count[axis] <= 2;
      }
      std::uint32_t cell = level.first_cell;
      for (int axis = 0; axis < D; ++axis) cell += begin[axis] * level.stride[axis];
      if (HWY_LIKELY(is_small)) {
        list_small(cells, moved, level, cell, count);
      } else {
        list_rows(cells, moved, level, cell, count);
      }
    }
  }

  /// For one or two cells on each axis. Decides without a branch which of them count.
  HWY_INLINE void list_small(const CellsView<D>& cells, std::uint32_t moved, const CellLevel<D>& level,
                             std::uint32_t first, const std::array<std::uint32_t, D>& count) {
    if (HWY_UNLIKELY(listed_ + (std::size_t{1} << D) > max_listed)) compare();
    std::array<std::uint32_t, D> has_two;  // 0 or 1
    std::array<std::uint32_t, D> step;     // to the second cell, if there is one
    for (int axis = 0; axis < D; ++axis) {
      has_two[axis] = count[axis] - 1;
      step[axis] = level.stride[axis] & (0U - has_two[axis]);
    }
    for (std::uint32_t corner = 0; corner < 1U << D; ++corner) {
      std::uint32_t cell = first;
      std::uint32_t counts = 1;
      for (int axis = 0; axis < D; ++axis) {
        if ((corner >> axis & 1U) == 0) continue;
        counts &= has_two[axis];
        cell += step[axis];
      }
      const std::uint32_t block = cells.first[cell];
      listed_tasks_[listed_] = {moved, block};
      listed_ += counts & static_cast<std::uint32_t>(block != no_slot);
      prefetch(block == no_slot ? 0 : block);
    }
  }

  void list_rows(const CellsView<D>& cells, std::uint32_t moved, const CellLevel<D>& level,
                 std::uint32_t first, const std::array<std::uint32_t, D>& count) {
    const std::uint32_t planes = D == 2 ? 1 : count[D - 1];
    for (std::uint32_t plane = 0; plane < planes; ++plane) {
      for (std::uint32_t row = 0; row < count[1]; ++row) {
        const std::uint32_t begin =
            first + row * level.stride[1] + (D == 2 ? 0 : plane * level.stride[D - 1]);
        for (std::uint32_t cell = begin; cell < begin + count[0]; ++cell) {
          if (cells.first[cell] != no_slot) list(moved, cells.first[cell]);
        }
      }
    }
  }

  HWY_INLINE void prefetch(std::uint32_t block) const {
    if (!prefetches_) return;
    hwy::Prefetch(&blocks_.heads[block]);
    for (int axis = 0; axis < D; ++axis) {
      hwy::Prefetch(blocks_.blocks[block].min[axis].data());
      hwy::Prefetch(blocks_.blocks[block].max[axis].data());
    }
  }

  /// Compares the listed boxes with all blocks of their chains.
  HWY_NOINLINE void compare() {
    std::size_t listed = work_.tests > sinks_.max_tests ? 0 : listed_;
    listed_ = 0;
    std::size_t found = found_count_;
    std::uint64_t tests = 0;
    std::uint64_t told = 0;
    std::uint64_t blocks = 0;
    for (std::size_t i = 0; i < listed;) {
      const std::uint32_t number = listed_tasks_[i].moved;
      const MovedBox<D>& moved = moved_[number];
      const BroadcastBox<D> before(moved.before);
      const BroadcastBox<D> now(moved.now);
      const std::uint32_t own_block = moved.slot / block_size;
      const std::uint32_t own_lane = 1U << moved.slot % block_size;
      const std::uint32_t filter_changed = moved.filter_changed ? 0xffffU : 0;
      do {
        std::uint32_t block = listed_tasks_[i].block;
        do {
          const BlockHead& head = blocks_.heads[block];
          tests += static_cast<std::uint64_t>(std::popcount(head.used));
          ++blocks;
          const std::uint32_t was = before.overlaps(blocks_.blocks[block]);
          const std::uint32_t is = now.overlaps(blocks_.blocks[block]);
          const std::uint32_t unknown = filter_changed | head.moving;
          const std::uint32_t own = own_lane & (0U - static_cast<std::uint32_t>(block == own_block));
          const std::uint32_t hits = ((was ^ is) | (is & unknown)) & ~own;
          found_[found] = {number, block, static_cast<std::uint16_t>(hits), static_cast<std::uint16_t>(is)};
          found += static_cast<std::size_t>(hits != 0);
          block = head.next;
          if (HWY_UNLIKELY(found == max_listed)) {
            take_hits(found);
            found = 0;
          }
        } while (HWY_UNLIKELY(block != no_slot));
        if (HWY_UNLIKELY(tests - told > many_tests)) {
          tell(sinks_.checkpoint, tests, told);
          if (work_.tests + tests > sinks_.max_tests) listed = i + 1;
        }
      } while (++i < listed && listed_tasks_[i].moved == number);
    }
    tell(sinks_.checkpoint, tests, told);
    found_count_ = found;
    work_ += {tests, blocks};
  }

  /// Takes the pairs of the hits: in each pass one of each block, until none is left. Where the hits are
  /// cannot be predicted, so there is no branch for a hit.
  HWY_NOINLINE void take_hits(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) hwy::Prefetch(blocks_.blocks[found_[i].block].id.data());
    while (count > 0) {
      if (*std::max_element(pair_counts_.begin(), pair_counts_.end()) + count > max_pairs) write();
      std::size_t left = 0;
      for (std::size_t i = 0; i < count; ++i) {
        const BlockHits found = found_[i];
        take(found, static_cast<std::uint32_t>(std::countr_zero(found.hits)));
        const auto rest = static_cast<std::uint16_t>(found.hits & (found.hits - 1));
        found_[left] = {found.moved, found.block, rest, found.is};
        left += static_cast<std::size_t>(rest != 0);
      }
      count = left;
    }
  }

  HWY_INLINE void take(const BlockHits& found, std::uint32_t lane) {
    const MovedBox<D>& moved = moved_[found.moved];
    const std::uint32_t id = index(moved.id);
    const std::uint32_t other = blocks_.blocks[found.block].id[lane];
    const std::uint32_t is_marked = blocks_.heads[found.block].moving >> lane & 1U;
    const std::uint32_t is_candidate =
        is_marked | static_cast<std::uint32_t>(moved.filter_changed) | std::uint32_t{sinks_.moves[other]};
    const std::size_t kind = is_candidate * candidate + (found.is >> lane & 1U);
    // Compilers make a branch of std::min().
    const std::uint32_t swap = (id ^ other) & (0U - static_cast<std::uint32_t>(other < id));
    pairs_[kind][pair_counts_[kind]] = {BoxId{id ^ swap}, BoxId{other ^ swap}};
    const std::uint32_t is_again =
        is_marked & static_cast<std::uint32_t>(sinks_.all_placed) & static_cast<std::uint32_t>(other > id);
    pair_counts_[kind] += static_cast<std::size_t>(other != id) & ~std::size_t{is_again};
  }

  void write() {
    for (std::size_t kind = 0; kind < kinds; ++kind) {
      PairSink& sink = kind == ended ? sinks_.ended : kind == begun ? sinks_.begun : sinks_.candidates;
      const std::size_t count = std::exchange(pair_counts_[kind], 0);
      std::copy_n(pairs_[kind].begin(), count, sink.room(count));
      sink.commit(count);
    }
  }

  core::ChangeWork finish() {
    compare();
    take_hits(std::exchange(found_count_, 0));
    write();
    return work_;
  }

  /// The kinds of pairs. The fourth is a candidate whose boxes overlap now.
  static constexpr std::size_t ended = 0;
  static constexpr std::size_t begun = 1;
  static constexpr std::size_t candidate = 2;
  static constexpr std::size_t kinds = 4;

  static constexpr std::size_t max_listed = 128;
  static constexpr std::size_t max_pairs = PairSink::max_room;
  static constexpr std::uint64_t many_tests = Checkpoint::max_tests / 64;

  BlocksView<D> blocks_;
  std::span<const MovedBox<D>> moved_;
  core::ChangeSinks sinks_;
  core::ChangeWork work_;
  bool prefetches_ = true;
  std::size_t listed_ = 0;
  std::array<BlockTask, max_listed> listed_tasks_;
  std::size_t found_count_ = 0;
  std::array<BlockHits, max_listed> found_;
  std::array<std::size_t, kinds> pair_counts_{};
  std::array<std::array<Pair, max_pairs>, kinds> pairs_;  // not yet written
};

template <int D>
void search_run(const Run<D>& run, std::size_t begin, std::size_t end, const MovedBox<D>& moved,
                const core::ChangeSinks& sinks) {
  const BroadcastBox<D> before(moved.before);
  const BroadcastBox<D> now(moved.now);
  const std::uint32_t both = moved.filter_changed ? ~0U : 0U;
  for (std::size_t at = begin; at < end; at += lanes) {
    const std::uint32_t was = bits_of(before.overlaps(run, at));
    const std::uint32_t is = bits_of(now.overlaps(run, at));
    std::uint32_t changed = (was ^ is) | (was & is & both);
    if (HWY_LIKELY(changed == 0)) continue;
    if (end - at < lanes) changed &= (1U << (end - at)) - 1;
    for (; changed != 0; changed &= changed - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(changed));
      const BoxId other = run.id[at + lane];
      if (other == moved.id) continue;
      if (moved.filter_changed || sinks.moves[index(other)] != 0)
        sinks.candidates.add(moved.id, other);
      else
        ((is >> lane & 1) != 0 ? sinks.begun : sinks.ended).add(moved.id, other);
    }
  }
}

template <int D>
core::ChangeWork find_in_blocks(const BlocksView<D>& blocks, std::span<const MovedBox<D>> moved,
                                std::span<const BlockTask> tasks, const core::ChangeSinks& sinks) {
  return MovedSearch<D>(blocks, moved, sinks).in_blocks(tasks);
}

template <int D>
core::ChangeWork find_in_cells(const CellsView<D>& cells, std::span<const MovedBox<D>> moved,
                               const core::ChangeSinks& sinks) {
  return MovedSearch<D>(cells.blocks, moved, sinks).in_cells(cells);
}

}  // namespace

// Names for the dispatch below, which cannot name templates.
constexpr auto& in_blocks_2 = find_in_blocks<2>;
constexpr auto& in_blocks_3 = find_in_blocks<3>;
constexpr auto& in_cells_2 = find_in_cells<2>;
constexpr auto& in_cells_3 = find_in_cells<3>;
constexpr auto& in_run_2 = search_run<2>;
constexpr auto& in_run_3 = search_run<3>;

}  // namespace broadside::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace broadside::kernels {

HWY_EXPORT(in_blocks_2);
HWY_EXPORT(in_blocks_3);
HWY_EXPORT(in_cells_2);
HWY_EXPORT(in_cells_3);
HWY_EXPORT(in_run_2);
HWY_EXPORT(in_run_3);

template <>
core::ChangeWork find_changes(const BlocksView<2>& blocks, std::span<const MovedBox<2>> moved,
                              std::span<const BlockTask> tasks, const core::ChangeSinks& sinks) {
  return HWY_DYNAMIC_DISPATCH(in_blocks_2)(blocks, moved, tasks, sinks);
}
template <>
core::ChangeWork find_changes(const BlocksView<3>& blocks, std::span<const MovedBox<3>> moved,
                              std::span<const BlockTask> tasks, const core::ChangeSinks& sinks) {
  return HWY_DYNAMIC_DISPATCH(in_blocks_3)(blocks, moved, tasks, sinks);
}
template <>
core::ChangeWork find_changes(const CellsView<2>& cells, std::span<const MovedBox<2>> moved,
                              const core::ChangeSinks& sinks) {
  return HWY_DYNAMIC_DISPATCH(in_cells_2)(cells, moved, sinks);
}
template <>
core::ChangeWork find_changes(const CellsView<3>& cells, std::span<const MovedBox<3>> moved,
                              const core::ChangeSinks& sinks) {
  return HWY_DYNAMIC_DISPATCH(in_cells_3)(cells, moved, sinks);
}
template <>
void find_changes(const Run<2>& run, std::size_t begin, std::size_t end, const MovedBox<2>& moved,
                  const core::ChangeSinks& sinks) {
  HWY_DYNAMIC_DISPATCH(in_run_2)(run, begin, end, moved, sinks);
}
template <>
void find_changes(const Run<3>& run, std::size_t begin, std::size_t end, const MovedBox<3>& moved,
                  const core::ChangeSinks& sinks) {
  HWY_DYNAMIC_DISPATCH(in_run_3)(run, begin, end, moved, sinks);
}

}  // namespace broadside::kernels
#endif  // HWY_ONCE
