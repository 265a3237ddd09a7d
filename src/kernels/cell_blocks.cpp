// The search in levels of cells, written once for every instruction set.
//
// Each step is taken for many queries before the next one, so that none waits for memory: the blocks in
// question are listed and called for; a box and where it was before are compared with the sixteen of each
// block at once, and the blocks with hits listed, without a branch; then these are written. What overlaps one
// of the two and not the other is an event, so that nothing is written of the many pairs that go on.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/cell_blocks.cpp"
#include "kernels/cell_blocks.hpp"

#include <array>
#include <bit>
#include <utility>

#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/broadcast_box.hpp"

HWY_BEFORE_NAMESPACE();
namespace broadside::kernels::HWY_NAMESPACE {
namespace {
/// What is asked of a block: `Changes` or `Later`. `hits()` gives a bit for each of its boxes that counts,
/// and `write()` writes those.
template <int D>
struct Changes {
  struct Found {
    std::uint32_t query;
    std::uint32_t block;
    std::uint16_t begun;
    std::uint16_t ended;
    std::uint16_t candidates;
  };

  HWY_INLINE bool hits(const MovedBox<D>& query, const BlockHead& head, const Block<D>& block,
                       Found& found) const {
    const std::uint32_t was = BroadcastBox<D>(query.before).overlaps(block);
    const std::uint32_t is = BroadcastBox<D>(query.now).overlaps(block);
    const std::uint32_t own = query.slot / block_size == found.block ? 1U << query.slot % block_size : 0;
    const std::uint32_t unknown = query.filter_changed ? 0xffffU : head.moving;
    const std::uint32_t candidates = (was | is) & unknown & ~own;
    const std::uint32_t begun = is & ~was & ~unknown;
    const std::uint32_t ended = was & ~is & ~unknown;
    found.begun = static_cast<std::uint16_t>(begun);
    found.ended = static_cast<std::uint16_t>(ended);
    found.candidates = static_cast<std::uint16_t>(candidates);
    return (begun | ended | candidates) != 0;
  }

  void write(BoxId id, const Block<D>& block, const Found& found) const {
    write(id, block, found.begun, sinks.begun);
    write(id, block, found.ended, sinks.ended);
    write(id, block, found.candidates, sinks.candidates);
  }

  void write(BoxId id, const Block<D>& block, std::uint32_t bits, PairSink& sink) const {
    for (; bits != 0; bits &= bits - 1) {
      const BoxId other{block.id[static_cast<std::size_t>(std::countr_zero(bits))]};
      if (other != id) (sinks.moves[index(other)] != 0 ? sinks.candidates : sink).add(id, other);
    }
  }

  static const Box<D>& near(const MovedBox<D>& query) { return query.bounds; }

  const CellSinks& sinks;
};

template <int D>
struct Later {
  struct Found {
    std::uint32_t query;
    std::uint32_t block;
    std::uint32_t hits;
  };

  HWY_INLINE bool hits(const MovedBox<D>& query, const BlockHead&, const Block<D>& block,
                       Found& found) const {
    found.hits = BroadcastBox<D>(query.now).overlaps(block);
    return found.hits != 0;
  }

  void write(BoxId id, const Block<D>& block, const Found& found) const {
    for (std::uint32_t bits = found.hits; bits != 0; bits &= bits - 1) {
      const BoxId other{block.id[static_cast<std::size_t>(std::countr_zero(bits))]};
      if (id < other) pairs.add(id, other);
    }
  }

  static const Box<D>& near(const MovedBox<D>& query) { return query.now; }

  PairSink& pairs;
};

template <int D, typename Question>
class Search {
 public:
  Search(const CellsView<D>& cells, std::span<const MovedBox<D>> queries, const Question& question)
      : cells_(cells), queries_(queries), question_(question) {}

  CellWork run() {
    for (std::uint32_t i = 0; i < queries_.size(); ++i) {
      if (HWY_UNLIKELY(queries_[i].is_far)) {
        list(i, queries_[i].before);
        list(i, queries_[i].now);
      } else {
        list(i, Question::near(queries_[i]));
      }
    }
    compare();
    return work_;
  }

 private:
  struct Entry {
    std::uint32_t query;
    std::uint32_t block;
  };
  using Found = typename Question::Found;

  /// Lists the first blocks of all cells in which there may be boxes that overlap `box`.
  HWY_INLINE void list(std::uint32_t query, const Box<D>& box) {
    for (const CellLevel<D>& level : cells_.levels) {
      if (level.boxes == 0) continue;
      std::array<std::uint32_t, D> begin;
      std::array<std::uint32_t, D> count;
      bool is_small = true;
      for (int axis = 0; axis < D; ++axis) {
        begin[axis] = level.on_axis(axis, box.min[axis] - level.extent[axis]);
        count[axis] = level.on_axis(axis, box.max[axis]) - begin[axis] + 1;
        is_small &= count[axis] <= 2;
      }
      std::uint32_t cell = level.first_cell;
      for (int axis = 0; axis < D; ++axis) cell += begin[axis] * level.stride[axis];
      if (HWY_LIKELY(is_small)) {
        list_small(query, level, cell, count);
      } else {
        list_rows(query, level, cell, count);
      }
    }
  }

