// Boxes to pairs, from nothing, at each call: find_pairs(), and PairFinder, the interface of every algorithm.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <ranges>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/error.hpp"
#include "broadside/executor.hpp"
#include "broadside/export.hpp"
#include "broadside/filter.hpp"
#include "broadside/pair.hpp"
#include "broadside/sinks.hpp"

namespace broadside {

/// What one search or one update did, in the paper's units of cost; 0 where an algorithm does not count it.
struct Statistics {
  std::uint64_t tests = 0;       ///< pairs of boxes compared
  std::uint64_t references = 0;  ///< entries of boxes in cells, leaves or lists
  std::uint64_t cells = 0;       ///< cells or nodes that there are
  std::uint64_t hits = 0;  ///< of the tests, those of boxes that overlap; the others are false positives
};

namespace core {
template <int D>
class Yielding;
template <int D>
class LastTest;
}  // namespace core

template <int D, typename Real = float>
class Outlined;

/// Finds every overlapping pair in an array of boxes, from nothing, at each call.
///
/// A finder keeps its scratch memory between calls, and nothing else that can be observed. To be called by
/// one thread at a time; it may itself use several, which shows in nothing but the time.
template <int D, typename Real = float>
class BROADSIDE_PUBLIC PairFinder {
  static_assert(detail::SupportedBox<D, Real>::value);

 public:
  PairFinder() = default;
  PairFinder(const PairFinder&) = delete;
  PairFinder& operator=(const PairFinder&) = delete;
  virtual ~PairFinder() = default;

  /// Writes each pair of overlapping boxes to `pairs` once, as ids = places in `boxes`, and flushes it. The
  /// order is fixed by the algorithm and the boxes, whatever the workers. Absent boxes pair with nothing.
  ///
  /// Throws InvalidInput, naming index and values, before anything is written if a box has a NaN, or min >
  /// max without being absent, unless bad_input() says otherwise; and what the sink throws.
  /// Boxes that are no array are gathered first. With `filters`, pairs that they do not let count are not
  /// written; throws InvalidFrame if there are some and not one for each box.
  void find(BoxView<D, Real> boxes, PairSink& pairs, const PairFilters& filters = {});

  /// Writes each pair of a box of `left` and an overlapping one of `right` once, and flushes. A pair's first
  /// is a place in `left` and its second one in `right`, so the two may be equal. No pair within a set is
  /// ever written; the library's own algorithms do not even look for one. Throws as find() does.
  void find_between(BoxView<D, Real> left, BoxView<D, Real> right, PairSink& pairs,
                    const PairFilters& filters = {});

  /// The same for two sets that lie one behind the other: the first `left_count` <= boxes.size() boxes are
  /// the left set. Where none is absent this saves copying them.
  void find_between(std::span<const Box<D, Real>> boxes, std::size_t left_count, PairSink& pairs);

  /// The same with a function instead of a sink: of a Pair, or of a std::span<const Pair>.
  template <PairCallback Function>
  void find(BoxView<D, Real> boxes, Function&& function, const PairFilters& filters = {}) {
    detail::with_sink(function, [&](PairSink& pairs) { find(boxes, pairs, filters); });
  }
  template <PairCallback Function>
  void find_between(BoxView<D, Real> left, BoxView<D, Real> right, Function&& function,
                    const PairFilters& filters = {}) {
    detail::with_sink(function, [&](PairSink& pairs) { find_between(left, right, pairs, filters); });
  }

  /// What find() and find_between() do about invalid boxes: they throw, unless set_bad_input() says
  /// otherwise.
  BadInput bad_input() const noexcept { return bad_input_; }
  void set_bad_input(BadInput bad_input) noexcept { bad_input_ = bad_input; }

  /// The places of the last call's invalid boxes, ascending, where they are quarantined; those of a right set
  /// are counted on from the end of the left one. Valid until the next call.
  std::span<const BoxId> quarantined() const noexcept { return quarantined_; }

  /// What the last find() did; empty where the algorithm does not count.
  const std::optional<Statistics>& statistics() const noexcept { return statistics_; }

