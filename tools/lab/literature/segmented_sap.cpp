// Tracy, Buss and Woods 2009, "Efficient Large-Scale Sweep and Prune Methods with AABB Insertion and Removal"
// (IEEE VR): sweep and prune in the regions of a grid. A box is in each region that it touches; each region
// has a segmented interval list (interval_list.hpp) for each axis. A box that moves a little slides past the
// adjacent end points, and each end point of the other kind that it passes is a candidate pair. A box that is
// added, removed or jumps is inserted or erased: the list of the first axis gives its candidates. If a large
// share of a region's boxes come or go in one frame, they form a batch: lists are merged or thinned in one
// pass, and one sweep finds the pairs of the batch.
//
// Differences: in motion, the Tracker, which accepts an event twice, removes pairs found in several regions;
// a search from nothing reports a pair in the region of its greater minima. The paper counts pairs in a
// table. A search from nothing, which is one batch into empty lists, sorts only the axis that it sweeps. A
// sample determines the grid's size: fewer regions than asked for if boxes would be in too many. Segments are
// longer in long lists: the square root of their length.
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lab/literature/interval_list.hpp"
#include "lab/literature/literature.hpp"
#include "lab/literature/radix_sort.hpp"
#include "lab/literature/regions.hpp"

namespace broadside::lab::literature {
namespace {

template <int D>
class SegmentedSap final : public Searcher<D> {
 public:
  explicit SegmentedSap(const Settings& settings) : boxes_per_region_(settings.number("region")) {}

  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) override {
    const Regions<D> regions(input.boxes, static_cast<double>(input.boxes.size()) / boxes_per_region_);
    file(input.boxes, regions);
    Checkpoint checkpoint(input.workers.checkpoint);
    for (std::size_t region = 0; region + 1 < begins_.size(); ++region)
      sweep(std::span<const RegionEntry>(members_).subspan(begins_[region],
                                                           begins_[region + 1] - begins_[region]),
            input.left_count, checkpoint, pairs);
    return std::nullopt;
  }

 private:
  /// A box in a region. A pair is reported in the region that holds the greater of its minima on each axis:
  /// unless both boxes begin before that region on some axis.
  struct RegionEntry {
    Box<D> box;
    std::uint32_t id;
    std::uint32_t begins_before;  // a bit for each axis
  };

  /// The members of each region, sorted by their minima on the first axis.
  void file(std::span<const Box<D>> boxes, const Regions<D>& regions) {
    begins_.assign(regions.count() + 2, 0);  // until the end of this function, shifted by one
    const auto entries = sorter_.entries(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      entries[i] = {sort_key(boxes[i].min[0]), static_cast<std::uint32_t>(i)};
      regions.for_each(regions.range_of(boxes[i]),
                       [&](const auto& region) { ++begins_[regions.index_of(region) + 2]; });
    }
    for (std::size_t i = 2; i < begins_.size(); ++i) begins_[i] += begins_[i - 1];
    members_.resize(begins_.back());
    for (const auto& entry : sorter_.sort()) {
      const RegionRange<D> range = regions.range_of(boxes[entry.place]);
      regions.for_each(range, [&](const auto& region) {
        std::uint32_t begins_before = 0;
        for (int axis = 0; axis < D; ++axis)
          begins_before |= (region[axis] > range.first[axis] ? 1U : 0U) << axis;
        members_[begins_[regions.index_of(region) + 1]++] = {boxes[entry.place], entry.place, begins_before};
      });
    }
    begins_.pop_back();
  }

  static void sweep(std::span<const RegionEntry> members, std::size_t left, Checkpoint& checkpoint,
                    PairSink& pairs) {
    for (auto a = members.begin(); a != members.end(); ++a) {
      auto b = a + 1;
      for (; b != members.end() && b->box.min[0] <= a->box.max[0]; ++b) {
        if ((a->begins_before & b->begins_before) == 0 && overlap(a->box, b->box) &&
            (left == 0 || (a->id < left) != (b->id < left)))
          pairs.add(BoxId{a->id}, BoxId{b->id});
      }
      checkpoint.count(static_cast<std::uint64_t>(b - a));
    }
  }

