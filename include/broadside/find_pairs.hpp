// find_pairs: all overlapping pairs of an array of boxes, or of one array with another, in one call.
#pragma once

#include <concepts>
#include <functional>
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

/// How one call of find_pairs() searches.
struct FindOptions {
  std::string_view algorithm = default_algorithm;  ///< the spec, such as "grid:cell=2.5" or "auto:threads=4"
  std::span<const Filter> filters{};               ///< as PairFilters has them
  std::span<const Filter> right_filters{};
  const IgnoredPairs* ignored = nullptr;
  Executor* executor = nullptr;  ///< whose threads search; null for the library's own

  /// Where it is given, invalid boxes count as absent and are listed here instead of being thrown about: see
  /// BadInput.
  std::vector<BoxId>* quarantined = nullptr;
};

namespace detail {

template <typename T>
struct BoxTraits {};

template <int Dimension, typename Coordinate>
struct BoxTraits<Box<Dimension, Coordinate>> {
  using View = BoxView<Dimension, Coordinate>;
};

template <typename T>
struct ViewTraits {};

template <int Dimension, typename Coordinate>
struct ViewTraits<BoxView<Dimension, Coordinate>> {
  using View = BoxView<Dimension, Coordinate>;
};

template <typename T>
requires std::ranges::contiguous_range<const T> && std::ranges::sized_range<const T>
struct ViewTraits<T> : BoxTraits<std::ranges::range_value_t<T>> {
};

inline const FindOptions& options_of(const FindOptions& options) { return options; }
inline FindOptions options_of(std::string_view algorithm) { return {.algorithm = algorithm}; }

/// Has a finder that the options describe search by `search`.
template <int D, typename Real, typename Search>
void find_with(const FindOptions& options, const Search& search) {
  const auto finder = make_finder<D, Real>(options.algorithm);
  Workers workers = finder->workers();
  workers.executor = options.executor;
  finder->set_workers(workers);
  if (options.quarantined != nullptr) finder->set_bad_input(BadInput::quarantine);
  search(*finder, PairFilters{options.filters, options.right_filters, options.ignored});
  if (options.quarantined != nullptr)
    options.quarantined->assign(finder->quarantined().begin(), finder->quarantined().end());
}

template <int D, typename Real>
void find_pairs(BoxView<D, Real> boxes, PairSink& pairs, const FindOptions& options) {
  find_with<D, Real>(options, [&](PairFinder<D, Real>& finder, const PairFilters& filters) {
    finder.find(boxes, pairs, filters);
  });
}

template <int D, typename Real>
void find_pairs(BoxView<D, Real> left, BoxView<D, Real> right, PairSink& pairs, const FindOptions& options) {
  find_with<D, Real>(options, [&](PairFinder<D, Real>& finder, const PairFilters& filters) {
    finder.find_between(left, right, pairs, filters);
  });
}

}  // namespace detail

/// Boxes: a std::vector, std::array, std::span ... of Box<2>, Box<3>, DoubleBox2 or DoubleBox3; or a BoxView
/// of them in structs of the caller's own.
template <typename T>
concept BoxArray = requires {
  typename detail::ViewTraits<T>::View;
};

/// FindOptions, or the spec alone.
template <typename T>
concept FindOption = std::same_as<T, FindOptions> || std::convertible_to<const T&, std::string_view>;

/// Writes every pair of overlapping boxes, once, as places in `boxes`, and flushes; in an order fixed by the
/// spec and the boxes.
///
/// Boxes are closed: touching counts. Exact in the precision of the boxes. Throws InvalidInput naming the
/// first box with a NaN or with min > max, InvalidFrame where there are filters and not one for each box, and
/// InvalidSpec. Thread-safe. A finder kept from make_finder() saves the memory's allocation when calls are
/// many.
template <BoxArray Boxes, FindOption Options = FindOptions>
void find_pairs(const Boxes& boxes, PairSink& pairs, const Options& options = {}) {
  using View = typename detail::ViewTraits<Boxes>::View;
  detail::find_pairs(View(boxes), pairs, detail::options_of(options));
}

/// The same pairs in a vector.
template <BoxArray Boxes, FindOption Options = FindOptions>
std::vector<Pair> find_pairs(const Boxes& boxes, const Options& options = {}) {
  std::vector<Pair> pairs;
  PairCollector collector(pairs);
  find_pairs(boxes, collector, options);
  return pairs;
}

/// Writes every pair of a box of `left` and an overlapping one of `right`, once, and flushes: a pair's first
/// is a place in `left` and its second one in `right`. The rest as for one array.
template <BoxArray Left, BoxArray Right, FindOption Options = FindOptions>
requires std::same_as < typename detail::ViewTraits<Left>::View,
typename detail::ViewTraits<Right>::View >
    void find_pairs(const Left& left, const Right& right, PairSink& pairs, const Options& options = {}) {
  using View = typename detail::ViewTraits<Left>::View;
  detail::find_pairs(View(left), View(right), pairs, detail::options_of(options));
}

/// The same pairs in a vector.
template <BoxArray Left, BoxArray Right, FindOption Options = FindOptions>
requires std::same_as < typename detail::ViewTraits<Left>::View,
typename detail::ViewTraits<Right>::View >
    std::vector<Pair> find_pairs(const Left& left, const Right& right, const Options& options = {}) {
  std::vector<Pair> pairs;
  PairCollector collector(pairs);
  find_pairs(left, right, collector, options);
  return pairs;
}

/// The pairs of things that have boxes: `box_of(thing)` or `thing.*box_of` is a thing's box. One pass gathers
/// the boxes.
template <std::ranges::forward_range Things, typename Projection, FindOption Options = FindOptions>
requires(!BoxArray<Things>) std::vector<Pair> find_pairs(const Things& things, const Options& options,
                                                         Projection box_of) {
  using Box =
      std::remove_cvref_t<std::invoke_result_t<Projection&, std::ranges::range_reference_t<const Things>>>;
  std::vector<Box> boxes;
  if constexpr (std::ranges::sized_range<const Things>) boxes.reserve(std::ranges::size(things));
  for (const auto& thing : things) boxes.push_back(std::invoke(box_of, thing));
  return find_pairs(boxes, options);
}

}  // namespace broadside
