// The equivalence test: checks that an algorithm gives exactly the pairs, and the events, of a brute-force
// reference.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "broadside/finder.hpp"
#include "broadside/tracker.hpp"

#include "lab/scenes/scene.hpp"

namespace broadside::lab {

/// The first difference between an algorithm's result and the expected one.
struct PairDivergence {
  enum class Kind { missing, extra, repeated };

  Kind kind;
  Pair pair;
  std::size_t frame = 0;  ///< 0 for a search, or the first frame
  std::string text;       ///< a sentence that gives the algorithm, the frame, the pair and both boxes
};

/// Boxes of a function whose caller specifies D and Real: they are not deduced.
template <int D, typename Real>
using BoxSpan = std::type_identity_t<std::span<const Box<D, Real>>>;

/// Every pair of overlapping boxes, by brute force: the independent reference. Sorted. Cost: n^2 / 2 tests.
/// Absent boxes have no pairs.
template <int D, typename Real = float>
std::vector<Pair> reference_pairs(BoxSpan<D, Real> boxes);

/// The pairs among these with at least one of the boxes at `places`, each of which is listed once. Sorted.
/// Cost: a test for each place and box.
template <int D, typename Real = float>
std::vector<Pair> reference_pairs_of(BoxSpan<D, Real> boxes, std::span<const std::size_t> places);

/// The source of expected pairs, sorted: reference_pairs(), or something faster that is trusted.
template <int D, typename Real>
using ExpectedPairs = std::type_identity_t<std::function<std::vector<Pair>(std::span<const Box<D, Real>>)>>;

/// The first difference between `found`, in any order, and the sorted `expected`; empty if they are equal as
/// sets and `found` has each pair once.
std::optional<PairDivergence> compare_pairs(std::vector<Pair> found, std::span<const Pair> expected);

/// The same divergence, with the algorithm's name, what was checked, the frame and both boxes in its text.
template <int D, typename Real = float>
PairDivergence explained(PairDivergence divergence, std::string_view name, std::string_view what,
                         std::size_t frame, BoxSpan<D, Real> boxes);

/// Checks that `finder` gives the expected pairs on `boxes`; returns the first difference. `name` and `frame`
/// are for its text.
template <int D, typename Real>
std::optional<PairDivergence> check_finder(Finder<D, Real>& finder, BoxSpan<D, Real> boxes,
                                           std::string_view name,
                                           const ExpectedPairs<D, Real>& expected = reference_pairs<D, Real>,
                                           std::size_t frame = 0);

/// Checks that in each frame of the history `tracker` gives exactly the events between the expected pairs of
/// the previous frame and of this one, sorted; returns the first difference.
template <int D, typename Real>
std::optional<PairDivergence> check_tracker(
    Tracker<D, Real>& tracker, const History<D, Real>& history, std::string_view name,
    const ExpectedPairs<D, Real>& expected = reference_pairs<D, Real>);

/// The first difference between a tracker's events of a frame and the events between the sorted pairs
/// `before` and `now`; empty if there is none and the events are sorted.
template <int D, typename Real = float>
std::optional<PairDivergence> check_events(const std::vector<Pair>& begun, const std::vector<Pair>& ended,
                                           std::span<const Pair> before, std::span<const Pair> now,
                                           std::string_view name, std::size_t frame, BoxSpan<D, Real> boxes);

}  // namespace broadside::lab
