// BvhIndex: updates, and queries by the kernels.
#include "algorithms/bvh/bvh_index.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "algorithms/bvh/box_order.hpp"
#include "algorithms/bvh/bvh_packer.hpp"
#include "algorithms/bvh/query_results.hpp"
#include "core/bit_cast.hpp"
#include "core/input_check.hpp"
#include "core/message.hpp"
#include "core/parallel.hpp"
#include "core/sample.hpp"
#include "kernels/block_pool.hpp"
#include "kernels/squared_distances.hpp"

namespace broadside::algorithm {
namespace {

using kernels::fan_out;
using kernels::FoundBoxes;

/// A cast's parameter in the tree: 2^exponent times the caller's.
template <typename Real>
float in_tree(Real t_max, int exponent) {
  if constexpr (is_float<Real>)
    return t_max;
  else
    return rounded_up(std::ldexp(t_max, exponent));
}

/// The tree is rebuilt if moves make a search visit more than this many times the nodes.
constexpr double max_growth = 1.5;

template <int D, typename Real>
bool is_point(const Box<D, Real>& box) {
  return box.min == box.max;
}

template <int D, typename Real>
bool are_points(std::span<const Box<D, Real>> boxes) {
  return std::all_of(boxes.begin(), boxes.end(),
                     [](const Box<D, Real>& box) { return is_point(box) || !is_present(box); });
}

}  // namespace

template <int D, typename Real>
void BvhIndex<D, Real>::update(const Frame<D, Real>& frame) {
  core::check_frame(frame, size_, dirty_);
  const bool rebuild = std::exchange(dirty_, true);  // stays true if this update throws
  take_filters_of(frame, rebuild);
  changed_.clear();
  if (!rebuild) list_changes(frame);

  const std::span<const Box<D, Real>> boxes = frame.boxes;
  if (rebuild || !take_changes(boxes)) build(boxes);
  size_ = boxes.size();
  dirty_ = false;
}

/// Takes the boxes in changed_. False if the tree must be built anew, because that costs less or makes
/// searches faster; then only some of them are in the tree.
template <int D, typename Real>
bool BvhIndex<D, Real>::take_changes(std::span<const Box<D, Real>> boxes) {
  const auto box_of = [&](BoxId id) {
    return index(id) < boxes.size() ? boxes[index(id)] : absent_box<D, Real>();
  };
  // Many single changes cost more than a build of all boxes. A build also reads absent boxes.
  const std::size_t few = tree_.size() / 4 + boxes.size() / 64 + 16;
  const bool refits = changed_.size() > few;
  if (refits) {
    if (builds_ahead_ > 0) {
      --builds_ahead_;
      return false;
    }
    const auto comes_or_goes = [&](BoxId id) {
      return is_present(box_of(id)) != (tree_.slot(id) != kernels::no_slot);
    };
    if (static_cast<std::size_t>(std::count_if(changed_.begin(), changed_.end(), comes_or_goes)) > few)
      return false;
  }
  if constexpr (!is_float<Real>) exact_.resize(boxes.size(), absent_box<D, Real>());
  for (const BoxId id : changed_) {
    const Box<D, Real> box = box_of(id);
    const bool is_there = is_present(box);
    if (refits && is_there && tree_.slot(id) != kernels::no_slot)
      tree_.overwrite(id, in_tree(box));
    else
      tree_.set(id, is_there ? in_tree(box) : absent_box<D>());
    are_points_ &= !is_there || is_point(box);
    if constexpr (!is_float<Real>) {
      if (index(id) < boxes.size()) exact_[index(id)] = box;
    }
  }
  if (refits) {
    are_points_ = are_points(boxes);
    const bool fits = tree_.refit_all() <= max_growth;
    // Where boxes scatter in every frame, it is tried less and less often.
    last_builds_ahead_ = fits ? 0 : std::min(2 * last_builds_ahead_ + 1, 15);
    builds_ahead_ = last_builds_ahead_;
    if (!fits) return false;
  }
  return !tree_.needs_rebuild();
}

template <int D, typename Real>
void BvhIndex<D, Real>::take_filters_of(const Frame<D, Real>& frame, bool rebuild) {
  if (rebuild || frame.filters.empty() || own_filters_.empty()) {
    own_filters_.assign(frame.filters.begin(), frame.filters.end());
  } else {
    own_filters_.resize(frame.filters.size());
    for (const BoxId id : frame.changed) {
      if (index(id) < own_filters_.size()) own_filters_[index(id)] = frame.filters[index(id)];
    }
    for (std::size_t i = size_; i < own_filters_.size(); ++i) own_filters_[i] = frame.filters[i];
  }
  filters_ = own_filters_;
}

template <int D, typename Real>
void BvhIndex<D, Real>::list_changes(const Frame<D, Real>& frame) {
  changed_.assign(frame.changed.begin(), frame.changed.end());
  const std::size_t size = std::max(size_, frame.boxes.size());
  for (std::size_t i = std::min(size_, frame.boxes.size()); i < size; ++i) changed_.push_back(BoxId(i));
  // Another thread may have written to the list since it was checked.
  std::erase_if(changed_, [size](BoxId id) { return index(id) >= size; });
}

template <int D, typename Real>
void BvhIndex<D, Real>::build(std::span<const Box<D, Real>> boxes) {
  are_points_ = are_points(boxes);
  if constexpr (is_float<Real>) {
    tree_.build(boxes);
  } else {
    exact_.assign(boxes.begin(), boxes.end());
    rounding_.fit(exact_);
    core::LargeArray<Box<D>> rounded;
    rounded.reserve(exact_.size());
    for (const Box<D, Real>& box : exact_)
      rounded.push_back(is_present(box) ? rounding_.box(box) : absent_box<D>());
    tree_.build(rounded);
  }
}

/// The cast as the kernels take it. Its parameter is 2^exponent times the caller's. Sets `exponent`.
template <int D, typename Real>
kernels::CastQuery<D> BvhIndex<D, Real>::in_tree(const BoxCast<D, Real>& cast, int& exponent) const {
  kernels::CastQuery<D> query{in_tree(cast.box), {}, {}, {}, is_float<Real>};
  exponent = 0;
  if constexpr (!is_float<Real>) {
    constexpr int none = std::numeric_limits<int>::min();
    int greatest = none;
    for (int axis = 0; axis < D; ++axis) {
      if (cast.direction[axis] == 0) continue;
      greatest = std::max(greatest, std::ilogb(cast.direction[axis]) + rounding_.exponent(axis));
    }
    if (greatest != none) exponent = greatest;
  }
  // Beyond these limits, an inverse, or a parameter computed by the definition, may overflow or lose its last
  // places. The axis is then left undecided, so that the tree's bounds do not overrule the definition.
  constexpr Real min_usual = is_float<Real> ? Real{0x1p-125f} : static_cast<Real>(0x1p-900);
  constexpr int max_exponent = 800;
  for (int axis = 0; axis < D; ++axis) {
    const Real direction = cast.direction[axis];
    const Real scaled =
        is_float<Real> ? direction : std::ldexp(direction, rounding_.exponent(axis) - exponent);
    const auto is_usual = [](Real value, Real limit) {
      return std::abs(value) >= limit && std::abs(value) <= 1 / limit;
    };
    query.direction[axis] = static_cast<float>(scaled);
    query.inverse[axis] = 1;
    if (direction == 0) {
      query.course[axis] = kernels::Course::still;
    } else if (is_usual(direction, min_usual) && is_usual(scaled, Real{0x1p-125f}) &&
               std::abs(exponent) <= max_exponent) {
      query.course[axis] = direction > 0 ? kernels::Course::forward : kernels::Course::backward;
      query.inverse[axis] = static_cast<float>(1 / scaled);
    } else {
      query.course[axis] = kernels::Course::unknown;
    }
  }
  return query;
}

template <int D, typename Real>
bool BvhIndex<D, Real>::find_overlapping(const Box<D, Real>& box, Visitor<BoxId>& visitor,
                                         const QueryOptions& options) const {
  if (is_empty()) return true;
  const auto take = [&](const FoundBoxes& boxes, std::size_t i, BoxId& to) {
    to = BoxId{boxes.ids[i]};
    bool counts = may_find(to, options);
    if constexpr (!is_float<Real>) counts = counts && overlap(box, exact_[to]);
    return counts;
  };
  VisitedBoxes found(visitor, take);
  return kernels::find_overlapping(tree_.view(), in_tree(box), found) && found.take();
}

template <int D, typename Real>
bool BvhIndex<D, Real>::find_hits(const BoxCast<D, Real>& cast, Visitor<Hit<Real>>& visitor,
                                  const QueryOptions& options) const {
  if (is_empty()) return true;
  int exponent = 0;
  const kernels::CastQuery<D> query = in_tree(cast, exponent);
  const auto take = [&](const FoundBoxes& boxes, std::size_t i, Hit<Real>& to) {
    if (!may_find(BoxId{boxes.ids[i]}, options)) return false;
    const std::optional<Real> enter = t_enter_of(cast, boxes, i);
    if (enter) to = {BoxId{boxes.ids[i]}, *enter};
    return enter.has_value();
  };
  VisitedBoxes found(visitor, take);
  found.t_max = algorithm::in_tree(cast.t_max, exponent);
  return kernels::find_met(tree_.view(), query, found) && found.take();
}

template <int D, typename Real>
std::optional<Hit<Real>> BvhIndex<D, Real>::find_first_hit(const BoxCast<D, Real>& cast,
                                                           const QueryOptions& options) const {
  if (is_empty()) return std::nullopt;
  int exponent = 0;
  const kernels::CastQuery<D> query = in_tree(cast, exponent);
  FirstHit<D, Real> found(*this, cast, options, exponent);
  found.t_max = algorithm::in_tree(cast.t_max, exponent);
  kernels::find_first_met(tree_.view(), query, found);
  return found.best;
}

/// The caller's squared distance 1 in the tree, where gaps are multiplied by the `weight` of their axis.
template <int D, typename Real>
double BvhIndex<D, Real>::distance_unit(std::array<float, D>& weight) const {
  weight.fill(1);
  if constexpr (is_float<Real>) return 1;
  // Beyond this limit, the definition's squares may overflow or lose their last places.
  constexpr int max_exponent = 400;
  int exponent = max_exponent;
  for (int axis = 0; axis < D; ++axis) exponent = std::min(exponent, rounding_.exponent(axis));
  exponent = std::max(exponent, -max_exponent);
  for (int axis = 0; axis < D; ++axis)
    weight[axis] = std::ldexp(1.0F, std::min(0, exponent - rounding_.exponent(axis)));
  return std::ldexp(1.0, 2 * exponent);
}

/// Offers to `found` all boxes that may be among the nearest to `box`, which is present. The tree has a root.
template <int D, typename Real>
void BvhIndex<D, Real>::search_nearest(const Box<D, Real>& box, const QueryOptions& options,
                                       NearestBoxes& found) const {
  kernels::DistanceQuery<D> query{in_tree(box), {}};
  NearestSearch<D, Real> search(*this, box, options, distance_unit(query.weight), found);
  kernels::find_near(tree_.view(), query, search);
  search.take();
}

template <int D, typename Real>
bool BvhIndex<D, Real>::find_nearest(const Box<D, Real>& box, std::size_t count, double max_distance_squared,
                                     Visitor<Neighbour>& visitor, const QueryOptions& options) const {
  if (is_empty()) return true;
  NearestBoxes found(count, max_distance_squared);
  search_nearest(box, options, found);
  const std::span<const Neighbour> nearest = found.sorted();
  return nearest.empty() || visitor.visit(nearest);
}

namespace {

/// Sixteen queries or fewer: their rows in the results, and their boxes.
template <int D, typename Real>
struct QueryGroup {
  std::size_t size;
  std::array<std::uint32_t, fan_out> row;
  std::array<Box<D, Real>, fan_out> box;
};

/// Whether squares of the coordinates are finite floats.
template <int D>
bool is_moderate(const Box<D>& box) {
  constexpr float limit = 0x1p60F;
  bool is = true;
  for (int axis = 0; axis < D; ++axis) is &= box.min[axis] >= -limit && box.max[axis] <= limit;
  return is;
}

/// Writes no boxes to the places [from, to).
void clear_from(std::size_t from, std::size_t to, std::span<BoxId> found,
                std::span<double> distances_squared) {
  for (; from < to; ++from) {
    found[from] = no_box;
    distances_squared[from] = std::numeric_limits<double>::infinity();
  }
}

/// How far the distance of two points of doubles may be from that of the lower bounds of their boxes in the
/// tree, if one of them is within `bounds` and the distance is small beside them. Conservative rounding moves
/// a coordinate by at most one and a half units in the last place of a float, or to the least normal number.
template <int D>
float rounding_error(const Box<D>& bounds) {
  float greatest = 0;
  for (int axis = 0; axis < D; ++axis)
    greatest = std::max({greatest, std::abs(bounds.min[axis]), std::abs(bounds.max[axis])});
  return greatest * 0x1p-20F + 0x1p-120F;
}

/// Whether no other box than the first `wanted` in a lane's list may be among the nearest, where those are
/// within the squared distance `reached`, in the tree's unit.
template <int D>
bool is_complete(const kernels::NearGroup<D>& group, std::size_t lane, std::size_t wanted, double reached) {
  if (!(limit_in_tree(reached) <= group.limit)) return false;
  const std::int32_t last = group.keys[wanted][lane];
  if (last == group.no_key) return true;
  // By the kernel's distances, all other boxes are at least as far away as the last one.
  if (group.error > 0) {
    const double distance = std::sqrt(reached) + group.error;
    reached = distance * distance;
  }
  return limit_in_tree(reached) < core::bit_cast<float>(last & ~group.number_mask);
}

/// Queries compared with the boxes of the tree, to learn whether they are the same.
constexpr std::size_t max_compared_queries = 64;

/// Fewer queries, or with more boxes per query, are searched one by one in their own order: bringing them
/// into another takes longer than it saves, and one search for a group of queries that are far apart meets
/// more boxes than a search for each.
constexpr std::size_t min_dense_queries = 256;
constexpr std::size_t max_boxes_per_dense_query = 32;

/// After a group has given up, this many groups are searched query by query before one is tried again. The
/// number doubles, up to max_pause, with each further failure, so that trying costs little where all fail.
constexpr std::size_t min_pause = 8;
constexpr std::size_t max_pause = 64;

/// Whether the queries are the tree's own boxes: by all ids, and by some boxes.
template <int D>
bool are_own_boxes(std::span<const NumberedBox<D>> queries, const DynamicBvh<D>& tree) {
  if (queries.size() != tree.size()) return false;
  const std::size_t compared = std::min(queries.size(), max_compared_queries);
  for (std::size_t i = 0; i < compared; ++i) {
    const NumberedBox<D>& query = queries[core::sampled_place(i, compared, queries.size())];
    const std::uint32_t slot = tree.slot(BoxId{query.number});
    if (slot == kernels::no_slot || !(tree.box_at(slot) == query.box)) return false;
  }
  return std::all_of(queries.begin(), queries.end(), [&](const NumberedBox<D>& query) {
    return tree.slot(BoxId{query.number}) != kernels::no_slot;
  });
}

/// The queries in an order in which neighbours in space follow one another, that of a packed tree's leaves,
/// if they are dense.
template <int D>
std::vector<std::uint32_t> spatial_order(std::span<const NumberedBox<D>> queries, const DynamicBvh<D>& tree,
                                         bool is_dense, core::Parallel& parallel) {
  std::vector<std::uint32_t> order;
  order.reserve(queries.size());
  if (!is_dense) {
    for (const NumberedBox<D>& query : queries) order.push_back(query.number);
    return order;
  }
  if (are_own_boxes(queries, tree)) return tree.ids_by_leaf();
  std::vector<Box<D>> boxes;
  boxes.reserve(queries.size());
  for (const NumberedBox<D>& query : queries) boxes.push_back(query.box);
  BvhPacker<D> packer;
  packer.pack(boxes, parallel);
  const kernels::TreeLevel<D>& places = packer.tree().levels[0];
  for (std::size_t place = 0; place < places.size; ++place) {
    if (places.min[0][place] <= places.max[0][place])  // not a place without a box
      order.push_back(queries[index(packer.tree().id[place])].number);
  }
  return order;
}

}  // namespace

/// The first `wanted` boxes in a lane's list, and not beyond `max_squared`, sorted as nearest boxes are, in
/// `to`.
template <int D, typename Real>
std::span<const Neighbour> BvhIndex<D, Real>::listed(const kernels::NearGroup<D>& group, std::size_t lane,
                                                     std::size_t wanted, const Box<D, Real>& box,
                                                     double max_squared, std::span<Neighbour> to) const {
  std::size_t size = 0;
  bool is_sorted = true;
  double farthest = -1;
  for (; size < wanted && group.keys[size][lane] != group.no_key; ++size) {
    const std::uint32_t slot = group.slot(group.keys[size][lane]);
    const BoxId id = id_at(slot);
    const Box<D, Real> other = exact(slot, id);
    const double squared = group.are_points ? kernels::squared_distance(box.min, other.min)
                                            : kernels::squared_distance(box, other);
    to[size] = {id, squared};
    is_sorted &= squared > farthest;
    farthest = squared;
  }
  to = to.first(size);
  if (!is_sorted) std::sort(to.begin(), to.end(), NearestBoxes::is_before);
  while (!to.empty() && to.back().distance_squared > max_squared) to = to.first(to.size() - 1);
  return to;
}

/// Writes the rows of `groups` groups of queries. gather(number, group, asked) reads group `number`, sets
/// `group.own_leaf` if it is a leaf, and returns whether it may be searched as one.
template <int D, typename Real>
template <typename Gather>
void BvhIndex<D, Real>::search_groups(std::size_t groups, const NearestRows& rows, core::Parallel& parallel,
                                      const Gather& gather) const {
  using Group = kernels::NearGroup<D>;
  const NearestOfEachOptions& options = rows.options;
  const double max_squared = options.max_distance * options.max_distance;
  std::array<float, D> weight;
  const double unit = distance_unit(weight);
  const bool may_be_points = are_points_ && is_moderate(kernels::bounds_of(tree_.root())) &&
                             std::all_of(weight.begin(), weight.end(), [](float one) { return one == 1; });
  parallel.for_ranges(groups, [&](core::Range range, std::size_t worker) {
    Checkpoint* const checkpoint = parallel.checkpoint(worker);
    QueryGroup<D, Real> asked;
    Group group;
    group.weight = weight;
    std::array<Neighbour, Group::max_count> near;
    std::size_t paused = 0;  // groups to go until the next is searched as one
    std::size_t pause = min_pause;
    for (std::size_t number = range.begin; number < range.end; ++number) {
      const bool may_group = gather(number, group, asked);
      if (asked.size == 0) continue;
      for (std::size_t lane = 0; lane < asked.size; ++lane) {
        kernels::prefetch(&rows.found[asked.row[lane] * rows.count]);
        kernels::prefetch(&rows.distances_squared[asked.row[lane] * rows.count]);
      }
      // One box more than asked for if one may be left out. The last box of the kernel's lists shows that no
      // other box is as near as those.
      const bool are_own = group.own_leaf != kernels::no_slot;
      const std::size_t wanted = rows.count + (options.except.empty() || are_own ? 0 : 1);
      const bool in_groups = may_group && paused == 0;
      paused -= paused > 0 ? 1 : 0;
      std::size_t tests = 0;
      if (in_groups) {
        group.are_points = may_be_points;
        if (are_own) {
          group.queries = tree_.view().nodes[group.own_leaf];
        } else {
          group.queries.clear();
          for (std::size_t lane = 0; lane < asked.size; ++lane) {
            group.queries.set(lane, in_tree(asked.box[lane]));
            group.are_points &= is_point(asked.box[lane]);
          }
          group.are_points &= is_moderate(kernels::bounds_of(group.queries));
        }
        group.error = 0;
        if (group.are_points && !is_float<Real>)
          group.error = rounding_error(kernels::bounds_of(group.queries));
        group.limit = limit_in_tree(max_squared * unit);
        group.start(wanted + 1);
        kernels::find_near(tree_.view(), group);
        tests += fan_out * group.tested;
        if (group.limit < 0) paused = pause;
        pause = group.limit < 0 ? std::min(2 * pause, max_pause) : min_pause;
      }
      const bool in_group = in_groups && group.limit >= 0;
      for (std::size_t lane = 0; lane < asked.size; ++lane) {
        const Box<D, Real>& box = asked.box[lane];
        const BoxId except = are_own                  ? BoxId{asked.row[lane]}
                             : options.except.empty() ? no_box
                                                      : options.except[asked.row[lane]];
        std::span<const Neighbour> row;
        if (in_group) row = listed(group, lane, wanted, box, max_squared, near);
        const double reached = row.size() < wanted ? max_squared : row.back().distance_squared;
        NearestBoxes nearest(rows.count, reached);
        if (!in_group || !is_complete(group, lane, wanted, reached * unit)) {
          QueryOptions eligible;
          if (!options.filters.empty()) eligible.filter = &options.filters[asked.row[lane]];
          if (except != no_box) eligible.except = except;
          tests += fan_out * (fan_out + rows.count);
          search_nearest(box, eligible, nearest);
          row = nearest.sorted();
        }
        std::size_t to = asked.row[lane] * rows.count;
        const std::size_t end = to + rows.count;
        for (const Neighbour& one : row) {
          if (one.box == except || to == end) continue;
          rows.found[to] = one.box;
          rows.distances_squared[to++] = one.distance_squared;
        }
        clear_from(to, end, rows.found, rows.distances_squared);
      }
      if (checkpoint != nullptr) checkpoint->count(tests);
    }
  });
}

template <int D, typename Real>
void BvhIndex<D, Real>::find_nearest_of_each(BoxView<D, Real> boxes, std::size_t count,
                                             std::span<BoxId> found, std::span<double> distances_squared,
                                             const NearestOfEachOptions& options) const {
  std::size_t queries = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Box<D, Real> box = boxes[i];
    if (!is_present(box) && !is_absent(box))
      throw InvalidQuery(core::fault_of(box, core::message({"query ", i}), true));
    queries += is_present(box) ? 1 : 0;
  }
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (is_empty() || !is_present(boxes[i])) clear_from(i * count, (i + 1) * count, found, distances_squared);
  }
  if (is_empty() || queries == 0) return;
  core::Parallel parallel;
  parallel.start(options.workers, queries);
  const NearestRows rows{count, found, distances_squared, options};
  if (count + 2 <= kernels::NearGroup<D>::max_count && options.filters.empty() &&
      ask_for_own_boxes(boxes, options))
    search_by_leaves(boxes, rows, parallel);
  else
    search_by_order(boxes, queries, rows, parallel);
}

