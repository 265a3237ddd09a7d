// nearest_pairs(): for each box, the boxes nearest to it, of the same set or of another one.
#pragma once

#include <concepts>
#include <cstddef>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

#include "broadside/box_view.hpp"
#include "broadside/executor.hpp"
#include "broadside/export.hpp"
#include "broadside/filter.hpp"
#include "broadside/find_pairs.hpp"
#include "broadside/index.hpp"
#include "broadside/pair.hpp"

namespace broadside {

/// Options of nearest_pairs(), as in nearest_pairs(boxes, 3, {.max_distance = 10}).
struct NearestPairsOptions {
  double max_distance = std::numeric_limits<double>::infinity();  ///< as in NearestOptions
  std::span<const Filter> filters{};                              ///< as in PairFilters
  std::span<const Filter> right_filters{};                        ///< as in PairFilters
  std::size_t threads = 1;                                        ///< as in Workers
  Executor* executor = nullptr;                                   ///< as in Workers
};

/// For each of n boxes the k nearest ones: two arrays of n rows with k places.
struct BROADSIDE_CALLERS_VECTOR NearestPairs {
  std::size_t k = 0;
  std::vector<BoxId> boxes;               ///< sorted by distance, then by id; no_box in places without a box
  std::vector<double> distances_squared;  ///< as distance_squared() defines them; infinity without a box

  /// The boxes nearest to `box`, fewer than k if there are no more.
  [[nodiscard]] std::span<const BoxId> of(BoxId box) const {
    const std::size_t begin = index(box) * k;
    std::size_t end = begin + k;
    while (end > begin && boxes[end - 1] == no_box) --end;
    return {boxes.data() + begin, end - begin};
  }
};

namespace detail {

/// Writes the rows for all boxes of `left`, as BoxIndex::nearest_of_each() does. `right` is null for one set.
template <int D, typename Real>
BROADSIDE_PUBLIC void nearest_pairs(BoxView<D, Real> left, const BoxView<D, Real>* right, std::size_t k,
                                    const NearestPairsOptions& options, std::span<BoxId> boxes,
                                    std::span<double> distances_squared);

template <int D, typename Real>
BROADSIDE_CALLERS_VECTOR NearestPairs nearest_pairs(BoxView<D, Real> left, const BoxView<D, Real>* right,
                                                    std::size_t k, const NearestPairsOptions& options) {
  NearestPairs found{.k = k, .boxes = {}, .distances_squared = {}};
  // Where the product overflows, resize() throws std::length_error.
  const bool is_too_large = left.size() > 0 && k > found.boxes.max_size() / left.size();
  const std::size_t count = is_too_large ? std::numeric_limits<std::size_t>::max() : left.size() * k;
  found.boxes.resize(count);
  found.distances_squared.resize(count);
  nearest_pairs(left, right, k, options, std::span(found.boxes), std::span(found.distances_squared));
  return found;
}

}  // namespace detail

/// For each box, the k boxes of the same set that are nearest to it. A box is not its own neighbour, but
/// another one with the same bounds is, at distance 0.
///
///     const NearestPairs near = nearest_pairs(boxes, 3);
///     for (const BoxId other : near.of(box)) ...
///
/// Neighbours are sorted by distance_squared() and then by id. An absent box has none and is none. With
/// filters, only boxes that accept each other are neighbours. Throws InvalidInput, naming the first box with
/// a NaN or with min > max; InvalidFrame for a wrong number of filters; and InvalidQuery if k is 0 or
/// `max_distance` is negative or NaN. The result does not depend on threads or instruction set.
///
/// Builds a BoxIndex and asks it for each box, in an order in which neighbours in space follow one another.
template <BoxRange Boxes>
[[nodiscard]] NearestPairs nearest_pairs(const Boxes& boxes, std::size_t k,
                                         const NearestPairsOptions& options = {}) {
  using View = detail::ViewOf<Boxes>;
  return detail::nearest_pairs(View(boxes), static_cast<const View*>(nullptr), k, options);
}

/// The same for two sets: for each box of `left`, the k boxes of `right` that are nearest to it.
template <BoxRange Left, BoxRange Right>
requires std::convertible_to<const Right&, detail::ViewOf<Left>>
[[nodiscard]] NearestPairs nearest_pairs(const Left& left, const Right& right, std::size_t k,
                                         const NearestPairsOptions& options = {}) {
  using View = detail::ViewOf<Left>;
  const View of_right(right);
  return detail::nearest_pairs(View(left), &of_right, k, options);
}

}  // namespace broadside
