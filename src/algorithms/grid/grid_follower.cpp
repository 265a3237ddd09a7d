// GridFollower: follows boxes in a hierarchical grid.
//
// Movers are taken in batches: each is moved to its new cell, with entries that cover its old and its new
// box, and then compared with the boxes near it. So of two movers, the later one sees both boxes of the
// earlier one, and no pair is missed. A mover and a box at rest are both known exactly, so only changes are
// written. Several threads share a batch: first they move its boxes, then they search, so that no entry
// changes while it is read.
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "broadside/sinks.hpp"

#include "algorithms/event_sinks.hpp"
#include "algorithms/followers.hpp"
#include "algorithms/grid/hierarchical_cells.hpp"
#include "core/filter_sink.hpp"
#include "core/grow.hpp"
#include "core/parallel.hpp"
#include "core/prefix_sum.hpp"

namespace broadside::algorithm {
namespace {

/// Movers per batch: few enough that they are still in the cache when the kernel searches, and enough that
/// several threads can share them, that their cache misses overlap, and that mostly one batch has all, so
/// that a pair of two movers need not be found twice. Independent of the number of threads, which must not
/// change the number of tests.
constexpr std::size_t batch = 16384;

/// Fewer movers are not put in order. More buckets would not stay in the first-level cache.
constexpr std::size_t min_ordered_movers = 64;
constexpr std::size_t max_order_buckets = 1024;

/// A mover takes as long as this many boxes of a search.
constexpr std::size_t boxes_per_mover = 2;

/// Queries to average over before the cells may be judged too slow.
constexpr std::uint64_t telling_queries = 1024;

constexpr BoxId id_of(BoxId id) { return id; }
template <int D>
BoxId id_of(const core::MovedBox<D>& box) {
  return box.id;
}

/// Prefetches for boxes some steps after number i: enough steps to hide the memory's latency.
template <int D, typename Boxes>
void prefetch_ahead(const HierarchicalCells<D>& cells, const Boxes& boxes, std::size_t i) {
  constexpr std::size_t steps = 8;
  if (i + 2 * steps < boxes.size()) cells.prefetch_slot(id_of(boxes[i + 2 * steps]));
  if (i + steps < boxes.size()) cells.prefetch_entry(id_of(boxes[i + steps]));
}

/// Cost of an update: O(changed boxes and boxes near them). Sometimes O(n): once the cells no longer suit the
/// boxes and searches have cost that much more than usual, the cells are laid out anew.
template <int D>
class GridFollower final : public Follower<D> {
 public:
  explicit GridFollower(const Settings& settings) : cells_(settings.optional_number("cell")) {}

  std::optional<Statistics> follow(const Change<D>& change, PairSink& begun, PairSink& ended) override {
    if (change.rebuild || needs_rebuild(change)) build(change);
    cells_.reserve(change.now.size());
    parallel_.start(change.workers, change.changed.size() * boxes_per_mover);
    if (parts_.size() < parallel_.range_count()) parts_.resize(parallel_.range_count());
    settle(change);
    core::ChangeWork work;
    std::uint64_t candidates = 0;
    std::size_t queries = 0;
    for (std::size_t at = 0; at < change.changed.size(); at += batch) {
      move(change,
           in_order_of_blocks(change.changed.subspan(at, std::min(batch, change.changed.size() - at))));
      search(change, begun, ended);
      for (const MoverRange& part : parts()) {
        work += part.work;
        candidates += part.candidates;
        queries += part.boxes.size();
      }
      if (work.tests > change.max_tests) break;
    }
    cells_.drop_stale();
    std::swap(moved_, moving_);
    weigh(work, queries);
    return Statistics{
        .tests = work.tests, .references = cells_.boxes(), .cells = cells_.cells(), .hits = candidates};
  }

  std::size_t bytes() const noexcept override {
    std::size_t bytes = cells_.bytes() + core::bytes_of(moved_, moving_, ordered_);
    for (const MoverRange& part : parts_) bytes += core::bytes_of(part.boxes, part.begun, part.ended);
    return bytes;
  }

 private:
  /// A range of a batch: its movers and what a search for them found.
  struct MoverRange {
    std::vector<core::MovedBox<D>> boxes;
    std::vector<Pair> begun;
    std::vector<Pair> ended;
    core::ChangeWork work;
    std::uint64_t candidates = 0;  // pairs tested in both frames
  };

  /// Settles the boxes that moved in the last update and do not move in this one.
  void settle(const Change<D>& change) {
    parallel_.for_ranges(moved_.size(), [&](core::Range range, std::size_t) {
      for (std::size_t i = range.begin; i < range.end; ++i) {
        const BoxId id = moved_[i];
        prefetch_ahead(cells_, moved_, i);
        const Box<D>& box = change.now[index(id)];
        if (change.flags[index(id)] == 0 || change.before[index(id)] == box) cells_.settle(id, box);
      }
    });
    moving_.clear();
  }

