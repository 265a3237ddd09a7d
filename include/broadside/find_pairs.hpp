// find_pairs(): boxes to pairs in one call.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <type_traits>
#include <vector>

#include "broadside/box_view.hpp"
#include "broadside/error.hpp"
#include "broadside/executor.hpp"
#include "broadside/export.hpp"
#include "broadside/filter.hpp"
#include "broadside/finder.hpp"
#include "broadside/pair.hpp"
#include "broadside/sinks.hpp"
#include "broadside/spec.hpp"

namespace broadside {

/// Options of find_pairs(), as in find_pairs(boxes, {.algorithm = "grid"}).
struct BROADSIDE_CALLERS_VECTOR FindOptions {
  Spec algorithm{};                         ///< such as "grid:cell=2.5" or AutoOptions{.threads = 4}
  std::span<const Filter> filters{};        ///< as in PairFilters
  std::span<const Filter> right_filters{};  ///< as in PairFilters
  const IgnoredPairs* ignored = nullptr;    ///< as in PairFilters
  Executor* executor = nullptr;             ///< as in Workers
  bool touching = true;                     ///< see Finder::set_touching()

  /// If not null, invalid boxes count as absent and are listed here, instead of being refused: see BadInput.
  std::vector<BoxId>* quarantined = nullptr;
};

namespace detail {

/// Calls `search` with a finder and filters made from the options.
template <int D, typename Real, typename Search>
void find_with(const FindOptions& options, const Search& search) {
  Finder<D, Real> finder(options.algorithm);
  Workers workers = finder.workers();
  workers.executor = options.executor;
  finder.set_workers(workers);
  finder.set_touching(options.touching);
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

template <typename>
inline constexpr bool never = false;

/// Rejects an argument that find_pairs() does not take, with a compile error of one sentence.
template <typename Boxes>
void refuse_boxes() {
  static_assert(never<Boxes>,
                "find_pairs() takes boxes (a std::vector, std::span ... of Box<2>, Box<3>, DoubleBox2 or "
                "DoubleBox3), or the boxes of things, as in find_pairs(boxes_of(things, &Thing::box))");
}
template <typename T>
void refuse_argument() {
  static_assert(
      never<T>,
      "find_pairs(boxes, ...) takes other boxes of the same type, a PairSink or a function of a Pair "
      "or of a std::span<const Pair>, and then options such as {.algorithm = \"grid\"}");
}

/// The number of boxes in ranges that find_pairs() takes. It refuses others.
template <typename... Boxes>
std::size_t box_count(const Boxes&... boxes) {
  if constexpr ((BoxRange<Boxes> && ...))
    return (ViewOf<Boxes>(boxes).size() + ...);
  else
    return 0;
}

/// Returns the pairs that find(sink) finds among `boxes` boxes. Reserves memory for most scenes' pairs: a
/// vector that grows writes to twice as many new pages. The pages that get no pairs take no memory.
template <typename Find>
std::vector<Pair> collect_pairs(std::size_t boxes, const Find& find) {
  constexpr std::size_t pairs_per_box = 3;
  constexpr std::size_t max_reserved = std::size_t{1} << 25;
  const std::size_t expected = pairs_per_box * boxes;
  std::vector<Pair> pairs;
  PairCollector collector(pairs, expected < max_reserved ? expected : max_reserved);
  find(static_cast<PairSink&>(collector));
  if (pairs.size() < pairs.capacity() / 2) pairs.shrink_to_fit();
  return pairs;
}

/// Any argument but the options.
template <typename T>
concept NoOptions = !std::is_same_v<std::remove_cvref_t<T>, FindOptions>;

/// A second argument that must be boxes, since it is neither options nor a target of pairs.
template <typename T>
concept OtherBoxes = NoOptions<T> && !PairTarget<T>;

}  // namespace detail

/// Writes each pair of overlapping boxes once, as indexes into `boxes`, and flushes. `pairs` is a PairSink,
/// or a function of a Pair or of a std::span<const Pair>. An exception from it ends the search. The spec and
/// the boxes determine the order of pairs.
///
/// Boxes are closed: touching counts, unless options.touching is false. Exact in the precision of the boxes.
/// Throws InvalidInput, naming the first box with a NaN or with min > max; InvalidFrame if there are filters,
/// but not one for each box; and InvalidSpec. Thread-safe. For many calls, keep a Finder, which keeps its
/// memory.
template <typename Boxes, PairTarget Target>
void find_pairs(const Boxes& boxes, Target&& pairs, const FindOptions& options = {}) {
  if constexpr (BoxRange<Boxes>)
    detail::with_sink(
        pairs, [&](PairSink& sink) { detail::find_pairs(detail::ViewOf<Boxes>(boxes), sink, options); });
  else
    detail::refuse_boxes<Boxes>();
}

/// Returns the same pairs in a vector.
template <typename Boxes>
[[nodiscard]] std::vector<Pair> find_pairs(const Boxes& boxes, const FindOptions& options = {}) {
  return detail::collect_pairs(detail::box_count(boxes),
                               [&](PairSink& pairs) { find_pairs(boxes, pairs, options); });
}

/// Writes each pair of a box of `left` and an overlapping box of `right` once, and flushes. A pair's `first`
/// is an index into `left`, its `second` an index into `right`. Otherwise as for one set of boxes.
template <typename Left, typename Right, detail::NoOptions Target>
void find_pairs(const Left& left, const Right& right, Target&& pairs, const FindOptions& options = {}) {
  if constexpr (!BoxRange<Left>) {
    detail::refuse_boxes<Left>();
  } else if constexpr (!std::is_convertible_v<const Right&, detail::ViewOf<Left>>) {
    detail::refuse_argument<Right>();
  } else if constexpr (!PairTarget<Target>) {
    detail::refuse_argument<Target>();
  } else {
    using View = detail::ViewOf<Left>;
    detail::with_sink(pairs,
                      [&](PairSink& sink) { detail::find_pairs(View(left), View(right), sink, options); });
  }
}

/// Returns the same pairs in a vector.
template <typename Left, detail::OtherBoxes Right>
[[nodiscard]] std::vector<Pair> find_pairs(const Left& left, const Right& right,
                                           const FindOptions& options = {}) {
  return detail::collect_pairs(detail::box_count(left, right),
                               [&](PairSink& pairs) { find_pairs(left, right, pairs, options); });
}

/// Copies the boxes of things, in order: `box_of` is a function of a thing or a pointer to a member. For
/// boxes in an array of structs, a BoxView needs no copy.
///
///     find_pairs(boxes_of(bodies, &Body::box));
template <typename Things, typename Projection>
[[nodiscard]] auto boxes_of(const Things& things, const Projection& box_of) {
  std::vector<std::remove_cvref_t<decltype(std::invoke(box_of, *things.begin()))>> boxes;
  if constexpr (requires { things.size(); }) boxes.reserve(things.size());
  for (const auto& thing : things) boxes.push_back(std::invoke(box_of, thing));
  return boxes;
}

}  // namespace broadside
