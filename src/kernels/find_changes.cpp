// Compares moved boxes with kept ones, written once for every instruction set.
//
// In blocks, each step runs for many boxes before the next one, so that none waits for memory. The first step
// lists and prefetches the blocks in question. The second compares a box, now and before, with the sixteen
// boxes of each block at once, and lists the blocks with hits without a branch. The third writes their pairs.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/find_changes.cpp"
#include "kernels/find_changes.hpp"

#include <bit>
#include <utility>

#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/broadcast_box.hpp"

HWY_BEFORE_NAMESPACE();
namespace broadside::kernels::HWY_NAMESPACE {
namespace {

/// A block in which a moved box has hits, and its hits, as bits.
struct BlockHits {
  std::uint32_t moved;
  std::uint32_t block;
  std::uint16_t begun;
  std::uint16_t ended;
  std::uint16_t candidates;
};

template <int D>
class MovedSearch {
 public:
  MovedSearch(const BlocksView<D>& blocks, std::span<const MovedBox<D>> moved, const core::ChangeSinks& sinks)
      : blocks_(blocks), moved_(moved), sinks_(sinks) {}

  core::ChangeWork in_blocks(std::span<const BlockTask> tasks) {
    for (const BlockTask& task : tasks) list(task.moved, task.block);
    compare();
    return work_;
  }

  core::ChangeWork in_cells(const CellsView<D>& cells) {
    for (std::uint32_t i = 0; i < moved_.size(); ++i) {
      if (HWY_UNLIKELY(moved_[i].is_far)) {
        list(cells, i, moved_[i].before);
        list(cells, i, moved_[i].now);
      } else {
        list(cells, i, moved_[i].bounds);
      }
    }
    compare();
    return work_;
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
    for (std::uint32_t corner = 0; corner < 1U << D; ++corner) {
      std::uint32_t cell = first;
      bool counts = true;
      for (int axis = 0; axis < D; ++axis) {
        const std::uint32_t step = corner >> axis & 1U;
        counts &= step < count[axis];
        cell += step < count[axis] ? step * level.stride[axis] : 0;
      }
      const std::uint32_t block = cells.first[cell];
      listed_tasks_[listed_] = {moved, block};
      listed_ += static_cast<std::size_t>(counts & (block != no_slot));
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
    hwy::Prefetch(&blocks_.heads[block]);
    for (int axis = 0; axis < D; ++axis) {
      hwy::Prefetch(blocks_.blocks[block].min[axis].data());
      hwy::Prefetch(blocks_.blocks[block].max[axis].data());
    }
  }

  /// Compares the listed boxes with all blocks of their chains.
  HWY_NOINLINE void compare() {
    const std::size_t listed = work_.tests > sinks_.max_tests ? 0 : listed_;
    listed_ = 0;
    std::size_t found = 0;
    std::uint64_t tests = 0;
    std::uint64_t told = 0;
    std::uint64_t blocks = 0;
    for (std::size_t i = 0; i < listed; ++i) {
      const MovedBox<D>& moved = moved_[listed_tasks_[i].moved];
      const BroadcastBox<D> before(moved.before);
      const BroadcastBox<D> now(moved.now);
      std::uint32_t block = listed_tasks_[i].block;
      do {
        const BlockHead& head = blocks_.heads[block];
        tests += static_cast<std::uint64_t>(std::popcount(head.used));
        ++blocks;
        const std::uint32_t next = head.next;
        const std::uint32_t was = before.overlaps(blocks_.blocks[block]);
        const std::uint32_t is = now.overlaps(blocks_.blocks[block]);
        const std::uint32_t own = moved.slot / block_size == block ? 1U << moved.slot % block_size : 0;
        const std::uint32_t unknown = moved.filter_changed ? 0xffffU : head.moving;
        const std::uint32_t candidates = (was | is) & unknown & ~own;
        const std::uint32_t begun = is & ~was & ~unknown;
        const std::uint32_t ended = was & ~is & ~unknown;
        found_[found] = {listed_tasks_[i].moved, block, static_cast<std::uint16_t>(begun),
                         static_cast<std::uint16_t>(ended), static_cast<std::uint16_t>(candidates)};
        found += static_cast<std::size_t>((begun | ended | candidates) != 0);
        if (HWY_UNLIKELY(found == max_listed)) write(std::exchange(found, 0));
        block = next;
      } while (HWY_UNLIKELY(block != no_slot));
      if (HWY_UNLIKELY(tests - told > many_tests)) {
        tell(sinks_.checkpoint, tests, told);
        if (work_.tests + tests > sinks_.max_tests) break;
      }
    }
    tell(sinks_.checkpoint, tests, told);
    write(found);
    work_ += {tests, blocks};
  }

  void write(std::size_t count) {
    const std::span<const BlockHits> all = std::span(found_).first(count);
    for (const BlockHits& found : all) hwy::Prefetch(blocks_.blocks[found.block].id.data());
    for (const BlockHits& found : all) {
      for (std::uint32_t bits = found.begun | found.ended | found.candidates; bits != 0; bits &= bits - 1)
        hwy::Prefetch(&sinks_.moves[blocks_.blocks[found.block].id[std::countr_zero(bits)]]);
    }
    for (const BlockHits& found : all) {
      write(found, found.begun, sinks_.begun);
      write(found, found.ended, sinks_.ended);
      write(found, found.candidates, sinks_.candidates);
    }
  }

  void write(const BlockHits& found, std::uint32_t bits, PairSink& sink) {
    const BoxId id = moved_[found.moved].id;
    for (; bits != 0; bits &= bits - 1) {
      const std::uint32_t other = blocks_.blocks[found.block].id[std::countr_zero(bits)];
      if (other != index(id)) (sinks_.moves[other] != 0 ? sinks_.candidates : sink).add(id, BoxId{other});
    }
  }

  static constexpr std::size_t max_listed = 128;
  static constexpr std::uint64_t many_tests = Checkpoint::max_tests / 64;

  BlocksView<D> blocks_;
  std::span<const MovedBox<D>> moved_;
  core::ChangeSinks sinks_;
  core::ChangeWork work_;
  std::size_t listed_ = 0;
  std::array<BlockTask, max_listed> listed_tasks_;
  std::array<BlockHits, max_listed> found_;
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
