// The grid's tracker.
//
// Boxes are taken one after the other: each is moved to its new cell, its entry made to cover where it was
// and where it is, and then compared with what is near. So of two that move, the later one sees all of the
// earlier one, and no pair is missed; of one that moves and one that rests, both boxes are known exactly, and
// only a difference is written.
#include "algorithms/grid/tracker.hpp"

#include <algorithm>
#include <utility>

#include "interface/event_sinks.hpp"
#include "interface/moved_boxes.hpp"

namespace broadside::algorithm {
namespace {

/// Boxes that are moved before the kernel searches for them: enough to make up for the call, and few enough
/// that what was written is still in the cache.
constexpr std::size_t batch = 64;

/// Queries to average over before the cells are judged too slow.
constexpr std::uint64_t telling_queries = 1024;

}  // namespace

template <int D>
void GridTracker<D>::update_valid(const Change<D>& change, PairSink& begun, PairSink& ended) {
  core::EventSinks<D> events(change, begun, ended);
  const Statistics statistics = follow(change, events.sinks(), false);
  events.flush();
  this->count(statistics);
}

template <int D>
Statistics GridTracker<D>::candidates(const Change<D>& change, PairSink& pairs) {
  return follow(change, {.begun = pairs, .ended = pairs, .candidates = pairs, .moves = change.flags.data()},
                true);
}

template <int D>
Statistics GridTracker<D>::follow(const Change<D>& change, const core::ChangeSinks& sinks, bool every_pair) {
  if (change.rebuild || needs_rebuild(change)) build(change);
  cells_.reserve(change.now.size());
  moving_.clear();
  for (const BoxId id : moved_) {
    const Box<D>& box = change.now[index(id)];
    if (change.flags[index(id)] == 0 || change.before[index(id)] == box) cells_.settle(id, box);
  }
  core::ChangeWork work;
  std::size_t queries = 0;
  for (std::size_t at = 0; at < change.changed.size(); at += batch) {
    boxes_.clear();
    core::append_moved(change, change.changed.subspan(at, std::min(batch, change.changed.size() - at)),
                       boxes_, every_pair);
    for (core::MovedBox<D>& box : boxes_) {
      cells_.move(box);
      if (box.is_present) moving_.push_back(box.id);
    }
    work += kernels::find_changes(cells_.view(), std::span<const core::MovedBox<D>>(boxes_), sinks);
    queries += boxes_.size();
  }
  cells_.drop_stale();
  std::swap(moved_, moving_);
  weigh(work, queries);
  return {.tests = work.tests, .references = cells_.boxes(), .cells = cells_.cells()};
}

/// Whether the cells were laid out for far more or fewer boxes than there are, or are found to be slow.
template <int D>
bool GridTracker<D>::needs_rebuild(const Change<D>& change) const {
  std::size_t boxes = cells_.boxes();
  // Arrivals and departures are counted only where enough boxes changed to matter.
  if (change.changed.size() > boxes / 4) {
    for (const BoxId id : change.changed) {
      const bool was = is_present(change.before[index(id)]);
      const bool is = is_present(change.now[index(id)]);
      if (was != is) boxes = was ? boxes - 1 : boxes + 1;
    }
  }
  constexpr std::size_t few = 64;
  if (boxes > 4 * built_for_ + few || boxes + few < built_for_ / 8) return true;
  return excess_ > static_cast<double>(boxes + few);
}

template <int D>
void GridTracker<D>::build(const Change<D>& change) {
  cells_.build(change.before, change.now);
  built_for_ = static_cast<std::size_t>(std::ranges::count_if(change.now, is_present<D, float>));
  moved_.clear();
  usual_blocks_ = 0;
  first_queries_ = 0;
  excess_ = 0;
}

template <int D>
void GridTracker<D>::weigh(const core::ChangeWork& work, std::size_t queries) {
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
std::size_t GridTracker<D>::algorithm_bytes() const noexcept {
  return cells_.bytes() + (moved_.capacity() + moving_.capacity()) * sizeof(BoxId) +
         boxes_.capacity() * sizeof(core::MovedBox<D>);
}

template class GridTracker<2>;
template class GridTracker<3>;

}  // namespace broadside::algorithm
