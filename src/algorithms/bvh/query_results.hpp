// Sinks for the query kernels: they filter the boxes found, test them in double, and pass them on to the
// caller.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "broadside/queries.hpp"

#include "algorithms/bvh/bvh_index.hpp"
#include "algorithms/bvh/conservative_rounding.hpp"
#include "kernels/bvh_query.hpp"

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

/// The nearest boxes so far: a max-heap of at most `count` boxes, on the stack while it is small.
class NearestBoxes {
 public:
  NearestBoxes(std::size_t count, double max_distance_squared)
      : count_(count), max_distance_squared_(max_distance_squared) {}

  /// A box with a greater squared distance is not among the nearest.
  double limit() const noexcept {
    return size_ < count_ ? max_distance_squared_ : heap_.front().distance_squared;
  }

  void offer(const Neighbour& one) {
    if (!(one.distance_squared <= max_distance_squared_)) return;
    if (size_ == count_) {
      if (!is_before(one, heap_.front())) return;
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
    std::sort_heap(heap.begin(), heap.end(), is_before);
    return heap;
  }

 private:
  static bool is_before(const Neighbour& a, const Neighbour& b) noexcept {
    return a.distance_squared != b.distance_squared ? a.distance_squared < b.distance_squared : a.box < b.box;
  }

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

}  // namespace broadside::algorithm