/// Whether the queries are the tree's own boxes, and each leaves out itself. Floats are compared when their
/// leaf is searched: it is enough that queries are absent where boxes are.
template <int D, typename Real>
bool BvhIndex<D, Real>::ask_for_own_boxes(BoxView<D, Real> boxes, const NearestOfEachOptions& options) const {
  if (boxes.size() != size_ || options.except.size() != size_) return false;
  for (std::size_t i = 0; i < size_; ++i) {
    if (options.except[i] != BoxId(i)) return false;
    if constexpr (is_float<Real>) {
      if (is_present(boxes[i]) != (tree_.slot(BoxId(i)) != kernels::no_slot)) return false;
    } else {
      if (!(boxes[i] == exact_[i])) return false;
    }
  }
  return true;
}

/// Asks for the boxes of each leaf at once.
template <int D, typename Real>
void BvhIndex<D, Real>::search_by_leaves(BoxView<D, Real> boxes, const NearestRows& rows,
                                         core::Parallel& parallel) const {
  const Box<D, Real>* array = boxes.array();
  if constexpr (!is_float<Real>) array = exact_.data();
  search_groups(tree_.node_numbers(), rows, parallel,
                [&](std::size_t number, kernels::NearGroup<D>& group, QueryGroup<D, Real>& asked) {
                  const auto node = static_cast<std::uint32_t>(number);
                  asked.size = tree_.is_leaf(node) ? tree_.child_count(node) : 0;
                  asked.row = tree_.view().nodes[node].id;
                  group.own_leaf = node;
                  for (std::size_t lane = 0; lane < asked.size; ++lane) {
                    const BoxId id{asked.row[lane]};
                    const auto slot = static_cast<std::uint32_t>(node * fan_out + lane);
                    asked.box[lane] = is_float<Real> ? boxes[index(id)] : exact(slot, id);
                    if (is_float<Real> && !(asked.box[lane] == exact(slot, id)))
                      group.own_leaf = kernels::no_slot;
                  }
                  if (array != nullptr && number + 1 < tree_.node_numbers() && tree_.is_leaf(node + 1)) {
                    for (const std::uint32_t id : tree_.view().nodes[node + 1].id)
                      kernels::prefetch(&array[id]);
                  }
                  return true;
                });
}

