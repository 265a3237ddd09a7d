// The reference that an algorithm's pairs are compared with: brute force if there are few enough boxes,
// otherwise an algorithm of another structure with a sample of its pairs checked.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "broadside/algorithm.hpp"

#include "lab/verify/verify.hpp"

namespace broadside::lab {

/// How many boxes are compared with all others if a reference is not brute force.
inline constexpr std::size_t sampled_boxes = 200;

/// The source of expected pairs.
class Reference {
 public:
  /// For pairs of `entry` on at most `boxes` boxes: brute force if there are at most `max_by_definition`.
  /// Otherwise the first of quadtree, sweep_and_prune and grid that is in `known` and whose name is not part
  /// of the entry's name; if there is none, brute force.
  Reference(const Algorithm& entry, std::span<const Algorithm> known, std::size_t boxes,
            std::size_t max_by_definition);

  /// "the definition", or as in "quadtree + 200 sampled boxes".
  std::string text() const;

  bool is_definition() const noexcept { return algorithm_ == nullptr; }

  /// The algorithm that computes the pairs; null for brute force.
  const Algorithm* algorithm() const noexcept { return algorithm_; }

  /// The expected pairs, sorted. Before check_sample(), reliable only if by brute force. Calls the checkpoint
  /// while searching and sorting.
  template <int D, typename Real = float>
  std::vector<Pair> pairs(BoxSpan<D, Real> boxes, const std::function<void()>& checkpoint = {}) const;

  friend bool operator==(const Reference&, const Reference&) = default;

 private:
  const Algorithm* algorithm_ = nullptr;
};

/// Compares sampled boxes with all others by brute force. Returns the first difference from `pairs`, or
/// empty. Compares all boxes if there are no more than the sample. `seed` selects the sample. Cost: the
/// sample times the boxes.
template <int D, typename Real = float>
std::optional<PairDivergence> check_sample(BoxSpan<D, Real> boxes, std::span<const Pair> pairs,
                                           std::uint64_t seed = 1);

/// The hash of a set of pairs, as PairHasher computes it.
std::uint64_t hash_of(std::span<const Pair> pairs) noexcept;

/// `count` of the numbers below `size`, or all if there are fewer; random, but always the same for a seed;
/// ascending.
std::vector<std::size_t> sample_of(std::size_t size, std::size_t count, std::uint64_t seed = 1);

/// Throws std::runtime_error if boxes have more than about 250,000,000 pairs (2 GB), estimated from a sample.
template <int D, typename Real = float>
void check_pair_count(BoxSpan<D, Real> boxes);

}  // namespace broadside::lab
