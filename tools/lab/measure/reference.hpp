// The reference for an algorithm's pairs: the definition where the boxes are few enough, otherwise an
// algorithm of another structure, whose own pairs are sampled.
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

/// How many boxes are compared with all others where a reference is not the definition.
inline constexpr std::size_t sampled_boxes = 200;

/// Where expected pairs come from.
class Reference {
 public:
  /// For pairs of `entry` on at most `boxes` boxes: the definition if these are at most
  /// `max_by_definition`; otherwise the first among quadtree, sweep_and_prune and grid that is in `known`,
  /// and whose name is no part of the entry's name; if there is none, the definition again.
  Reference(const Algorithm& entry, std::span<const Algorithm> known, std::size_t boxes,
            std::size_t max_by_definition);

  /// "the definition", or as in "quadtree + 200 sampled boxes".
  std::string text() const;

  bool is_definition() const noexcept { return algorithm_ == nullptr; }

  /// The algorithm that they come from; null if it is the definition.
  const Algorithm* algorithm() const noexcept { return algorithm_; }

  /// The expected pairs, sorted. Before check_sample(), only the definition can be relied on. Searching
  /// and sorting call the checkpoint.
  template <int D, typename Real = float>
  std::vector<Pair> pairs(BoxSpan<D, Real> boxes, const std::function<void()>& checkpoint = {}) const;

  friend bool operator==(const Reference&, const Reference&) = default;

 private:
  const Algorithm* algorithm_ = nullptr;
};

/// Compares sampled boxes with all others by the definition: what differs first from `pairs`, or empty. Where
/// the boxes are no more than the sample all are compared. `seed` is the sample's. Cost: the sample times the
/// boxes.
template <int D, typename Real = float>
std::optional<PairDivergence> check_sample(BoxSpan<D, Real> boxes, std::span<const Pair> pairs,
                                           std::uint64_t seed = 1);

/// The hash of a set of pairs, as PairHasher computes it.
std::uint64_t hash_of(std::span<const Pair> pairs) noexcept;

/// `count` of the numbers below `size`, or all if they are fewer, chosen at random but always the same for a
/// seed; ascending.
std::vector<std::size_t> sample_of(std::size_t size, std::size_t count, std::uint64_t seed = 1);

/// Throws std::runtime_error where boxes have more than some 250,000,000 pairs (2 GB), as estimated from a
/// sample.
template <int D, typename Real = float>
void check_pair_count(BoxSpan<D, Real> boxes);

}  // namespace broadside::lab
