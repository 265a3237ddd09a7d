// The tracker of the hierarchical grid.
//
// Boxes are taken one after the other: each is moved to its new cell, its entry made to cover where it was
// and where it is, and then compared with what is near. So of two that move, the later one sees all of the
// earlier one, and no pair is missed; of one that moves and one that rests, both boxes are known exactly, and
// only a difference is written.
#include "algorithms/hierarchical_grid/tracker.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "algorithms/hierarchical_grid/candidate_sink.hpp"
#include "kernels/nowhere.hpp"

namespace broadside::own {
namespace {

/// Boxes that are filed before they are searched for: so many that calling a kernel costs little, so few that
/// what was written is still near.
constexpr std::size_t batch = 64;

/// From so many queries is told how many blocks are usual.
constexpr std::uint64_t telling_queries = 1024;

}  // namespace

template <int D>
void HierarchicalGridTracker<D>::update_valid(const Change<D>& change, PairSink& begun, PairSink& ended) {
  core::CandidateSink<D> open(change, begun, ended);
  // Without filters, what overlaps a box at rest is all there is to ask.
  const bool by_boxes = change.filters_now.empty();
  const Statistics statistics = follow(change,
                                       {.begun = by_boxes ? begun : open,
                                        .ended = by_boxes ? ended : open,
                                        .candidates = open,
                                        .moves = change.flags.data()},
                                       false);
  open.flush();
  this->count(statistics);
}

template <int D>
Statistics HierarchicalGridTracker<D>::candidates(const Change<D>& change, PairSink& pairs) {
  return follow(change, {.begun = pairs, .ended = pairs, .candidates = pairs, .moves = change.flags.data()},
                true);
}

template <int D>
Statistics HierarchicalGridTracker<D>::follow(const Change<D>& change, const kernels::CellSinks& sinks,
                                              bool all) {
  if (change.rebuild || !suits(change)) build(change);
  cells_.reserve(change.now.size());
  moving_.clear();
  for (const BoxId id : moved_) {
    if (change.flags[index(id)] == 0) cells_.settle(id, change.now[index(id)]);
  }
  kernels::CellWork work;
  std::array<kernels::CellQuery<D>, batch> queries;
  for (std::size_t at = 0; at < change.changed.size();) {
    const std::size_t end = std::min(at + batch, change.changed.size());
    std::size_t count = 0;
    for (; at < end; ++at) {
      const kernels::CellQuery<D> query = file(change, change.changed[at], all);
      if (is_present(query.bounds)) queries[count++] = query;
    }
    const kernels::CellWork done =
        kernels::find_changes<D>(cells_.view(), std::span(queries).first(count), sinks);
    work.tests += done.tests;
    work.blocks += done.blocks;
  }
  cells_.drop_stale();
  std::swap(moved_, moving_);
  weigh(work, change.changed.size());
  return {.tests = work.tests, .references = cells_.boxes(), .cells = cells_.cells()};
}

/// Files one box, and says what is to be asked for it; bounds that are not present if nothing.
template <int D>
kernels::CellQuery<D> HierarchicalGridTracker<D>::file(const Change<D>& change, BoxId id, bool all) {
  const Box<D>& before = change.before[index(id)];
  const Box<D>& now = change.now[index(id)];
  const bool was = is_present(before);
  const bool is = is_present(now);
  kernels::CellQuery<D> query{.before = was ? before : kernels::nowhere<D>(),
                              .now = is ? now : kernels::nowhere<D>(),
                              .bounds = is ? now : before,
                              .id = id};
  if (is) moving_.push_back(id);
  if (was && is) {
    for (int axis = 0; axis < D; ++axis) {
      const float both = before.max[axis] - before.min[axis] + (now.max[axis] - now.min[axis]);
      query.bounds.min[axis] = std::min(before.min[axis], now.min[axis]);
      query.bounds.max[axis] = std::max(before.max[axis], now.max[axis]);
      query.is_far |= query.bounds.max[axis] - query.bounds.min[axis] - both > cells_.smallest_cell()[axis];
    }
    query.all = all || (!change.filters_now.empty() &&
                        change.filters_now[index(id)] != change.filters_before[index(id)]);
    cells_.move(id, before, now, query.bounds);
  } else if (is) {
    cells_.add(id, now);
  } else if (was) {
    cells_.remove(id, before);
  }
  if (is) query.place = cells_.place(id);
  return query;
}

/// Whether the cells were laid out for about as many boxes as there are, and are not found to be slow.
template <int D>
bool HierarchicalGridTracker<D>::suits(const Change<D>& change) const {
  std::size_t boxes = cells_.boxes();
  // Unless so many changed that it may matter, nobody counts who came and went.
  if (change.changed.size() > boxes / 4) {
    for (const BoxId id : change.changed) {
      const bool was = is_present(change.before[index(id)]);
      const bool is = is_present(change.now[index(id)]);
      if (was != is) boxes = was ? boxes - 1 : boxes + 1;
    }
  }
  constexpr std::size_t few = 64;
  if (boxes > 4 * built_for_ + few || boxes + few < built_for_ / 8) return false;
  return excess_ <= static_cast<double>(boxes + few);
}

template <int D>
void HierarchicalGridTracker<D>::build(const Change<D>& change) {
  cells_.build(change.before, change.now);
  built_for_ = static_cast<std::size_t>(std::ranges::count_if(change.now, is_present<D, float>));
  moved_.clear();
  usual_blocks_ = 0;
  first_queries_ = 0;
  excess_ = 0;
}

template <int D>
void HierarchicalGridTracker<D>::weigh(const kernels::CellWork& work, std::size_t queries) {
  const auto blocks = static_cast<double>(work.blocks);
  const auto count = static_cast<double>(queries);
  if (first_queries_ < telling_queries) {
    const auto before = static_cast<double>(first_queries_);
    usual_blocks_ = queries == 0 ? usual_blocks_ : (usual_blocks_ * before + blocks) / (before + count);
    first_queries_ += queries;
  } else {
    excess_ += std::max(0.0, blocks - 2 * usual_blocks_ * count);
  }
}

template <int D>
std::size_t HierarchicalGridTracker<D>::algorithm_bytes() const noexcept {
  return cells_.bytes() + (moved_.capacity() + moving_.capacity()) * sizeof(BoxId);
}

template class HierarchicalGridTracker<2>;
template class HierarchicalGridTracker<3>;

}  // namespace broadside::own