  double boxes_per_region_;
  RadixSort<std::uint32_t> sorter_;
  std::vector<RegionEntry> members_;  // of all regions
  std::vector<std::size_t> begins_;   // of each region's members
};

template <int D>
class SegmentedSapFollower final : public Follower<D> {
 public:
  explicit SegmentedSapFollower(const Settings& settings)
      : boxes_per_region_(settings.number("region")),
        segment_(static_cast<std::size_t>(settings.integer("segment"))),
        batch_(settings.number("batch")) {}

  std::optional<Statistics> follow(const Change<D>& change, PairSink& begun, PairSink& ended) override {
    if (change.rebuild || needs_new_regions(change)) build(change);
    load_ = load_after(change);
    Checkpoint checkpoint(change.workers.checkpoint);
    const auto look_at = [&](std::uint32_t a, std::uint32_t b) {
      checkpoint.count(1);
      change.report(BoxId{a}, BoxId{b}, begun, ended);
    };
    in_batch_.resize(change.now.size());
    leaving_.clear();
    entering_.clear();
    for (const BoxId id : change.changed) move(index(id), change, look_at);
    transfer(leaving_, change.before, false, look_at);
    transfer(entering_, change.now, true, look_at);
    if (change.filters_before.empty() && change.filters_now.empty()) return std::nullopt;
    for (const BoxId id : change.changed) {
      if (is_present(change.now[index(id)])) look_around(index(id), change.now[index(id)], look_at);
    }
    return std::nullopt;
  }

  std::size_t bytes() const noexcept override {
    std::size_t bytes = 0;
    for (const Lists& lists : lists_) {
      for (const IntervalList& list : lists) bytes += list.bytes();
    }
    return bytes;
  }

 private:
  using Lists = std::vector<IntervalList>;  // one per axis

  /// A box to erase from a region or insert into it.
  struct Transfer {
    std::size_t region;
    std::uint32_t id;

    friend auto operator<=>(const Transfer&, const Transfer&) = default;
  };

  /// The number of boxes, and the total number of regions they are in.
  struct Load {
    std::size_t boxes = 0;
    std::size_t references = 0;
  };

  void add_to(Load& load, const Box<D>& box, int sign) const {
    if (!is_present(box)) return;
    load.boxes += static_cast<std::size_t>(sign);
    load.references += static_cast<std::size_t>(sign) * regions_->range_of(box).count();
  }

  Load load_after(const Change<D>& change) const {
    Load load = load_;
    for (const BoxId id : change.changed) {
      add_to(load, change.before[index(id)], -1);
      add_to(load, change.now[index(id)], 1);
    }
    return load;
  }

  /// Whether there are far more or fewer boxes than the regions were made for, or the boxes have grown so
  /// that they would be in too many regions.
  bool needs_new_regions(const Change<D>& change) const {
    const Load load = load_after(change);
    constexpr std::size_t few = 100;
    return load.boxes > 2 * made_for_.boxes + few || made_for_.boxes > 2 * load.boxes + few ||
           load.references > 2 * std::max(made_for_.references, 4 * load.boxes);
  }

  /// Makes regions that suit both the previous and the current boxes, and inserts the previous ones.
  void build(const Change<D>& change) {
    std::vector<Box<D>> boxes(change.before.begin(), change.before.end());
    boxes.insert(boxes.end(), change.now.begin(), change.now.end());
    const auto count = static_cast<double>(std::ranges::count_if(change.now, is_present<D, float>));
    regions_.emplace(boxes, count / boxes_per_region_);
    lists_.assign(regions_->count(), Lists(D, IntervalList(segment_)));
    load_ = {};
    made_for_ = {};
    entering_.clear();
    for (std::size_t i = 0; i < change.before.size(); ++i) {
      add_to(load_, change.before[i], 1);
      add_to(made_for_, change.now[i], 1);
      if (is_present(change.before[i]))
        for_each_region(change.before[i], [&](std::size_t region) {
          entering_.push_back({region, static_cast<std::uint32_t>(i)});
        });
    }
    in_batch_.assign(change.now.size(), 0);
    std::ranges::sort(entering_);
    for_each_region_of(entering_, [&](std::size_t region, std::span<const Transfer> transfers) {
      take_in(lists_[region], transfers, change.before);
    });
  }

