// An index of boxes: a tree of bounds, sixteen to a node, that follows frames and answers queries.
//
// Floats are searched exactly by the kernels. Boxes of doubles are in the tree as floats about an origin,
// rounded outward; what the kernels find there is looked at again by the definitions, in double.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <type_traits>

#include "broadside/queries.hpp"

#include "algorithms/bvh/outward.hpp"
#include "algorithms/bvh/queries.hpp"
#include "interface/squared_distance.hpp"
#include "kernels/query_tree.hpp"

namespace broadside::own {
namespace {

using kernels::FoundBoxes;
using kernels::leaf_bit;
using kernels::node_width;

template <int D, typename Real>
class BvhIndex final : public BoxIndex<D, Real> {
 private:
  static constexpr bool is_float = std::is_same_v<Real, float>;
  using Point = std::array<Real, D>;

  void update_valid(std::span<const Box<D, Real>> boxes, std::span<const BoxId> changed,
                    bool rebuild) override {
    // Many changes cost more one by one than all boxes at once.
    if (rebuild || changed.size() > tree_.size() / 4 + 16) return build(boxes);
    if constexpr (!is_float) exact_.resize(boxes.size(), absent_box<D, Real>());
    for (const BoxId id : changed) {
      const bool is_there = index(id) < boxes.size() && is_present(boxes[index(id)]);
      if constexpr (is_float) {
        tree_.set(id, is_there ? boxes[index(id)] : absent_box<D>());
      } else {
        if (index(id) < boxes.size()) exact_[index(id)] = boxes[index(id)];
        tree_.set(id, is_there ? outward_.box(boxes[index(id)]) : absent_box<D>());
      }
    }
    if (tree_.is_worn()) build(boxes);
  }

  void build(std::span<const Box<D, Real>> boxes) {
    if constexpr (is_float) {
      tree_.build(boxes);
    } else {
      exact_.assign(boxes.begin(), boxes.end());
      outward_.fit(boxes);
      std::vector<Box<D>> rounded;
      rounded.reserve(boxes.size());
      for (const Box<D, Real>& box : boxes)
        rounded.push_back(is_present(box) ? outward_.box(box) : absent_box<D>());
      tree_.build(rounded);
    }
  }

  /// The parameter at which box `id` is met. Floats' are in `found`.
  std::optional<Real> entry_of(const BoxCast<D, Real>& cast, const FoundBoxes& found, std::size_t i) const {
    if constexpr (is_float)
      return found.entries[i];
    else
      return entry(cast, exact_[found.ids[i]]);
  }

  class Overlapping final : public FoundBoxes {
   public:
    Overlapping(const BvhIndex& boxes, const Box<D, Real>& box, Visitor<BoxId>& visitor, const Filter* asker)
        : boxes_(boxes), box_(box), visitor_(visitor), asker_(asker) {}

    bool take() override {
      std::size_t size = 0;
      for (std::size_t i = 0; i < count; ++i) {
        const BoxId id{ids[i]};
        result_[size] = id;
        bool counts = asker_ == nullptr || boxes_.may_find(id, asker_);
        if constexpr (!is_float) counts = counts && overlap(box_, boxes_.exact_[index(id)]);
        size += static_cast<std::size_t>(counts);
      }
      count = 0;
      full = std::min(2 * full, most);
      return size == 0 || visitor_.visit({result_.data(), size});
    }

   private:
    const BvhIndex& boxes_;
    const Box<D, Real>& box_;
    Visitor<BoxId>& visitor_;
    const Filter* asker_;
    std::array<BoxId, most + 2 * node_width> result_;
  };

  class Met final : public FoundBoxes {
   public:
    Met(const BvhIndex& boxes, const BoxCast<D, Real>& cast, Visitor<Hit<Real>>& visitor, const Filter* asker)
        : boxes_(boxes), cast_(cast), visitor_(visitor), asker_(asker) {}

    bool take() override {
      std::size_t size = 0;
      for (std::size_t i = 0; i < count; ++i) {
        if (asker_ != nullptr && !boxes_.may_find(BoxId{ids[i]}, asker_)) continue;
        if (const std::optional<Real> enter = boxes_.entry_of(cast_, *this, i))
          result_[size++] = {BoxId{ids[i]}, *enter};
      }
      count = 0;
      full = std::min(2 * full, most);
      return size == 0 || visitor_.visit({result_.data(), size});
    }

   private:
    const BvhIndex& boxes_;
    const BoxCast<D, Real>& cast_;
    Visitor<Hit<Real>>& visitor_;
    const Filter* asker_;
    std::array<Hit<Real>, most + 2 * node_width> result_;
  };

