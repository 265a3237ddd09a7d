// Sinks for the kernels' searches: they filter boxes found, test them in double, and hand them on to the
// caller.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <type_traits>

#include "broadside/queries.hpp"

#include "algorithms/bvh/conservative_rounding.hpp"
#include "algorithms/bvh/index.hpp"
#include "kernels/bvh_query.hpp"

namespace broadside::algorithm {

template <typename Real>
inline constexpr bool is_float = std::is_same_v<Real, float>;

template <int D, typename Real>
using Eligible = typename BvhIndex<D, Real>::Eligible;

/// Boxes that may overlap a box.
template <int D, typename Real>
class Overlapping final : public kernels::FoundBoxes {
 public:
  Overlapping(const BvhIndex<D, Real>& boxes, const Box<D, Real>& box, Visitor<BoxId>& visitor,
              const Eligible<D, Real>& eligible)
      : boxes_(boxes), box_(box), visitor_(visitor), eligible_(eligible) {}

  bool take() override {
    std::size_t size = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const BoxId id{ids[i]};
      result_[size] = id;
      bool counts = boxes_.may_find(id, eligible_);
      if constexpr (!is_float<Real>) counts = counts && overlap(box_, boxes_.exact(id));
      size += static_cast<std::size_t>(counts);
    }
    count = 0;
    full = std::min(2 * full, most);
    return size == 0 || visitor_.visit({result_.data(), size});
  }

 private:
  const BvhIndex<D, Real>& boxes_;
  const Box<D, Real>& box_;
  Visitor<BoxId>& visitor_;
  const Eligible<D, Real>& eligible_;
  std::array<BoxId, most + 2 * kernels::fan_out> result_;
};

/// Boxes that a cast may meet.
template <int D, typename Real>
class Met final : public kernels::FoundBoxes {
 public:
  Met(const BvhIndex<D, Real>& boxes, const BoxCast<D, Real>& cast, Visitor<Hit<Real>>& visitor,
      const Eligible<D, Real>& eligible)
      : boxes_(boxes), cast_(cast), visitor_(visitor), eligible_(eligible) {}

  bool take() override {
    std::size_t size = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (!boxes_.may_find(BoxId{ids[i]}, eligible_)) continue;
      if (const std::optional<Real> enter = boxes_.t_enter_of(cast_, *this, i))
        result_[size++] = {BoxId{ids[i]}, *enter};
    }
    count = 0;
    full = std::min(2 * full, most);
    return size == 0 || visitor_.visit({result_.data(), size});
  }

 private:
  const BvhIndex<D, Real>& boxes_;
  const BoxCast<D, Real>& cast_;
  Visitor<Hit<Real>>& visitor_;
  const Eligible<D, Real>& eligible_;
  std::array<Hit<Real>, most + 2 * kernels::fan_out> result_;
};

/// The first box that a cast meets; of several, the one with the least id.
template <int D, typename Real>
class First final : public kernels::FoundBoxes {
 public:
  First(const BvhIndex<D, Real>& boxes, const BoxCast<D, Real>& cast, const Eligible<D, Real>& eligible,
        int exponent)
      : boxes_(boxes), cast_(cast), eligible_(eligible), exponent_(exponent) {}

  bool take() override {
    for (std::size_t i = 0; i < count; ++i) {
      if (!boxes_.may_find(BoxId{ids[i]}, eligible_)) continue;
      const std::optional<Real> enter = boxes_.t_enter_of(cast_, *this, i);
      if (!enter) continue;
      const BoxId id{ids[i]};
      if (best && (*enter > best->t_enter || (*enter == best->t_enter && id > best->box))) continue;
      best = {id, *enter};
      if constexpr (is_float<Real>)
        t_max = *enter;
      else
        t_max = rounded_up(std::ldexp(*enter, exponent_));
    }
    count = 0;
    return true;
  }

  std::optional<Hit<Real>> best;

 private:
  const BvhIndex<D, Real>& boxes_;
  const BoxCast<D, Real>& cast_;
  const Eligible<D, Real>& eligible_;
  int exponent_;
};

}  // namespace broadside::algorithm