  /// Who does the work: one thread, unless the spec or set_workers() says otherwise. An algorithm without the
  /// tunable `threads` uses the calling thread alone.
  const Workers& workers() const noexcept { return workers_; }
  void set_workers(const Workers& workers) { workers_ = workers; }

  /// Where the algorithm is one that chooses: what it chose for the last find(), and why, in a sentence.
  /// Empty for others.
  virtual std::string explanation() const { return {}; }

  /// What it lays over boxes, to be drawn, where it lays something: see outline().
  virtual Outlined<D, Real>* outlined() noexcept { return nullptr; }

  /// For the library: this finder, if its searches can give up.
  virtual core::Yielding<D>* yielding() noexcept { return nullptr; }

  /// For the library: this finder, if its kernels do the last test of boxes of doubles.
  virtual core::LastTest<D>* last_test() noexcept { return nullptr; }

 protected:
  /// For find_valid: what this search did.
  void count(const Statistics& statistics) { statistics_ = statistics; }

  /// For find_valid: lets another finder do this search, with the same workers. Its statistics are then this
  /// finder's.
  template <typename OtherReal>
  void search_with(PairFinder<D, OtherReal>& other, std::span<const Box<D, OtherReal>> boxes,
                   PairSink& pairs) {
    other.left_count_ = left_count_;
    other.set_workers(workers_);
    other.statistics_.reset();
    other.find_valid(boxes, pairs);
    statistics_ = other.statistics_;
  }

  /// For find_valid: 0 if every overlapping pair is asked for. Else the boxes before this place are the left
  /// set and the others the right one, and pairs within a set need not be written: they will be dropped.
  std::size_t left_count() const noexcept { return left_count_; }

 private:
  template <int, typename>
  friend class PairFinder;

  /// The search, implemented by each algorithm. `boxes` are all present: min <= max, no NaN, perhaps
  /// infinite. Pairs hold indexes into `boxes`. No need to flush. `boxes` may be the caller's own array, and
  /// another thread may break the rules and write to it. Two reads of a box may then differ, but must not
  /// cause an access out of bounds.
  virtual void find_valid(std::span<const Box<D, Real>> boxes, PairSink& pairs) = 0;

  /// find_between() for boxes that are all present.
  void find_valid_between(std::span<const Box<D, Real>> boxes, std::size_t left_count, PairSink& pairs);

  /// Checks the boxes, and returns how many are absent or quarantined.
  std::size_t check(std::span<const Box<D, Real>> boxes, const char* which = "") const;

  /// Appends the places of the invalid ones of `boxes` to quarantined_, counted on from `first`.
  void list_invalid(std::span<const Box<D, Real>> boxes, std::size_t first);

  /// Appends the present ones of `boxes` to present_ and their places to ids_.
  void take_present(std::span<const Box<D, Real>> boxes);

  std::array<detail::Vector<Box<D, Real>>, 2> gathered_;  // boxes that were not given as an array
  detail::Vector<Box<D, Real>> present_;  // the boxes without the absent ones; unused while one set has none
  detail::Vector<BoxId> ids_;             // their indexes in the caller's array
  detail::Vector<BoxId> quarantined_;
  BadInput bad_input_ = BadInput::reject;
  std::size_t left_count_ = 0;
  std::optional<Statistics> statistics_;
  Workers workers_;
};

/// The spec that find_pairs() and World use unless told otherwise.
inline constexpr std::string_view default_algorithm = "auto";

/// Makes a finder of one of algorithms(), from a spec such as "grid:cell=2.5". Throws InvalidSpec, naming the
/// algorithms there are, if there is none of that name.
///
/// Algorithms work on floats. A finder of boxes of doubles rounds them to floats in the same order, about an
/// origin and at a scale of their own, and has a last test in double: its pairs are exact.
template <int D, typename Real = float>
BROADSIDE_PUBLIC std::unique_ptr<PairFinder<D, Real>> make_finder(std::string_view spec);

/// How one call of find_pairs() searches.
struct BROADSIDE_CALLERS_VECTOR FindOptions {
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
/// InvalidSpec. Thread-safe. A finder kept from make_finder() saves the memory's allocation when calls are
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
