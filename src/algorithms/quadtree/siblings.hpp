// The way from leaf to leaf in a quadtree: how each reference to a box that moved is carried across to where
// the box now is. Section VI-D of the paper, by its words.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadside/box.hpp"

#include "algorithms/quadtree/nodes.hpp"

namespace broadside::own {

/// What a box's references become when it moves. The tree is only looked at.
template <int D>
class QuadtreeSiblings {
 public:
  /// A leaf that the box was in, or is in, or both.
  struct Reference {
    std::uint32_t node;
    bool was;
    bool is;
  };

  /// Finds the leaves of a box that was at home in a node: first those that it was in, each from the one
  /// before by way of the parent; then, from each that it has left, the nearest that it is in; then, from
  /// each that it is in, those across the borders that it did not reach before. Every step goes up no further
  /// than to the first node on both sides of the border. Returns false, and has found nothing, if the box was
  /// or is to be kept in a node that is no leaf: it has no siblings to go to.
  bool carry(const QuadtreeNodes<D>& tree, std::uint32_t home, const Box<D>& before, const Box<D>& now);

  /// What carry() found, each leaf once. The first one that the box is in, is its new home.
  std::span<const Reference> references() const { return references_; }

  /// Begins a new walk, on which every node is met for the first time once more.
  void start(const QuadtreeNodes<D>& tree);

  /// Whether a node is met for the first time on this walk.
  bool meet(std::uint32_t node) {
    if (met_[node] == walk_) return false;
    met_[node] = walk_;
    return true;
  }

  std::size_t bytes() const noexcept {
    return references_.capacity() * sizeof(Reference) + met_.capacity() * sizeof(std::uint32_t);
  }

 private:
  /// The box that is being carried.
  struct Mover {
    const QuadtreeNodes<D>& tree;
    const Box<D>& before;
    const Box<D>& now;
    bool is_apart;  ///< whether it jumped: the new box does not touch the old one
  };

  std::uint32_t next(const Mover& mover, std::uint32_t leaf);
  void leave(const Mover& mover, std::uint32_t leaf);
  void spread(const Mover& mover, std::uint32_t leaf);
  void cross(const Mover& mover, std::uint32_t leaf, int axis, float beyond);
  void descend(const Mover& mover, std::uint32_t at, const Box<D>& probe);
  void pass(const Mover& mover, std::uint32_t node);

  std::vector<Reference> references_;
  std::vector<std::uint32_t> met_;  // by node: the last walk on which it was met
  std::uint32_t walk_ = 0;
  bool is_kept_ = false;
};

}  // namespace broadside::own
