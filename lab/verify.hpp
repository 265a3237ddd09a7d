// The law, as functions: does an algorithm give exactly the pairs, and the events, that it must?
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "broadside/algorithm.hpp"

#include "lab/scenes/scene.hpp"

namespace broadside::lab {

/// The first place where an algorithm broke the law.
struct Divergence {
  enum class Kind { missing, extra, repeated };

  Kind kind;
  Pair pair;
  std::size_t frame = 0;  ///< 0 for a search, or the first frame
  std::string text;       ///< a sentence that names the algorithm, the frame, the pair and both boxes
};

/// Every pair of overlapping boxes, by the definition and nothing else: the independent reference. Sorted.
/// Cost n^2 / 2 tests. Absent boxes pair with nothing.
template <int D>
std::vector<Pair> reference_pairs(std::span<const Box<D>> boxes);

/// What differs first between `found`, in any order, and the sorted `expected`; empty if they are equal as
/// sets and each pair of `found` is there once.
std::optional<Divergence> compare_pairs(std::vector<Pair> found, std::span<const Pair> expected);

/// The same divergence, with the algorithm's name, what was looked at, the frame and both boxes in its text.
template <int D>
Divergence explained(Divergence divergence, std::string_view name, std::string_view what, std::size_t frame,
                     std::span<const Box<D>> boxes);

/// Whether `finder` gives the reference's pairs on `boxes`. `name` is for the divergence's text.
template <int D>
std::optional<Divergence> check_finder(PairFinder<D>& finder, std::span<const Box<D>> boxes,
                                       std::string_view name);

/// Whether `tracker`, over the whole history, gives in each frame exactly the events that lead from the
/// reference's pairs of the frame before to this frame's, sorted.
template <int D>
std::optional<Divergence> check_tracker(PairTracker<D>& tracker, const History<D>& history,
                                        std::string_view name);

}  // namespace broadside::lab
