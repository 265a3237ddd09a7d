// BvhIndex: the implementation of BoxIndex, a dynamic bounding volume hierarchy that follows frames and
// answers queries.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "broadside/index.hpp"
#include "broadside/queries.hpp"

#include "algorithms/bvh/conservative_rounding.hpp"
#include "algorithms/bvh/dynamic_bvh.hpp"
#include "core/grow.hpp"
#include "core/large_array.hpp"
#include "kernels/bvh_query.hpp"

namespace broadside::algorithm {

template <typename Real>
inline constexpr bool is_float = std::is_same_v<Real, float>;

class NearestBoxes;

/// The kernels search floats exactly. Boxes of doubles are in the tree as floats about an origin, by
/// conservative rounding; what the kernels find is tested again in double, by the queries' definitions.
template <int D, typename Real>
class BvhIndex {
 public:
  using Point = broadside::Point<D, Real>;
  using QueryOptions = broadside::QueryOptions<BoxId>;

  static BvhIndex& of(BoxIndex<D, Real>& index) noexcept { return *index.tree_; }
  static const BvhIndex& of(const BoxIndex<D, Real>& index) noexcept { return *index.tree_; }

  /// Does the work of BoxIndex::update().
  void update(const Frame<D, Real>& frame);

  /// For a follower of floats that moves the boxes in the tree itself, instead of update(). It then passes
  /// the boxes' filters: none, or one for each. The array must stay valid until the next call.
  DynamicBvh<D>& tree() noexcept { return tree_; }
  const DynamicBvh<D>& tree() const noexcept { return tree_; }
  void take_filters(std::span<const Filter> filters) noexcept {
    filters_ = filters;
    dirty_ = false;
  }

  /// The queries of BoxIndex. Arguments must be valid, and the box not absent.
  bool find_overlapping(const Box<D, Real>& box, Visitor<BoxId>& visitor, const QueryOptions& options) const;
  bool find_hits(const BoxCast<D, Real>& cast, Visitor<Hit<Real>>& visitor,
                 const QueryOptions& options) const;
  std::optional<Hit<Real>> find_first_hit(const BoxCast<D, Real>& cast, const QueryOptions& options) const;
  bool find_nearest(const Box<D, Real>& box, std::size_t count, double max_distance_squared,
                    Visitor<Neighbour>& visitor, const QueryOptions& options) const;
  void find_nearest_of_each(BoxView<D, Real> boxes, std::size_t count, std::span<BoxId> found,
                            std::span<double> distances_squared, const NearestOfEachOptions& options) const;

  std::size_t bytes() const noexcept {
    return core::bytes_of(own_filters_, changed_, exact_) + tree_.bytes();
  }

  /// For the kernels' sinks: whether a query may find the box, and the parameter at which a cast hits box
  /// `found.ids[i]`, if it does.
  bool may_find(BoxId id, const QueryOptions& options) const noexcept {
    if (options.except && id == *options.except) return false;
    return options.filter == nullptr ||
           accepts(*options.filter, filters_.empty() ? Filter{} : filters_[index(id)]);
  }

  /// The id of the box in a slot of the tree, and the box as the caller gave it.
  BoxId id_at(std::uint32_t slot) const { return BoxId{leaf_of(slot).id[slot % kernels::fan_out]}; }
  Box<D, Real> exact(std::uint32_t slot, BoxId id) const {
    if constexpr (is_float<Real>)
      return leaf_of(slot).box(slot % kernels::fan_out);
    else
      return exact_[index(id)];
  }

  std::optional<Real> t_enter_of(const BoxCast<D, Real>& cast, const kernels::FoundBoxes& found,
                                 std::size_t i) const {
    if constexpr (is_float<Real>) {
      const BoxId id{found.ids[i]};
      if (cast.entering && !enters(cast, exact(tree_.slot(id), id))) return std::nullopt;
      return found.t_enter[i];
    } else {
      return t_enter(cast, exact_[found.ids[i]]);
    }
  }

 private:
  /// Whether there is nothing to find: no box, or the last update failed.
  bool is_empty() const noexcept { return dirty_ || tree_.size() == 0; }

  bool take_changes(std::span<const Box<D, Real>> boxes);
  void take_filters_of(const Frame<D, Real>& frame, bool rebuild);
  void list_changes(const Frame<D, Real>& frame);
  void build(std::span<const Box<D, Real>> boxes);

  Box<D> in_tree(const Box<D, Real>& box) const {
    if constexpr (is_float<Real>)
      return box;
    else
      return rounding_.box(box);
  }

  kernels::CastQuery<D> in_tree(const BoxCast<D, Real>& cast, int& exponent) const;
  double distance_unit(std::array<float, D>& weight) const;
  void search_nearest(const Box<D, Real>& box, const QueryOptions& options, NearestBoxes& found) const;
  std::span<const Neighbour> listed(const kernels::NearGroup<D>& group, std::size_t lane, std::size_t wanted,
                                    const Box<D, Real>& box, double max_squared,
                                    std::span<Neighbour> to) const;
  /// The arguments of nearest_of_each() that are not queries.
  struct NearestRows {
    std::size_t count;
    std::span<BoxId> found;
    std::span<double> distances_squared;
    const NearestOfEachOptions& options;
  };

  bool ask_for_own_boxes(BoxView<D, Real> boxes, const NearestOfEachOptions& options) const;
  void search_by_leaves(BoxView<D, Real> boxes, const NearestRows& rows, core::Parallel& parallel) const;
  void search_by_order(BoxView<D, Real> boxes, std::size_t count, const NearestRows& rows,
                       core::Parallel& parallel) const;
  template <typename Gather>
  void search_groups(std::size_t groups, const NearestRows& rows, core::Parallel& parallel,
                     const Gather& gather) const;
  const kernels::Block<D>& leaf_of(std::uint32_t slot) const {
    return tree_.view().nodes[slot / kernels::fan_out];
  }

  DynamicBvh<D> tree_;
  core::LargeArray<Box<D, Real>> exact_;  // by id; only for doubles
  ConservativeRounding<D> rounding_;

  std::span<const Filter> filters_;  // of the last frame; empty if it had none
  std::vector<Filter> own_filters_;  // the array behind filters_ after update()
  int builds_ahead_ = 0;             // before the next attempt to keep boxes that moved in their leaves
  int last_builds_ahead_ = 0;
  std::vector<BoxId> changed_;  // the frame's list, and places added or cut off at the end
  std::size_t size_ = 0;        // of the last frame
  bool are_points_ = false;     // all boxes, since the last build
  bool dirty_ = true;           // the last update failed, or there was none
};

}  // namespace broadside::algorithm