  /// The ids, roughly in the order of the blocks that have their boxes, so that movers that are searched for
  /// one after the other look at the same blocks. Left as they are if most blocks would be looked at only
  /// once.
  std::span<const BoxId> in_order_of_blocks(std::span<const BoxId> ids) {
    const std::size_t slots = cells_.slots();
    if (!cells_.are_revisited(ids.size()) || ids.size() < min_ordered_movers) return ids;
    const std::size_t buckets = std::min(max_order_buckets, std::bit_floor(ids.size()));
    const auto shift = static_cast<std::uint32_t>(std::bit_width(slots / buckets));
    // A box that was absent has any slot.
    const auto bucket_of = [&](BoxId id) {
      return std::min<std::size_t>(cells_.slot(id) >> shift, buckets - 1);
    };
    std::array<std::uint32_t, max_order_buckets> kept;
    const std::span<std::uint32_t> begins = std::span(kept).first(buckets);
    std::fill(begins.begin(), begins.end(), 0);
    for (const BoxId id : ids) ++begins[bucket_of(id)];
    core::prefix_sum(begins, buckets);
    core::resize_by_eighths(ordered_, ids.size());
    for (const BoxId id : ids) ordered_[begins[bucket_of(id)]++] = id;
    return ordered_;
  }

  /// Lists these boxes in parts_ and moves them: first several threads the boxes that stay in their cells,
  /// then one thread the others.
  void move(const Change<D>& change, std::span<const BoxId> ids) {
    parallel_.for_numbered_ranges(ids.size(), [&](std::size_t number, core::Range range, std::size_t) {
      std::vector<core::MovedBox<D>>& boxes = parts_[number].boxes;
      boxes.clear();
      append_moved(change, ids.subspan(range.begin, range.size()), boxes);
      if (parallel_.workers() == 1) return;
      for (core::MovedBox<D>& box : boxes) cells_.move_within_cell(box);
    });
    for (MoverRange& part : parts()) {
      for (std::size_t i = 0; i < part.boxes.size(); ++i) {
        core::MovedBox<D>& box = part.boxes[i];
        prefetch_ahead(cells_, part.boxes, i);
        if (box.slot == kernels::no_slot) cells_.move(box);
        if (box.is_present) moving_.push_back(box.id);
      }
    }
  }

  /// Finds the events of the boxes in parts_.
  void search(const Change<D>& change, PairSink& begun, PairSink& ended) {
    const auto search = [&](MoverRange& part, PairSink& its_begun, PairSink& its_ended, std::size_t worker) {
      EventSinks<D> events(change, its_begun, its_ended, parallel_.checkpoint(worker),
                           change.changed.size() <= batch);
      part.work = kernels::find_changes(cells_.view(change.changed.size()),
                                        std::span<const core::MovedBox<D>>(part.boxes), events.sinks());
      events.flush();
      part.candidates = events.candidates();
    };
    if (parallel_.workers() == 1) return search(parts_.front(), begun, ended, 0);
    // A sink with a limit must count while threads search, not after they have filled their lists.
    const core::FilterSink* const limit = core::FilterSink::of(begun);
    parallel_.for_ranges(parts().size(), [&](core::Range range, std::size_t worker) {
      for (MoverRange& part : parts().subspan(range.begin, range.size())) {
        part.begun.clear();
        part.ended.clear();
        PairCollector its_begun(part.begun);
        PairCollector its_ended(part.ended);
        const auto limited = limit != nullptr ? limit->onto(its_begun) : nullptr;
        search(part, limited ? *limited : static_cast<PairSink&>(its_begun), its_ended, worker);
        if (limited) limited->flush();
        its_begun.flush();
        its_ended.flush();
      }
    });
    for (const MoverRange& part : parts()) {
      (limit != nullptr ? limit->target() : begun).put(part.begun);
      ended.put(part.ended);
    }
  }

  /// Whether the cells were laid out for far more or fewer boxes than there are, or have proved slow.
  bool needs_rebuild(const Change<D>& change) const {
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

  void build(const Change<D>& change) {
    cells_.build(change.before, change.now);
    built_for_ =
        static_cast<std::size_t>(std::count_if(change.now.begin(), change.now.end(), is_present<D, float>));
    moved_.clear();
    usual_blocks_ = 0;
    first_queries_ = 0;
    excess_ = 0;
  }

  void weigh(const core::ChangeWork& work, std::size_t queries) {
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

  /// The parts of this update.
  std::span<MoverRange> parts() { return std::span(parts_).first(parallel_.range_count()); }

  HierarchicalCells<D> cells_;
  std::vector<BoxId> moved_;  // boxes whose entries also cover where they were
  std::vector<BoxId> moving_;
  std::vector<BoxId> ordered_;  // the changed boxes of a batch
  core::Parallel parallel_;
  std::vector<MoverRange> parts_;  // by range of a batch
  std::size_t built_for_ = 0;
  double usual_blocks_ = 0;  // per query, since the cells were laid out
  std::uint64_t first_queries_ = 0;
  double excess_ = 0;  // blocks looked at beyond what is usual
};

}  // namespace

template <int D>
std::unique_ptr<Follower<D>> make_grid_follower(const Settings& settings) {
  return std::make_unique<GridFollower<D>>(settings);
}

template std::unique_ptr<Follower<2>> make_grid_follower(const Settings&);
template std::unique_ptr<Follower<3>> make_grid_follower(const Settings&);

}  // namespace broadside::algorithm