/// Asks for the queries in their own order, or in a spatial one if they are dense.
template <int D, typename Real>
void BvhIndex<D, Real>::search_by_order(BoxView<D, Real> boxes, std::size_t count, const NearestRows& rows,
                                        core::Parallel& parallel) const {
  std::vector<NumberedBox<D>> queries;
  queries.reserve(count);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Box<D, Real> box = boxes[i];
    if (is_present(box)) queries.push_back({in_tree(box), static_cast<std::uint32_t>(i)});
  }
  const bool is_dense =
      queries.size() >= min_dense_queries && tree_.size() / max_boxes_per_dense_query <= queries.size();
  const std::vector<std::uint32_t> order = spatial_order<D>(queries, tree_, is_dense, parallel);
  const std::size_t wanted = rows.count + (rows.options.except.empty() ? 0 : 1);
  const bool may_group =
      is_dense && rows.options.filters.empty() && wanted + 1 <= kernels::NearGroup<D>::max_count;
  search_groups((order.size() + fan_out - 1) / fan_out, rows, parallel,
                [&](std::size_t number, kernels::NearGroup<D>&, QueryGroup<D, Real>& asked) {
                  asked.size = std::min(fan_out, order.size() - number * fan_out);
                  for (std::size_t lane = 0; lane < asked.size; ++lane) {
                    asked.row[lane] = order[number * fan_out + lane];
                    asked.box[lane] = boxes[asked.row[lane]];
                  }
                  return may_group;
                });
}

template class BvhIndex<2, float>;
template class BvhIndex<2, double>;
template class BvhIndex<3, float>;
template class BvhIndex<3, double>;

}  // namespace broadside::algorithm