  class First final : public FoundBoxes {
   public:
    First(const BvhIndex& boxes, const BoxCast<D, Real>& cast, const Filter* asker, int exponent)
        : boxes_(boxes), cast_(cast), asker_(asker), exponent_(exponent) {}

    bool take() override {
      for (std::size_t i = 0; i < count; ++i) {
        if (asker_ != nullptr && !boxes_.may_find(BoxId{ids[i]}, asker_)) continue;
        const std::optional<Real> enter = boxes_.entry_of(cast_, *this, i);
        if (!enter) continue;
        const BoxId id{ids[i]};
        if (best && (*enter > best->entry || (*enter == best->entry && id > best->box))) continue;
        best = {id, *enter};
        if constexpr (is_float)
          furthest = *enter;
        else
          furthest = rounded_up(std::ldexp(*enter, exponent_));
      }
      count = 0;
      return true;
    }

    std::optional<Hit<Real>> best;

   private:
    const BvhIndex& boxes_;
    const BoxCast<D, Real>& cast_;
    const Filter* asker_;
    int exponent_;
  };

  Box<D> in_tree(const Box<D, Real>& box) const {
    if constexpr (is_float)
      return box;
    else
      return outward_.box(box);
  }

  bool find_overlapping(const Box<D, Real>& box, Visitor<BoxId>& visitor,
                        const Filter* asker) const override {
    if (tree_.size() == 0) return true;
    Overlapping found(*this, box, visitor, asker);
    return kernels::find_overlapping(tree_.view(), in_tree(box), found) && found.take();
  }

  /// The cast as the kernels take it, the parameter being 2^exponent times the caller's.
  kernels::CastQuery<D> in_tree(const BoxCast<D, Real>& cast, int& exponent) const {
    kernels::CastQuery<D> query{in_tree(cast.box), {}, {}, {}, is_float};
    exponent = 0;
    if constexpr (!is_float) {
      constexpr int none = std::numeric_limits<int>::min();
      int greatest = none;
      for (int axis = 0; axis < D; ++axis) {
        if (cast.direction[axis] == 0) continue;
        greatest = std::max(greatest, std::ilogb(cast.direction[axis]) + outward_.exponent(axis));
      }
      if (greatest != none) exponent = greatest;
    }
    // Beyond these, a parameter that is computed by the definition may overflow or lose its last places, or
    // an inverse may, and the tree's bounds would tell apart what the definition does not.
    constexpr Real least = is_float ? Real{0x1p-125f} : static_cast<Real>(0x1p-900);
    constexpr int most_exponent = 800;
    for (int axis = 0; axis < D; ++axis) {
      const Real direction = cast.direction[axis];
      const Real scaled = is_float ? direction : std::ldexp(direction, outward_.exponent(axis) - exponent);
      const auto is_usual = [](Real value, Real limit) {
        return std::abs(value) >= limit && std::abs(value) <= 1 / limit;
      };
      query.direction[axis] = static_cast<float>(scaled);
      query.inverse[axis] = 1;
      if (direction == 0) {
        query.course[axis] = kernels::Course::still;
      } else if (is_usual(direction, least) && is_usual(scaled, Real{0x1p-125f}) &&
                 std::abs(exponent) <= most_exponent) {
        query.course[axis] = direction > 0 ? kernels::Course::forward : kernels::Course::backward;
        query.inverse[axis] = static_cast<float>(1 / scaled);
      } else {
        query.course[axis] = kernels::Course::unknown;
      }
    }
    return query;
  }

  static float in_tree(Real furthest, int exponent) {
    if constexpr (is_float)
      return furthest;
    else
      return rounded_up(std::ldexp(furthest, exponent));
  }

  bool find_hits(const BoxCast<D, Real>& cast, Visitor<Hit<Real>>& visitor,
                 const Filter* asker) const override {
    if (tree_.size() == 0) return true;
    int exponent = 0;
    const kernels::CastQuery<D> query = in_tree(cast, exponent);
    Met found(*this, cast, visitor, asker);
    found.furthest = in_tree(cast.furthest, exponent);
    return kernels::find_met(tree_.view(), query, found) && found.take();
  }

  std::optional<Hit<Real>> find_first_hit(const BoxCast<D, Real>& cast, const Filter* asker) const override {
    if (tree_.size() == 0) return std::nullopt;
    int exponent = 0;
    const kernels::CastQuery<D> query = in_tree(cast, exponent);
    First found(*this, cast, asker, exponent);
    found.furthest = in_tree(cast.furthest, exponent);
    kernels::find_first_met(tree_.view(), query, found);
    return found.best;
  }