  template <typename Visit>
  void for_each_region(const Box<D>& box, Visit visit) const {
    regions_->for_each(regions_->range_of(box),
                       [&](const auto& region) { visit(regions_->index_of(region)); });
  }

  static IntervalEnd min_of(std::uint32_t id, const Box<D>& box, int axis) {
    return {box.min[axis], false, id};
  }
  static IntervalEnd max_of(std::uint32_t id, const Box<D>& box, int axis) {
    return {box.max[axis], true, id};
  }

  /// Slides a box in the regions in which it stays, if it does not move far there. Records a transfer for
  /// each region that it leaves or enters.
  template <typename LookAt>
  void move(std::uint32_t id, const Change<D>& change, LookAt look_at) {
    const Box<D>& before = change.before[id];
    const Box<D>& now = change.now[id];
    const bool was = is_present(before);
    const bool is = is_present(now);
    if (before == now) return;
    const RegionRange<D> old_range = was ? regions_->range_of(before) : RegionRange<D>{};
    const RegionRange<D> new_range = is ? regions_->range_of(now) : RegionRange<D>{};
    if (was) {
      regions_->for_each(old_range, [&](const auto& place) {
        const std::size_t region = regions_->index_of(place);
        if (is && new_range.has(place)) {
          if (slide(lists_[region], id, before, now, look_at)) return;
          entering_.push_back({region, id});
        }
        leaving_.push_back({region, id});
      });
    }
    if (is) {
      regions_->for_each(new_range, [&](const auto& place) {
        if (!was || !old_range.has(place)) entering_.push_back({regions_->index_of(place), id});
      });
    }
  }

  template <typename LookAt>
  static bool slide(Lists& lists, std::uint32_t id, const Box<D>& before, const Box<D>& now, LookAt look_at) {
    for (int axis = 0; axis < D; ++axis) {
      if (!lists[axis].is_near(min_of(id, before, axis), min_of(id, now, axis)) ||
          !lists[axis].is_near(max_of(id, before, axis), max_of(id, now, axis)))
        return false;
    }
    for (int axis = 0; axis < D; ++axis) {
      lists[axis].move(min_of(id, before, axis), max_of(id, before, axis), min_of(id, now, axis),
                       max_of(id, now, axis), [&](std::uint32_t other) { look_at(id, other); });
    }
    return true;
  }

  template <typename LookAt>
  static void look_around(const Lists& lists, std::uint32_t id, const Box<D>& box, LookAt look_at) {
    lists[0].for_each_overlap(min_of(id, box, 0), max_of(id, box, 0),
                              [&](std::uint32_t other) { look_at(id, other); });
  }

  template <typename LookAt>
  void look_around(std::uint32_t id, const Box<D>& box, LookAt look_at) const {
    for_each_region(box, [&](std::size_t region) { look_around(lists_[region], id, box, look_at); });
  }

  /// Calls visit(region, transfers) for each region in the sorted `transfers`.
  template <typename Visit>
  static void for_each_region_of(std::span<const Transfer> transfers, Visit visit) {
    while (!transfers.empty()) {
      const std::size_t region = transfers.front().region;
      const auto end = std::ranges::upper_bound(transfers, region, {}, &Transfer::region);
      const auto count = static_cast<std::size_t>(end - transfers.begin());
      visit(region, transfers.first(count));
      transfers = transfers.subspan(count);
    }
  }

  /// Erases boxes from regions, or inserts them: one by one, or as a batch per region.
  template <typename LookAt>
  void transfer(std::vector<Transfer>& transfers, std::span<const Box<D>> boxes, bool enter, LookAt look_at) {
    std::ranges::sort(transfers);
    for_each_region_of(transfers, [&](std::size_t region, std::span<const Transfer> some) {
      Lists& lists = lists_[region];
      const auto in_region = static_cast<double>(lists[0].size()) / 2;
      if (static_cast<double>(some.size()) > batch_ * in_region) {
        for (const Transfer& one : some) in_batch_[one.id] = 1;
        if (enter) take_in(lists, some, boxes);
        look_at_batch(lists[0], look_at);
        if (!enter) let_go(lists);
        for (const Transfer& one : some) in_batch_[one.id] = 0;
        return;
      }
      for (const Transfer& one : some) {
        const Box<D>& box = boxes[one.id];
        look_around(lists, one.id, box, look_at);
        for (int axis = 0; axis < D; ++axis) {
          const IntervalEnd min = min_of(one.id, box, axis);
          const IntervalEnd max = max_of(one.id, box, axis);
          if (enter)
            lists[axis].insert(min, max);
          else
            lists[axis].erase(min, max);
        }
      }
    });
  }

