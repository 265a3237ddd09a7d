// find_pairs(): boxes to pairs in one call.
#pragma once

#include <concepts>
#include <cstddef>
#include <functional>
#include <ranges>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/error.hpp"
#include "broadside/executor.hpp"
#include "broadside/export.hpp"
#include "broadside/filter.hpp"
#include "broadside/finder.hpp"
#include "broadside/pair.hpp"
#include "broadside/sinks.hpp"
#include "broadside/spec.hpp"

namespace broadside {

/// How one call of find_pairs() searches.
struct BROADSIDE_CALLERS_VECTOR FindOptions {
  Spec algorithm{};                   ///< such as "grid:cell=2.5" or AutoOptions{.threads = 4}
  std::span<const Filter> filters{};  ///< as PairFilters has them
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
requires is_supported<Dimension, Coordinate>
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
inline FindOptions options_of(const Spec& algorithm) { return {.algorithm = algorithm}; }

/// Has a finder that the options describe search by `search`.
template <int D, typename Real, typename Search>
void find_with(const FindOptions& options, const Search& search) {
  Finder<D, Real> finder(options.algorithm);
  Workers workers = finder.workers();
  workers.executor = options.executor;
  finder.set_workers(workers);
  if (options.quarantined != nullptr) finder.set_bad_input(BadInput::quarantine);
  search(finder, PairFilters{options.filters, options.right_filters, options.ignored});
  if (options.quarantined != nullptr)
    options.quarantined->assign(finder.quarantined().begin(), finder.quarantined().end());
}

template <int D, typename Real>
void find_pairs(BoxView<D, Real> boxes, PairSink& pairs, const FindOptions& options) {
  find_with<D, Real>(options, [&](Finder<D, Real>& finder, const PairFilters& filters) {
    finder.find(boxes, pairs, filters);
  });
}

template <int D, typename Real>
void find_pairs(BoxView<D, Real> left, BoxView<D, Real> right, PairSink& pairs, const FindOptions& options) {
  find_with<D, Real>(options, [&](Finder<D, Real>& finder, const PairFilters& filters) {
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
concept FindOption = std::same_as<T, FindOptions> || std::convertible_to<const T&, Spec>;

namespace detail {

template <typename Things, typename Projection>
using ProjectedBox =
    std::remove_cvref_t<std::invoke_result_t<Projection&, std::ranges::range_reference_t<const Things>>>;

}  // namespace detail

/// A range of things that are not boxes themselves.
template <typename T>
concept ThingRange = !BoxArray<T> && std::ranges::forward_range<const T>;

/// Returns the box of a thing: a function that takes the thing, or a pointer to a member.
template <typename Projection, typename Things>
concept BoxProjection = std::ranges::forward_range<const Things> && requires {
  typename detail::BoxTraits<detail::ProjectedBox<Things, Projection>>::View;
};

namespace detail {

/// The box of each thing, in order.
template <typename Things, typename Projection>
std::vector<ProjectedBox<Things, Projection>> boxes_of(const Things& things, Projection& box_of) {
  std::vector<ProjectedBox<Things, Projection>> boxes;
  if constexpr (std::ranges::sized_range<const Things>) boxes.reserve(std::ranges::size(things));
  for (const auto& thing : things) boxes.push_back(std::invoke(box_of, thing));
  return boxes;
}

/// The pairs that search(sink) writes.
template <typename Search>
std::vector<Pair> collected(const Search& search) {
  std::vector<Pair> pairs;
  PairCollector collector(pairs);
  search(collector);
  return pairs;
}

template <typename Right, typename Left>
concept SameBoxes = std::is_same_v < typename ViewTraits<Left>::View,
typename ViewTraits<Right>::View > ;

/// The arguments that the last overloads of find_pairs() reject.
template <typename T, typename... Rest>
concept NoBoxes = ThingRange<T> && !(BoxProjection<Rest, T> || ...);
template <typename Right, typename Left>
concept OtherBoxes = BoxArray<Right> && !SameBoxes<Right, Left>;
template <typename T>
concept NoTarget = !BoxArray<T> && !PairTarget<T> && !FindOption<T>;

template <typename>
inline constexpr bool never = false;

}  // namespace detail

/// Writes every pair of overlapping boxes, once, as places in `boxes`, and flushes; in an order fixed by the
/// spec and the boxes. `pairs` is a PairSink, or a function of a Pair or of a std::span<const Pair>. An
/// exception from it ends the search.
///
/// Boxes are closed: touching counts. Exact in the precision of the boxes. Throws InvalidInput naming the
/// first box with a NaN or with min > max, InvalidFrame where there are filters and not one for each box, and
/// InvalidSpec. Thread-safe. A kept Finder saves the memory's allocation when calls are
/// many.
template <BoxArray Boxes, PairTarget Target, FindOption Options = FindOptions>
void find_pairs(const Boxes& boxes, Target&& pairs, const Options& options = {}) {
  using View = typename detail::ViewTraits<Boxes>::View;
  detail::with_sink(
      pairs, [&](PairSink& sink) { detail::find_pairs(View(boxes), sink, detail::options_of(options)); });
}

/// The same pairs in a vector.
template <BoxArray Boxes, FindOption Options = FindOptions>
std::vector<Pair> find_pairs(const Boxes& boxes, const Options& options = {}) {
  return detail::collected([&](PairSink& pairs) { find_pairs(boxes, pairs, options); });
}

/// Writes every pair of a box of `left` and an overlapping one of `right`, once, and flushes: a pair's first
/// is a place in `left` and its second one in `right`. The rest as for one array.
template <BoxArray Left, detail::SameBoxes<Left> Right, PairTarget Target, FindOption Options = FindOptions>
void find_pairs(const Left& left, const Right& right, Target&& pairs, const Options& options = {}) {
  using View = typename detail::ViewTraits<Left>::View;
  detail::with_sink(pairs, [&](PairSink& sink) {
    detail::find_pairs(View(left), View(right), sink, detail::options_of(options));
  });
}

/// The same pairs in a vector.
template <BoxArray Left, detail::SameBoxes<Left> Right, FindOption Options = FindOptions>
std::vector<Pair> find_pairs(const Left& left, const Right& right, const Options& options = {}) {
  return detail::collected([&](PairSink& pairs) { find_pairs(left, right, pairs, options); });
}

/// The pairs of things that have boxes, as in find_pairs(things, &Thing::box): a thing's box is
/// `box_of(thing)` or `thing.*box_of`. One pass gathers the boxes. The rest as for an array of boxes.
template <ThingRange Things, BoxProjection<Things> Projection, PairTarget Target,
          FindOption Options = FindOptions>
void find_pairs(const Things& things, Projection box_of, Target&& pairs, const Options& options = {}) {
  find_pairs(detail::boxes_of(things, box_of), pairs, options);
}
template <ThingRange Things, BoxProjection<Things> Projection, FindOption Options = FindOptions>
std::vector<Pair> find_pairs(const Things& things, Projection box_of, const Options& options = {}) {
  return find_pairs(detail::boxes_of(things, box_of), options);
}

/// For compatibility with version 0.2, which took the options before the projection.
template <ThingRange Things, BoxProjection<Things> Projection, FindOption Options = FindOptions>
std::vector<Pair> find_pairs(const Things& things, const Options& options, Projection box_of) {
  return find_pairs(detail::boxes_of(things, box_of), options);
}

/// The pairs between two sets of things. One set may hold boxes; its projection is then std::identity.
template <typename Left, typename Right, BoxProjection<Right> RightProjection,
          BoxProjection<Left> LeftProjection, PairTarget Target, FindOption Options = FindOptions>
void find_pairs(const Left& left, const Right& right, LeftProjection left_box_of,
                RightProjection right_box_of, Target&& pairs, const Options& options = {}) {
  find_pairs(detail::boxes_of(left, left_box_of), detail::boxes_of(right, right_box_of), pairs, options);
}
template <typename Left, typename Right, BoxProjection<Right> RightProjection,
          BoxProjection<Left> LeftProjection, FindOption Options = FindOptions>
std::vector<Pair> find_pairs(const Left& left, const Right& right, LeftProjection left_box_of,
                             RightProjection right_box_of, const Options& options = {}) {
  return find_pairs(detail::boxes_of(left, left_box_of), detail::boxes_of(right, right_box_of), options);
}

/// Reject calls that match no other overload, with a message of one sentence.
template <typename... Rest, detail::NoBoxes<Rest...> Things>
std::vector<Pair> find_pairs(const Things& /*things*/, const Rest&... /*rest*/) {
  static_assert(detail::never<Things>,
                "find_pairs() takes an array of boxes (a std::vector, std::span ... of Box<2>, Box<3>, "
                "DoubleBox2 or DoubleBox3), or things and their boxes: find_pairs(things, &Thing::box)");
  return {};
}
template <BoxArray Left, detail::OtherBoxes<Left> Right, typename... Rest>
std::vector<Pair> find_pairs(const Left& /*left*/, const Right& /*right*/, const Rest&... /*rest*/) {
  static_assert(detail::never<Left>,
                "find_pairs(left, right) takes boxes of one dimension and one type of coordinate");
  return {};
}
template <BoxArray Boxes, detail::NoTarget Target, FindOption... Options>
std::vector<Pair> find_pairs(const Boxes& /*boxes*/, const Target& /*pairs*/, const Options&... /*options*/) {
  static_assert(detail::never<Target>,
                "find_pairs(boxes, pairs) takes as pairs a PairSink, or a function of a Pair or of a "
                "std::span<const Pair>");
  return {};
}

}  // namespace broadside
