// The tracker of the hierarchical grid.
//
// Boxes are taken one after the other: each is moved to its new cell, its entry made to cover where it was
// and where it is, and then compared with what is near. So of two that move, the later one sees all of the
// earlier one, and no pair is missed; of one that moves and one that rests, both boxes are known exactly, and
// only a difference is written.
#include "algorithms/hierarchical_grid/tracker.hpp"

#include <algorithm>
#include <utility>

#include "algorithms/hierarchical_grid/candidate_sink.hpp"
#include "interface/moved_boxes.hpp"

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
    const Box<D>& box = change.now[index(id)];
    if (change.flags[index(id)] == 0 || change.before[index(id)] == box) cells_.settle(id, box);
  }
  kernels::CellWork work;
  std::size_t count = 0;
  for (std::size_t at = 0; at < change.changed.size(); at += batch) {
    boxes_.clear();
    const std::size_t size = std::min(batch, change.changed.size() - at);
    core::append_moved(change, change.changed.subspan(at, size), boxes_, all);
    for (core::MovedBox<D>& box : boxes_) file(box);
    const kernels::CellWork done =
        kernels::find_changes(cells_.view(), std::span<const core::MovedBox<D>>(boxes_), sinks);
    work.tests += done.tests;
    work.blocks += done.blocks;
    count += boxes_.size();
  }
  cells_.drop_stale();
  std::swap(moved_, moving_);
  weigh(work, count);
  return {.tests = work.tests, .references = cells_.boxes(), .cells = cells_.cells()};
}

/// Moves one box in the cells, so that its entry covers where it was and where it is.
template <int D>
void HierarchicalGridTracker<D>::file(core::MovedBox<D>& box) {
  if (box.is_present) moving_.push_back(box.id);
  if (!box.is_present) {
    cells_.remove(box.id, box.before);
    return;
  }
  if (box.was_present) {
    for (int axis = 0; axis < D; ++axis) {
      const float extents =
          box.before.max[axis] - box.before.min[axis] + (box.now.max[axis] - box.now.min[axis]);
      box.is_far |= box.bounds.max[axis] - box.bounds.min[axis] - extents > cells_.smallest_cell()[axis];
    }
    cells_.move(box.id, box.before, box.now, box.bounds);
  } else {
    cells_.add(box.id, box.now);
  }
  box.slot = cells_.place(box.id);
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
  return cells_.bytes() + (moved_.capacity() + moving_.capacity()) * sizeof(BoxId) +
         boxes_.capacity() * sizeof(core::MovedBox<D>);
}

template class HierarchicalGridTracker<2>;
template class HierarchicalGridTracker<3>;

}  // namespace broadside::own