  /// Merges a batch into a region's lists.
  void take_in(Lists& lists, std::span<const Transfer> batch, std::span<const Box<D>> boxes) {
    for (int axis = 0; axis < D; ++axis) {
      ends_.clear();
      lists[axis].append_to(ends_);
      const auto middle = static_cast<std::ptrdiff_t>(ends_.size());
      for (const Transfer& one : batch) {
        ends_.push_back(min_of(one.id, boxes[one.id], axis));
        ends_.push_back(max_of(one.id, boxes[one.id], axis));
      }
      std::sort(ends_.begin() + middle, ends_.end());
      std::inplace_merge(ends_.begin(), ends_.begin() + middle, ends_.end());
      lists[axis].assign(ends_);
    }
  }

  /// Erases the batch from a region's lists.
  void let_go(Lists& lists) {
    for (IntervalList& list : lists) {
      ends_.clear();
      list.append_to(ends_);
      std::erase_if(ends_, [&](IntervalEnd end) { return in_batch_[end.id()] != 0; });
      list.assign(ends_);
    }
  }

  /// Sweeps a list for the pairs with at least one box in the batch.
  template <typename LookAt>
  void look_at_batch(const IntervalList& list, LookAt look_at) {
    ends_.clear();
    list.append_to(ends_);
    for (std::vector<std::uint32_t>& open : open_) open.clear();
    for (const IntervalEnd end : ends_) {
      const std::uint32_t id = end.id();
      std::vector<std::uint32_t>& mine = open_[in_batch_[id]];
      if (end.is_max()) {
        *std::ranges::find(mine, id) = mine.back();
        mine.pop_back();
        continue;
      }
      for (const std::uint32_t other : open_[1]) look_at(id, other);
      if (in_batch_[id] != 0) {
        for (const std::uint32_t other : open_[0]) look_at(id, other);
      }
      mine.push_back(id);
    }
  }

  double boxes_per_region_;
  std::size_t segment_;
  double batch_;
  std::optional<Regions<D>> regions_;
  std::vector<Lists> lists_;  // by region
  Load load_;                 // of the frame that the lists hold
  Load made_for_;             // of the frame that the regions were made for

  // Valid during one update.
  std::vector<Transfer> leaving_;
  std::vector<Transfer> entering_;
  std::vector<std::uint8_t> in_batch_;  // by box
  std::vector<IntervalEnd> ends_;
  std::array<std::vector<std::uint32_t>, 2> open_;
};

}  // namespace

Algorithm segmented_sap() {
  return {
      .name = "segmented_sap",
      .summary = "sweep and prune in the regions of a grid; in motion, with segmented interval lists",
      .source = "Tracy, Buss and Woods 2009, Efficient Large-Scale Sweep and Prune Methods",
      .kind = AlgorithmKind::literature,
      .tunables = {{.name = "region",
                    .summary = "boxes to a region of the grid",
                    .default_value = "50",
                    .type = Tunable::Type::number,
                    .min = 1,
                    .max = 1e12},
                   {.name = "segment",
                    .summary = "interval ends to a segment of a list",
                    .default_value = "64",
                    .type = Tunable::Type::integer,
                    .min = 1,
                    .max = 1e9},
                   {.name = "batch",
                    .summary = "share of a region's boxes, beyond which they come or go as a batch",
                    .default_value = "0.25",
                    .type = Tunable::Type::number,
                    .min = 0,
                    .max = 1e9}},
      .in_2d = {.searcher = make_strategy<SegmentedSap<2>>,
                .followers = {{.name = "interval lists", .make = make_strategy<SegmentedSapFollower<2>>}}},
      .in_3d = {.searcher = make_strategy<SegmentedSap<3>>,
                .followers = {{.name = "interval lists", .make = make_strategy<SegmentedSapFollower<3>>}}},
      .limits = {.max_boxes = IntervalEnd::max_ids},
  };
}

}  // namespace broadside::lab::literature
