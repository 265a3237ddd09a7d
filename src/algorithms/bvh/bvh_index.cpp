// BvhIndex: updates, and queries by the kernels.
#include "algorithms/bvh/bvh_index.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "algorithms/bvh/query_results.hpp"
#include "core/input_check.hpp"

namespace broadside::algorithm {
namespace {

using kernels::fan_out;
using kernels::FoundBoxes;
using kernels::leaf_bit;

/// A cast's parameter in the tree: 2^exponent times the caller's.
template <typename Real>
float in_tree(Real t_max, int exponent) {
  if constexpr (is_float<Real>)
    return t_max;
  else
    return rounded_up(std::ldexp(t_max, exponent));
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
  // Many single changes cost more than a build of all boxes. A build also reads absent boxes.
  if (rebuild || changed_.size() > tree_.size() / 4 + boxes.size() / 64 + 16) {
    build(boxes);
  } else {
    if constexpr (!is_float<Real>) exact_.resize(boxes.size(), absent_box<D, Real>());
    for (const BoxId id : changed_) {
      const bool is_there = index(id) < boxes.size() && is_present(boxes[index(id)]);
      tree_.set(id, is_there ? in_tree(boxes[index(id)]) : absent_box<D>());
      if constexpr (!is_float<Real>) {
        if (index(id) < boxes.size()) exact_[index(id)] = boxes[index(id)];
      }
    }
    if (tree_.needs_rebuild()) build(boxes);
  }
  size_ = boxes.size();
  dirty_ = false;
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
  if constexpr (is_float<Real>) {
    tree_.build(boxes);
  } else {
    exact_.assign(boxes.begin(), boxes.end());
    rounding_.fit(exact_);
    std::vector<Box<D>> rounded;
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

template <int D, typename Real>
bool BvhIndex<D, Real>::find_nearest(const Point& point, std::size_t count, Real max_distance_squared,
                                     Visitor<Neighbour<Real>>& visitor, const QueryOptions& options) const {
  if (is_empty()) return true;
  kernels::DistanceQuery<D> query;
  query.weight.fill(1);
  query.point = in_tree(Box<D, Real>{point, point});
  query.max = std::numeric_limits<float>::infinity();
  Real unit = 1;                    // the caller's squared distance 1, in the tree
  if constexpr (!is_float<Real>) {  // distances in the tree must not exceed the true ones
    // Beyond this limit, the definition's squares may overflow or lose their last places.
    constexpr int max_exponent = 400;
    int exponent = max_exponent;
    for (int axis = 0; axis < D; ++axis) exponent = std::min(exponent, rounding_.exponent(axis));
    exponent = std::max(exponent, -max_exponent);
    for (int axis = 0; axis < D; ++axis)
      query.weight[axis] = std::ldexp(1.0F, std::min(0, exponent - rounding_.exponent(axis)));
    unit = std::ldexp(Real{1}, 2 * exponent);
    query.max = std::numeric_limits<float>::max();
    query.share = 1 - 0x1p-18f;
    query.allowance = std::numeric_limits<float>::min();
  }
  NearestBoxes<Real> found(count, max_distance_squared);
  // Beyond this, a node or box in the tree is farther away than the farthest of those found.
  const auto limit_in_tree = [&] {
    if constexpr (is_float<Real>)
      return found.limit();
    else
      return rounded_up(found.limit() * unit);
  };
  struct PendingNode {
    float distance;
    std::uint32_t number;
  };
  const kernels::BvhView<D> tree = tree_.view();
  std::array<PendingNode, (kernels::longest_path + 1) * fan_out> waiting;
  std::array<float, fan_out> distances;
  std::size_t waits = 1;
  waiting[0] = {0, tree.root};
  while (waits > 0) {
    const auto [distance, number] = waiting[--waits];
    if (!(distance <= limit_in_tree())) continue;
    const kernels::Block<D>& node = tree.nodes[number & ~leaf_bit];
    std::uint32_t near = kernels::near_children(node, query, limit_in_tree(), distances) &
                         ((1U << tree_.child_count(number)) - 1);
    if ((number & leaf_bit) == 0) {
      const std::size_t begin = waits;
      for (; near != 0; near &= near - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(near));
        waiting[waits++] = {distances[i], node.id[i]};
      }
      // The nearest comes last, since the last one is taken next.
      std::sort(waiting.data() + begin, waiting.data() + waits,
                [](const PendingNode& a, const PendingNode& b) {
                  return a.distance != b.distance ? a.distance > b.distance : a.number > b.number;
                });
      continue;
    }
    for (; near != 0; near &= near - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(near));
      const std::uint32_t child = node.id[i];
      if (!may_find(BoxId{child}, options)) continue;
      if constexpr (is_float<Real>)
        found.offer({BoxId{child}, distances[i]});
      else
        found.offer({BoxId{child}, squared_distance<D, Real>(point, exact_[child])});
    }
  }
  const std::span<const Neighbour<Real>> nearest = found.sorted();
  return nearest.empty() || visitor.visit(nearest);
}

template class BvhIndex<2, float>;
template class BvhIndex<2, double>;
template class BvhIndex<3, float>;
template class BvhIndex<3, double>;

}  // namespace broadside::algorithm