  /// Two cells or one on each axis: which of them count is told without a branch.
  HWY_INLINE void list_small(std::uint32_t query, const CellLevel<D>& level, std::uint32_t cell,
                             const std::array<std::uint32_t, D>& count) {
    if (HWY_UNLIKELY(listed_ + (std::size_t{1} << D) > most_listed)) compare();
    for (std::uint32_t corner = 0; corner < 1U << D; ++corner) {
      std::uint32_t place = cell;
      bool counts = true;
      for (int axis = 0; axis < D; ++axis) {
        const std::uint32_t step = corner >> axis & 1U;
        counts &= step < count[axis];
        place += step < count[axis] ? step * level.stride[axis] : 0;
      }
      const std::uint32_t block = cells_.first[place];
      entries_[listed_] = {query, block};
      listed_ += static_cast<std::size_t>(counts & (block != no_slot));
      call_for(block == no_slot ? 0 : block);
    }
  }

  void list_rows(std::uint32_t query, const CellLevel<D>& level, std::uint32_t cell,
                 const std::array<std::uint32_t, D>& count) {
    const std::uint32_t planes = D == 2 ? 1 : count[D - 1];
    for (std::uint32_t plane = 0; plane < planes; ++plane) {
      for (std::uint32_t row = 0; row < count[1]; ++row) {
        const std::uint32_t begin = cell + row * level.stride[1] + (D == 2 ? 0 : plane * level.stride[D - 1]);
        for (std::uint32_t place = begin; place < begin + count[0]; ++place) {
          const std::uint32_t block = cells_.first[place];
          if (block == no_slot) continue;
          if (listed_ == most_listed) compare();
          entries_[listed_++] = {query, block};
          call_for(block);
        }
      }
    }
  }

  /// Has the block's bounds on their way before they are needed.
  HWY_INLINE void call_for(std::uint32_t block) const {
    hwy::Prefetch(&cells_.heads[block]);
    for (int axis = 0; axis < D; ++axis) {
      hwy::Prefetch(cells_.blocks[block].min[axis].data());
      hwy::Prefetch(cells_.blocks[block].max[axis].data());
    }
  }

  /// Compares what is listed.
  HWY_NOINLINE void compare() {
    const BlockHead* const heads = cells_.heads;
    const Block<D>* const blocks = cells_.blocks;
    const MovedBox<D>* const queries = queries_.data();
    const std::size_t listed = std::exchange(listed_, 0);
    std::size_t found = 0;
    std::uint64_t tests = 0;
    std::uint64_t looked_at = 0;
    for (std::size_t i = 0; i < listed; ++i) {
      const std::uint32_t query = entries_[i].query;
      std::uint32_t block = entries_[i].block;
      do {
        const BlockHead& head = heads[block];
        tests += static_cast<std::uint64_t>(std::popcount(head.used));
        ++looked_at;
        const std::uint32_t next = head.next;
        found_[found].query = query;
        found_[found].block = block;
        found += static_cast<std::size_t>(question_.hits(queries[query], head, blocks[block], found_[found]));
        if (HWY_UNLIKELY(found == most_listed)) write(std::exchange(found, 0));
        block = next;
      } while (HWY_UNLIKELY(block != no_slot));
    }
    write(found);
    work_.tests += tests;
    work_.blocks += looked_at;
  }

  void write(std::size_t found) {
    for (std::size_t i = 0; i < found; ++i)
      question_.write(queries_[found_[i].query].id, cells_.blocks[found_[i].block], found_[i]);
  }

  static constexpr std::size_t most_listed = 128;

  const CellsView<D>& cells_;
  std::span<const MovedBox<D>> queries_;
  Question question_;
  CellWork work_;
  std::size_t listed_ = 0;
  std::array<Entry, most_listed> entries_;
  std::array<Found, most_listed> found_;
};

CellWork find_changes_2d(const CellsView<2>& cells, std::span<const MovedBox<2>> queries,
                         const CellSinks& sinks) {
  return Search<2, Changes<2>>(cells, queries, {sinks}).run();
}
CellWork find_changes_3d(const CellsView<3>& cells, std::span<const MovedBox<3>> queries,
                         const CellSinks& sinks) {
  return Search<3, Changes<3>>(cells, queries, {sinks}).run();
}
CellWork find_later_2d(const CellsView<2>& cells, std::span<const MovedBox<2>> queries, PairSink& pairs) {
  return Search<2, Later<2>>(cells, queries, {pairs}).run();
}
CellWork find_later_3d(const CellsView<3>& cells, std::span<const MovedBox<3>> queries, PairSink& pairs) {
  return Search<3, Later<3>>(cells, queries, {pairs}).run();
}

}  // namespace
}  // namespace broadside::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace broadside::kernels {

HWY_EXPORT(find_changes_2d);
HWY_EXPORT(find_changes_3d);
HWY_EXPORT(find_later_2d);
HWY_EXPORT(find_later_3d);

template <>
CellWork find_changes(const CellsView<2>& cells, std::span<const MovedBox<2>> queries,
                      const CellSinks& sinks) {
  return HWY_DYNAMIC_DISPATCH(find_changes_2d)(cells, queries, sinks);
}

template <>
CellWork find_changes(const CellsView<3>& cells, std::span<const MovedBox<3>> queries,
                      const CellSinks& sinks) {
  return HWY_DYNAMIC_DISPATCH(find_changes_3d)(cells, queries, sinks);
}

template <>
CellWork find_later(const CellsView<2>& cells, std::span<const MovedBox<2>> queries, PairSink& pairs) {
  return HWY_DYNAMIC_DISPATCH(find_later_2d)(cells, queries, pairs);
}

template <>
CellWork find_later(const CellsView<3>& cells, std::span<const MovedBox<3>> queries, PairSink& pairs) {
  return HWY_DYNAMIC_DISPATCH(find_later_3d)(cells, queries, pairs);
}

}  // namespace broadside::kernels
#endif
