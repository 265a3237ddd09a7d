// find_pairs: all overlapping pairs of an array of boxes, or of one array with another, in one call.
#pragma once

#include <ranges>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "broadside/algorithm.hpp"
#include "broadside/box.hpp"
#include "broadside/executor.hpp"
#include "broadside/pair.hpp"
#include "broadside/sinks.hpp"

namespace broadside {

namespace detail {
template <typename T>
struct BoxTraits;
template <int Dimension, typename Coordinate>
struct BoxTraits<Box<Dimension, Coordinate>> {
  static constexpr int dimension = Dimension;
  using Real = Coordinate;
};

template <typename Box>
auto make_finder_of(std::string_view spec, Executor* executor, const std::vector<BoxId>* quarantined) {
  using Traits = BoxTraits<Box>;
  auto finder = make_finder<Traits::dimension, typename Traits::Real>(spec);
  Workers workers = finder->workers();
  workers.executor = executor;
  finder->set_workers(workers);
  if (quarantined != nullptr) finder->set_bad_input(BadInput::quarantine);
  return finder;
}

inline void list(std::span<const BoxId> ids, std::vector<BoxId>* quarantined) {
  if (quarantined != nullptr) quarantined->assign(ids.begin(), ids.end());
}
}  // namespace detail

/// An array of boxes: std::vector, std::array, std::span ... of Box<2>, Box<3>, DoubleBox2 or DoubleBox3.
template <typename T>
concept BoxArray = std::ranges::contiguous_range<const T> && std::ranges::sized_range<const T> && requires {
  detail::BoxTraits<std::ranges::range_value_t<T>>::dimension;
};

/// Writes every pair of overlapping boxes, once, as places in `boxes`, and flushes; in an order fixed by the
/// spec and the boxes.
///
/// Boxes are closed: touching counts. Exact in the precision of the boxes. Throws InvalidInput naming the
/// first box with a NaN or with min > max, and InvalidSpec. Thread-safe. A finder kept from make_finder()
/// saves the memory's allocation when calls are many. A spec such as "grid:threads=4" has several threads
/// search: those of `executor` if there is one. Where `quarantined` is given, invalid boxes count as absent
/// and are listed there instead of being thrown about: see BadInput.
template <BoxArray Boxes>
void find_pairs(const Boxes& boxes, PairSink& pairs, std::string_view spec = default_algorithm,
                Executor* executor = nullptr, std::vector<BoxId>* quarantined = nullptr) {
  using Box = std::ranges::range_value_t<Boxes>;
  const auto finder = detail::make_finder_of<Box>(spec, executor, quarantined);
  finder->find(std::span<const Box>(boxes), pairs);
  detail::list(finder->quarantined(), quarantined);
}

/// The same pairs in a vector.
template <BoxArray Boxes>
std::vector<Pair> find_pairs(const Boxes& boxes, std::string_view spec = default_algorithm,
                             Executor* executor = nullptr, std::vector<BoxId>* quarantined = nullptr) {
  std::vector<Pair> pairs;
  PairCollector collector(pairs);
  find_pairs(boxes, collector, spec, executor, quarantined);
  return pairs;
}

/// Writes every pair of a box of `left` and an overlapping one of `right`, once, and flushes: a pair's first
/// is a place in `left` and its second one in `right`. The rest as for one array.
template <BoxArray Left, BoxArray Right>
requires std::is_same_v<std::ranges::range_value_t<Left>, std::ranges::range_value_t<Right>>
void find_pairs(const Left& left, const Right& right, PairSink& pairs,
                std::string_view spec = default_algorithm, Executor* executor = nullptr,
                std::vector<BoxId>* quarantined = nullptr) {
  using Box = std::ranges::range_value_t<Left>;
  const auto finder = detail::make_finder_of<Box>(spec, executor, quarantined);
  finder->find_between(std::span<const Box>(left), std::span<const Box>(right), pairs);
  detail::list(finder->quarantined(), quarantined);
}

/// The same pairs in a vector.
template <BoxArray Left, BoxArray Right>
requires std::is_same_v<std::ranges::range_value_t<Left>, std::ranges::range_value_t<Right>> std::vector<Pair>
find_pairs(const Left& left, const Right& right, std::string_view spec = default_algorithm,
           Executor* executor = nullptr, std::vector<BoxId>* quarantined = nullptr) {
  std::vector<Pair> pairs;
  PairCollector collector(pairs);
  find_pairs(left, right, collector, spec, executor, quarantined);
  return pairs;
}

}  // namespace broadside
