// A tree of boxes that is asked what a box overlaps, what a moved box meets, and what is near a point.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadside/box.hpp"

namespace broadside::kernels {

/// How many children a node of a tree of queries has at most.
inline constexpr std::size_t node_width = 16;

/// More than a path through such a tree is ever long.
inline constexpr std::size_t longest_path = 32;

/// Says of a number of a node that it is a leaf, and its children are boxes.
inline constexpr std::uint32_t leaf_bit = 0x80000000U;

/// Bounds of up to sixteen nodes, or sixteen boxes, and their numbers. Places without a child hold NaN.
template <int D>
struct alignas(64) QueryNode {
  std::array<std::array<float, node_width>, D> min;
  std::array<std::array<float, node_width>, D> max;
  std::array<std::uint32_t, node_width> child;
};

/// A tree to search. `root` is a node's number and perhaps leaf_bit, as the numbers of children are.
template <int D>
struct QueryTree {
  const QueryNode<D>* nodes;
  std::uint32_t root;
};

/// Where a search writes boxes: into arrays with room for a leaf beyond `full`. Whoever derives from it looks
/// at them in take().
class FoundBoxes {
 public:
  static constexpr std::size_t most = 256;

  /// Deals with the first `count` of `ids` (and `entries`) and sets `count` to 0; whether to go on. May lower
  /// `furthest`.
  virtual bool take() = 0;

  std::size_t count = 0;
  std::size_t full = node_width;  ///< take() is called once there are as many
  float furthest = 0;             ///< of a cast: up to which parameter boxes count
  alignas(64) std::array<std::uint32_t, most + 2 * node_width> ids;
  alignas(64) std::array<float, most + 2 * node_width> entries;  ///< of an exact cast: where they are entered

 protected:
  FoundBoxes() = default;
  ~FoundBoxes() = default;
};

/// How a cast goes along an axis.
enum class Course : std::uint8_t {
  forward,   ///< to greater coordinates
  backward,  ///< to smaller ones
  still,     ///< not at all: the box must overlap on this axis
  unknown,   ///< the tree's bounds are not to be looked at on this axis
};

/// A box cast along a direction.
template <int D>
struct CastQuery {
  Box<D> box;
  std::array<float, D> direction;  ///< looked at where `exact`
  std::array<float, D> inverse;    ///< of the direction, rounded, a normal number; on axes that are not still
  std::array<Course, D> course;  ///< in the tree; in a leaf searched exactly, unknown axes are looked at too
  bool exact;                    ///< whether boxes are tested by the definition, with divisions
};

/// A point, as a box that holds it, whose distances are asked for: each axis weighted, their squares' sum
/// multiplied by `share`, less `allowance`, at most `most`.
template <int D>
struct DistanceQuery {
  Box<D> point;
  std::array<float, D> weight;
  float share = 1;
  float allowance = 0;
  float most = 0;
};

/// Writes the boxes that overlap `box`; false if take() ended the search. Both are to be called with a tree
/// that has a root; the rest below `full` is still to be taken.
template <int D>
bool find_overlapping(const QueryTree<D>& tree, const Box<D>& box, FoundBoxes& found);

/// Writes the boxes that the cast meets up to `found.furthest`, in no order that means anything.
template <int D>
bool find_met(const QueryTree<D>& tree, const CastQuery<D>& cast, FoundBoxes& found);

/// Writes those boxes that the cast meets before or at `found.furthest`, nearer ones about first, and has
/// them taken leaf by leaf, so that `furthest` can be lowered.
template <int D>
void find_first_met(const QueryTree<D>& tree, const CastQuery<D>& cast, FoundBoxes& found);

/// Sets `distances` to those of the node's children: squared, 0 inside.
template <int D>
void distances(const QueryNode<D>& node, const DistanceQuery<D>& query,
               std::array<float, node_width>& distances);

/// The bounds of a node's children; the absent box if there are none.
template <int D>
Box<D> bounds_of(const QueryNode<D>& node);

/// Which of the first `count` > 0 children grows least, in the sum of its extents, if it is to hold `box`;
/// of several, the smallest, then the first one.
template <int D>
std::size_t best_child(const QueryNode<D>& node, std::size_t count, const Box<D>& box);

}  // namespace broadside::kernels
