// An index of boxes: a dynamic bounding volume hierarchy that follows frames and answers queries.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "broadside/queries.hpp"

#include "algorithms/bvh/conservative_rounding.hpp"
#include "algorithms/bvh/dynamic_bvh.hpp"
#include "core/lean.hpp"
#include "kernels/bvh_query.hpp"

namespace broadside::algorithm {

/// Floats are searched exactly by the kernels. Boxes of doubles are in the tree as floats about an origin, by
/// conservative rounding; what the kernels find there is tested again by the definitions, in double.
template <int D, typename Real>
class BvhIndex final : public BoxIndex<D, Real> {
 public:
  using QueryOptions = broadside::QueryOptions<BoxId>;
  using BoxIndex<D, Real>::may_find;

  /// For a tracker of floats that moves the boxes itself, instead of update(), and then hands over filters.
  DynamicBvh<D>& tree() noexcept { return tree_; }
  const DynamicBvh<D>& tree() const noexcept { return tree_; }
  using BoxIndex<D, Real>::take_filters;

  const Box<D, Real>& exact(BoxId id) const noexcept { return exact_[index(id)]; }

  /// The parameter at which box `found.ids[i]` is met.
  std::optional<Real> t_enter_of(const BoxCast<D, Real>& cast, const kernels::FoundBoxes& found,
                                 std::size_t i) const;

 private:
  using Point = std::array<Real, D>;

  void update_valid(std::span<const Box<D, Real>> boxes, std::span<const BoxId> changed,
                    bool rebuild) override;
  bool find_overlapping(const Box<D, Real>& box, Visitor<BoxId>& visitor,
                        const QueryOptions& options) const override;
  bool find_hits(const BoxCast<D, Real>& cast, Visitor<Hit<Real>>& visitor,
                 const QueryOptions& options) const override;
  std::optional<Hit<Real>> find_first_hit(const BoxCast<D, Real>& cast,
                                          const QueryOptions& options) const override;
  bool find_nearest(const Point& point, std::size_t count, Real max_distance_squared,
                    Visitor<Neighbour<Real>>& visitor, const QueryOptions& options) const override;
  std::size_t index_bytes() const noexcept override {
    if constexpr (core::is_lean) return 0;
    return tree_.bytes() + exact_.capacity() * sizeof(Box<D, Real>);
  }

  void build(std::span<const Box<D, Real>> boxes);
  Box<D> in_tree(const Box<D, Real>& box) const;
  kernels::CastQuery<D> in_tree(const BoxCast<D, Real>& cast, int& exponent) const;

  DynamicBvh<D> tree_;
  std::vector<Box<D, Real>> exact_;  // by id; of doubles alone
  ConservativeRounding<D> rounding_;
};

}  // namespace broadside::algorithm