  void find_nearest(const Point& point, std::size_t count, Real furthest, std::vector<Neighbour<Real>>& found,
                    const Filter* asker) const override {
    if (tree_.size() == 0) return;
    kernels::DistanceQuery<D> query;
    query.weight.fill(1);
    query.point = in_tree(Box<D, Real>{point, point});
    query.most = std::numeric_limits<float>::infinity();
    Real unit = 1;              // a distance squared in the tree, where 1 is the caller's
    if constexpr (!is_float) {  // then distances in the tree are to be no greater than they are
      // Beyond these, the definition's squares may overflow or lose their last places.
      constexpr int most_exponent = 400;
      int exponent = most_exponent;
      for (int axis = 0; axis < D; ++axis) exponent = std::min(exponent, outward_.exponent(axis));
      exponent = std::max(exponent, -most_exponent);
      for (int axis = 0; axis < D; ++axis)
        query.weight[axis] = std::ldexp(1.0F, std::min(0, exponent - outward_.exponent(axis)));
      unit = std::ldexp(Real{1}, 2 * exponent);
      query.most = std::numeric_limits<float>::max();
      query.share = 1 - 0x1p-18f;
      query.allowance = std::numeric_limits<float>::min();
    }
    // `found` is a heap whose first is the one to give way.
    const auto is_before = [](const Neighbour<Real>& a, const Neighbour<Real>& b) {
      return a.distance_squared != b.distance_squared ? a.distance_squared < b.distance_squared
                                                      : a.box < b.box;
    };
    const auto limit = [&] { return found.size() < count ? furthest : found.front().distance_squared; };
    const auto offer = [&](const Neighbour<Real>& one) {
      if (!(one.distance_squared <= furthest)) return;
      if (found.size() == count) {
        if (!is_before(one, found.front())) return;
        std::ranges::pop_heap(found, is_before);
        found.pop_back();
      }
      found.push_back(one);
      std::ranges::push_heap(found, is_before);
    };

    struct Waiting {
      float distance;
      std::uint32_t number;
    };
    const kernels::QueryTree<D> tree = tree_.view();
    std::array<Waiting, (kernels::longest_path + 1) * node_width> waiting;
    std::array<float, node_width> distances;
    std::size_t waits = 1;
    waiting[0] = {0, tree.root};
    while (waits > 0) {
      const auto [distance, number] = waiting[--waits];
      if (!(distance <= limit() * unit)) continue;
      const kernels::QueryNode<D>& node = tree.nodes[number & ~leaf_bit];
      kernels::distances(node, query, distances);
      const std::size_t begin = waits;
      for (std::size_t i = 0; i < tree_.child_count(number); ++i) {
        if (!(distances[i] <= limit() * unit)) continue;
        const std::uint32_t child = node.child[i];
        if ((number & leaf_bit) == 0) {
          waiting[waits++] = {distances[i], child};
          continue;
        }
        if (asker != nullptr && !this->may_find(BoxId{child}, asker)) continue;
        if constexpr (is_float)
          offer({BoxId{child}, distances[i]});
        else
          offer({BoxId{child}, core::squared_distance<D, Real>(point, exact_[child])});
      }
      // The nearest one last, where it is taken from.
      std::sort(waiting.begin() + begin, waiting.begin() + waits, [](const Waiting& a, const Waiting& b) {
        return a.distance != b.distance ? a.distance > b.distance : a.number > b.number;
      });
    }
    std::ranges::sort_heap(found, is_before);
  }

  std::size_t index_bytes() const noexcept override {
    return tree_.bytes() + exact_.capacity() * sizeof(Box<D, Real>);
  }

  DynamicBoxTree<D> tree_;
  std::vector<Box<D, Real>> exact_;  // by id; of doubles alone
  Outward<D> outward_;
};

}  // namespace
}  // namespace broadside::own

namespace broadside {

template <int D, typename Real>
std::unique_ptr<BoxIndex<D, Real>> make_box_index() {
  return std::make_unique<own::BvhIndex<D, Real>>();
}

template std::unique_ptr<BoxIndex<2, float>> make_box_index();
template std::unique_ptr<BoxIndex<3, float>> make_box_index();
template std::unique_ptr<BoxIndex<2, double>> make_box_index();
template std::unique_ptr<BoxIndex<3, double>> make_box_index();

}  // namespace broadside
