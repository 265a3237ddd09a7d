// Finder: finds all pairs in an array of boxes, from scratch at each call.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "broadside/box.hpp"
#include "broadside/box_view.hpp"
#include "broadside/error.hpp"
#include "broadside/executor.hpp"
#include "broadside/export.hpp"
#include "broadside/filter.hpp"
#include "broadside/pair.hpp"
#include "broadside/searcher.hpp"
#include "broadside/sinks.hpp"
#include "broadside/spec.hpp"

namespace broadside {

struct Algorithm;

/// Finds every overlapping pair in an array of boxes, from scratch at each call.
///
/// Between calls, a finder keeps scratch memory and nothing else that affects results. Call it from one
/// thread at a time; it may itself use several, which affects only the time. A finder that was moved from may
/// only be assigned to or destroyed.
///
/// Algorithms work on floats. A finder of double boxes first rounds them to floats, about an origin and at a
/// scale that suit them. Rounding keeps the order of coordinates, and pairs that floats cannot decide are
/// tested in double, so the pairs are exact.
template <int D, typename Real = float>
class BROADSIDE_PUBLIC Finder final {
  static_assert(detail::SupportedBox<D, Real>::value);

 public:
  /// A finder that uses one of algorithms(), from a spec such as "grid:cell=2.5" or GridOptions{.cell = 2.5}.
  /// Throws InvalidSpec if the spec is wrong. If the name is unknown, the message lists all algorithms.
  explicit Finder(const Spec& spec = {});

  /// A finder that uses `algorithm` with the values in `spec`; the name in `spec` is ignored. Throws
  /// InvalidSpec if a value is wrong or the algorithm does not support D dimensions.
  Finder(const Algorithm& algorithm, const Spec& spec);

  /// A finder that uses your own searcher. The searcher compares floats; pairs of double boxes are tested in
  /// double afterwards. Throws std::invalid_argument if it is null.
  explicit Finder(std::unique_ptr<Searcher<D>> searcher);

  Finder(Finder&& other) noexcept;
  Finder& operator=(Finder&& other) noexcept;
  ~Finder();

  /// Writes each pair of overlapping boxes to `pairs` once, as indexes into `boxes`, and flushes it. The
  /// order depends on the algorithm, the boxes and the filters, not on the workers. Absent boxes form no
  /// pairs. With `filters`, leaves out the pairs that they reject. Returns what the search did, or nothing if
  /// the algorithm does not count. A view with a stride is first copied into an array.
  ///
  /// Throws InvalidInput, naming index and values, before anything is written if a box has a NaN, or min >
  /// max without being absent, unless bad_input() says otherwise. Throws InvalidFrame if there are filters,
  /// but not one for each box. Exceptions from the sink pass through.
  std::optional<Statistics> find(BoxView<D, Real> boxes, PairSink& pairs, const PairFilters& filters = {});

  /// Writes each pair of a box of `left` and an overlapping box of `right` once, and flushes. A pair's
  /// `first` is an index into `left` and its `second` an index into `right`, so the two may be equal. Never
  /// writes pairs within a set; the library's own algorithms do not even look for them. Throws as find()
  /// does.
  std::optional<Statistics> find_between(BoxView<D, Real> left, BoxView<D, Real> right, PairSink& pairs,
                                         const PairFilters& filters = {});

  /// find_between() for two sets in one array: the first `left_count` <= boxes.size() boxes are the left set.
  /// If none is absent, they are not copied.
  std::optional<Statistics> find_across(std::span<const Box<D, Real>> boxes, std::size_t left_count,
                                        PairSink& pairs);

  /// The same with a function instead of a sink: of a Pair, or of a std::span<const Pair>.
  template <PairCallback Function>
  std::optional<Statistics> find(BoxView<D, Real> boxes, Function&& function,
                                 const PairFilters& filters = {}) {
    PairFunction<Function&> pairs(function);
    return find(boxes, static_cast<PairSink&>(pairs), filters);
  }
  template <PairCallback Function>
  std::optional<Statistics> find_between(BoxView<D, Real> left, BoxView<D, Real> right, Function&& function,
                                         const PairFilters& filters = {}) {
    PairFunction<Function&> pairs(function);
    return find_between(left, right, static_cast<PairSink&>(pairs), filters);
  }

  /// What find() and find_between() do with invalid boxes: they throw, unless set_bad_input() says otherwise.
  [[nodiscard]] BadInput bad_input() const noexcept;
  void set_bad_input(BadInput bad_input) noexcept;

  /// The indexes of the last call's quarantined boxes, ascending. Those of a right set count on from the end
  /// of the left set. Valid until the next call.
  [[nodiscard]] std::span<const BoxId> quarantined() const noexcept;

  /// Whether boxes that only touch overlap; true by default. If false, each search copies the boxes with
  /// half_open(), which costs one pass over them. The answer stays exact.
  [[nodiscard]] bool touching() const noexcept;
  void set_touching(bool touching) noexcept;

  /// The threads to search with: one, unless the spec or set_workers() says otherwise. An algorithm without
  /// the tunable `threads` uses the calling thread alone.
  [[nodiscard]] const Workers& workers() const noexcept;
  void set_workers(const Workers& workers);

  /// If the algorithm chooses among others: what it chose for the last search and why, in one sentence.
  [[nodiscard]] std::string explanation() const;

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace broadside
