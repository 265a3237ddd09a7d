// Sinks for the query kernels: they filter the boxes found, test them in double, and pass them on to the
// caller.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "broadside/queries.hpp"

#include "algorithms/bvh/bvh_index.hpp"
#include "algorithms/bvh/conservative_rounding.hpp"
#include "kernels/bvh_query.hpp"
#include "kernels/squared_distances.hpp"

namespace broadside::algorithm {

/// Passes results on to a visitor: `take_one(boxes, i, to)` returns whether box i of `boxes` is a result, and
/// then sets `to` to it.
template <typename Found, typename TakeOne>
class VisitedBoxes final : public kernels::FoundBoxes {
 public:
  VisitedBoxes(Visitor<Found>& visitor, const TakeOne& take_one) : visitor_(visitor), take_one_(take_one) {}

  bool take() override {
    std::size_t size = 0;
    for (std::size_t i = 0; i < count; ++i)
      size += static_cast<std::size_t>(take_one_(*this, i, result_[size]));
    count = 0;
    full = std::min(2 * full, max_found);
    return size == 0 || visitor_.visit({result_.data(), size});
  }

 private:
  Visitor<Found>& visitor_;
  const TakeOne& take_one_;
  std::array<Found, max_found + 2 * kernels::fan_out> result_;
};

/// The first box that a cast hits; of several hit at once, the one with the least id.
template <int D, typename Real>
class FirstHit final : public kernels::FoundBoxes {
 public:
  FirstHit(const BvhIndex<D, Real>& boxes, const BoxCast<D, Real>& cast, const QueryOptions<BoxId>& options,
           int exponent)
      : boxes_(boxes), cast_(cast), options_(options), exponent_(exponent) {}

  bool take() override {
    for (std::size_t i = 0; i < count; ++i) {
      if (!boxes_.may_find(BoxId{ids[i]}, options_)) continue;
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
  const QueryOptions<BoxId>& options_;
  int exponent_;
};

/// The nearest boxes so far, at most `count`; of two at the same distance, that of the lower id is nearer.
/// Few are kept sorted, on the stack; more are a max-heap.
class NearestBoxes {
 public:
  NearestBoxes(const NearestBoxes&) = delete;
  NearestBoxes& operator=(const NearestBoxes&) = delete;
  NearestBoxes(std::size_t count, double max_distance_squared)
      : count_(count), max_distance_squared_(max_distance_squared) {}

  static bool is_before(const Neighbour& a, const Neighbour& b) noexcept {
    return a.distance_squared != b.distance_squared ? a.distance_squared < b.distance_squared : a.box < b.box;
  }

  /// A box with a greater squared distance is not among the nearest.
  double limit() const noexcept {
    return size_ < count_ ? max_distance_squared_ : heap_[keeps_sorted() ? size_ - 1 : 0].distance_squared;
  }

  std::size_t count() const noexcept { return count_; }

  void offer(const Neighbour& one) {
    if (!(one.distance_squared <= max_distance_squared_)) return;
    if (size_ == count_ && !is_before(one, heap_[keeps_sorted() ? size_ - 1 : 0])) return;
    if (keeps_sorted()) {
      std::size_t at = size_ < count_ ? size_++ : size_ - 1;
      for (; at > 0 && is_before(one, few_[at - 1]); --at) few_[at] = few_[at - 1];
      few_[at] = one;
      return;
    }
    if (size_ == count_) {
      const std::span<Neighbour> heap = heap_.first(size_--);
      std::pop_heap(heap.begin(), heap.end(), is_before);
    }
    if (size_ == heap_.size()) grow();
    heap_[size_++] = one;
    const std::span<Neighbour> heap = heap_.first(size_);
    std::push_heap(heap.begin(), heap.end(), is_before);
  }

  /// All of them, the nearest first. This destroys the heap.
  std::span<const Neighbour> sorted() {
    const std::span<Neighbour> heap = heap_.first(size_);
    if (!keeps_sorted()) std::sort_heap(heap.begin(), heap.end(), is_before);
    return heap;
  }

 private:
  bool keeps_sorted() const noexcept { return count_ <= few_.size(); }

  void grow() {
    if (many_.empty()) many_.assign(few_.begin(), few_.end());
    many_.resize(2 * size_);
    heap_ = many_;
  }

  std::size_t count_;
  double max_distance_squared_;
  std::size_t size_ = 0;
  std::array<Neighbour, 64> few_;
  std::vector<Neighbour> many_;
  std::span<Neighbour> heap_ = few_;
};

/// The kernel's greatest squared distance for this true one, in the tree's unit: the kernel's may exceed the
/// true ones by a few roundings, also of subnormal numbers.
inline float limit_in_tree(double distance_squared) noexcept {
  constexpr double margin = 1 + 0x1p-18;
  constexpr double min_normal = 0x1p-126;
  return rounded_up(distance_squared * margin + min_normal);
}

/// Offers to NearestBoxes what the kernel finds near `box`, which is present.
template <int D, typename Real>
class NearestSearch final : public kernels::FoundBoxes {
 public:
  /// `unit` is the caller's squared distance 1 in the tree.
  NearestSearch(const BvhIndex<D, Real>& boxes, const Box<D, Real>& box, const QueryOptions<BoxId>& options,
                double unit, NearestBoxes& found)
      : boxes_(boxes), box_(box), options_(options), unit_(unit), found_(found) {
    set_limit();
  }

  /// Begins with the nearest ones, as far as that is cheap to know: they lower the limit for the others. In a
  /// ball of radius r, some count * (r' / r)^D boxes are within r'.
  bool take() override {
    full = std::min(2 * full, max_found);
    float step = t_max;
    if (count > found_.count() + 4 && t_max < std::numeric_limits<float>::max()) {
      const auto share = static_cast<float>(found_.count() + 4) / static_cast<float>(count);
      step *= D == 2 ? share : std::sqrt(share * std::sqrt(share));  // about share^(2 / 3)
      step = std::max(step, 0x1p-126f);                              // not 0, which would stay 0
    }
    for (float from = -1; from < t_max; from = step, step *= 2) {
      for (std::size_t i = 0; i < count; ++i) {
        if (t_enter[i] > from && t_enter[i] <= std::min(step, t_max)) offer(ids[i]);
      }
      set_limit();
    }
    count = 0;
    return true;
  }

 private:
  void offer(std::uint32_t slot) {
    const BoxId id = boxes_.id_at(slot);
    if (!boxes_.may_find(id, options_)) return;
    found_.offer({id, kernels::squared_distance(box_, boxes_.exact(slot, id))});
  }

  void set_limit() { t_max = limit_in_tree(found_.limit() * unit_); }

  const BvhIndex<D, Real>& boxes_;
  const Box<D, Real>& box_;
  const QueryOptions<BoxId>& options_;
  double unit_;
  NearestBoxes& found_;
};

}  // namespace broadside::algorithm
