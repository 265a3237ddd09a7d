// The law, as functions: does an algorithm give exactly the pairs, and the events, that it must?
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

/// The first place where an algorithm broke the law.
struct PairDivergence {
  enum class Kind { missing, extra, repeated };

  Kind kind;
  Pair pair;
  std::size_t frame = 0;  ///< 0 for a search, or the first frame
  std::string text;       ///< a sentence that names the algorithm, the frame, the pair and both boxes
};

/// Boxes for a function whose caller names D and Real: they are not deduced.
template <int D, typename Real>
using BoxSpan = std::type_identity_t<std::span<const Box<D, Real>>>;

/// Every pair of overlapping boxes, by the definition and nothing else: the independent reference. Sorted.
/// Cost n^2 / 2 tests. Absent boxes pair with nothing.
template <int D, typename Real = float>
std::vector<Pair> reference_pairs(BoxSpan<D, Real> boxes);

/// Those of them that have one of the boxes at `places`, each place given once. Sorted. Cost: a test for each
/// place and box.
template <int D, typename Real = float>
std::vector<Pair> reference_pairs_of(BoxSpan<D, Real> boxes, std::span<const std::size_t> places);

/// Where expected pairs come from, sorted: reference_pairs, or something cheaper that is trusted.
template <int D, typename Real>
using ExpectedPairs = std::type_identity_t<std::function<std::vector<Pair>(std::span<const Box<D, Real>>)>>;

/// The first difference between `found`, in any order, and the sorted `expected`; empty if they are equal as
/// sets and `found` has each pair once.
std::optional<PairDivergence> compare_pairs(std::vector<Pair> found, std::span<const Pair> expected);

/// The same divergence, with the algorithm's name, what was looked at, the frame and both boxes in its text.
template <int D, typename Real = float>
PairDivergence explained(PairDivergence divergence, std::string_view name, std::string_view what,
                         std::size_t frame, BoxSpan<D, Real> boxes);

/// Whether `finder` gives the expected pairs on `boxes`. `name` and `frame` are for the divergence's text.
template <int D, typename Real>
std::optional<PairDivergence> check_finder(Finder<D, Real>& finder, BoxSpan<D, Real> boxes,
                                           std::string_view name,
                                           const ExpectedPairs<D, Real>& expected = reference_pairs<D, Real>,
                                           std::size_t frame = 0);

/// Whether `tracker`, over the whole history, gives in each frame exactly the events that lead from the
/// expected pairs of the frame before to this frame's, sorted.
template <int D, typename Real>
std::optional<PairDivergence> check_tracker(
    Tracker<D, Real>& tracker, const History<D, Real>& history, std::string_view name,
    const ExpectedPairs<D, Real>& expected = reference_pairs<D, Real>);

/// The first difference between a tracker's events of a frame and the ones that lead from the sorted pairs
/// `before` to `now`; empty if there is none and the events are sorted.
template <int D, typename Real = float>
std::optional<PairDivergence> check_events(const std::vector<Pair>& begun, const std::vector<Pair>& ended,
                                           std::span<const Pair> before, std::span<const Pair> now,
                                           std::string_view name, std::size_t frame, BoxSpan<D, Real> boxes);

}  // namespace broadside::lab
