// Queries to a BVH: the boxes that a box overlaps, that a cast box meets, or that are near a point.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "broadside/box.hpp"

#include "kernels/bvh.hpp"

namespace broadside::kernels {

/// The arrays that a search writes boxes to, with room for a leaf beyond `full`. A derived class handles the
/// boxes in take().
class FoundBoxes {
 public:
  static constexpr std::size_t max_found = 256;

  /// Handles the first `count` of `ids` (and `t_enter`), sets `count` to 0 and returns whether to go on. May
  /// lower `t_max`.
  virtual bool take() = 0;

  std::size_t count = 0;
  std::size_t full = fan_out;  ///< take() is called once this many are found
  float t_max = 0;             ///< of a cast: the greatest parameter at which a box counts
  alignas(64) std::array<std::uint32_t, max_found + 2 * fan_out> ids;
  alignas(64) std::array<float, max_found + 2 * fan_out> t_enter;  ///< of an exact cast

 protected:
  FoundBoxes() = default;
  ~FoundBoxes() = default;
};

/// How a cast goes along an axis.
enum class Course : std::uint8_t {
  forward,   ///< to greater coordinates
  backward,  ///< to smaller ones
  still,     ///< not at all: the box must overlap on this axis
  unknown,   ///< the tree's bounds must not be tested on this axis
};

/// A box cast along a direction.
template <int D>
struct CastQuery {
  Box<D> box;
  std::array<float, D> direction;  ///< used if `exact`
  std::array<float, D> inverse;    ///< 1 / direction, a normal number; used on forward and backward axes
  std::array<Course, D> course;    ///< in the tree; an exact search of a leaf tests unknown axes as well
  bool exact;                      ///< whether boxes are tested by the definition, with divisions
};

/// A query for what is near a box. A squared distance is the sum of the squares of the weighted gaps on the
/// axes, computed in float.
template <int D>
struct DistanceQuery {
  Box<D> box;
  std::array<float, D> weight;
};

/// Writes the boxes that overlap `box`; returns false if take() ended the search. The tree must have a root.
/// At the end, fewer than `full` boxes are left for the caller to take.
template <int D>
bool find_overlapping(const BvhView<D>& tree, const Box<D>& box, FoundBoxes& found);

/// Writes the boxes that the cast meets up to `found.t_max`, in no particular order.
template <int D>
bool find_met(const BvhView<D>& tree, const CastQuery<D>& cast, FoundBoxes& found);

/// Writes the boxes that the cast meets up to `found.t_max`, roughly the nearest first, and calls take() leaf
/// by leaf, so that `t_max` can be lowered.
template <int D>
void find_first_met(const BvhView<D>& tree, const CastQuery<D>& cast, FoundBoxes& found);

/// Writes the boxes whose squared distance is at most `found.t_max`: to `found.ids` their slots in the tree,
/// to `found.t_enter` the distances. Of a node's children, goes to the nearest one first.
template <int D>
void find_near(const BvhView<D>& tree, const DistanceQuery<D>& query, FoundBoxes& found);

/// Sixteen queries that are close to each other, and the boxes nearest to each: lists, one per lane, of keys
/// in ascending order. A key is a squared distance as in DistanceQuery, rounded down, with the box's number
/// as its last bits. So one minimum and one maximum take a box a step down a list.
///
/// A list's last key is a bound: if it is within `limit`, no box outside the list's other places is nearer.
template <int D>
struct NearGroup {
  static constexpr std::size_t max_count = 32;
  static constexpr std::int32_t number_mask = 0x7ff;  ///< the bits of a key that are a number
  static constexpr std::size_t max_leaves = (number_mask + 1) / fan_out;
  static constexpr std::size_t max_tested = 1024;     ///< and up to a leaf's boxes more
  static constexpr std::int32_t no_key = 0x7f7fffff;  ///< after a list's last key; greater than any key

  /// Empties the lists, and gives each room for `size` boxes, from 2 to max_count.
  void start(std::size_t size);

  /// The slot in the tree of the box with this key.
  std::uint32_t slot(std::int32_t key) const {
    const auto number = static_cast<std::uint32_t>(key & number_mask);
    return static_cast<std::uint32_t>(leaves[number / fan_out] * fan_out + number % fan_out);
  }

  Block<D> queries;  ///< lanes without a query hold nan_box()
  std::array<float, D> weight;

  /// If the queries are the boxes of a leaf, lane by lane, its number: a box is then not listed for itself.
  /// Otherwise no_slot.
  std::uint32_t own_leaf = no_slot;

  /// Whether all boxes of the tree and the queries may be taken for their lower bounds, which are finite and
  /// at most 2^60, with weights of 1: they are points, or `error` of the lower bounds' length from points.
  bool are_points = false;
  float error = 0;

  /// Boxes that are farther away need not be found. A search lowers it to how far it has looked: at least a
  /// little beyond all boxes of a list but the last; below 0 if it gave up since it had tested max_tested
  /// boxes, or those of max_leaves leaves.
  float limit;

  std::size_t count;
  std::size_t tested;  ///< boxes that were compared with each query
  alignas(64) std::array<std::array<std::int32_t, fan_out>, max_count> keys;
  std::array<std::uint32_t, max_leaves> leaves;  ///< a box's number is its leaf's place here and its lane
};

/// Fills the lists, by one traversal for all queries.
template <int D>
void find_near(const BvhView<D>& tree, NearGroup<D>& group);

}  // namespace broadside::kernels
