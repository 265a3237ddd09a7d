// The tree of bounds that stays from frame to frame: where its boxes are, and how they change places.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "algorithms/bvh/tree.hpp"
#include "kernels/kept_tree.hpp"

namespace broadside::own {

/// Packed with gaps: leaves are not filled, and nodes have a child without boxes each, so that what comes
/// finds room near where it belongs. A box keeps its place until it is removed or moved to another.
template <int D>
class BvhKept {
 public:
  static constexpr std::uint32_t nowhere = 0xffffffffU;

  BvhKept() = default;
  BvhKept(const BvhKept&) = delete;
  BvhKept& operator=(const BvhKept&) = delete;

  /// Packs the tree anew: a place for each box that is present, with the box `stored(box)` in it.
  template <typename Stored>
  void build(std::span<const Box<D>> boxes, Stored stored) {
    pack(boxes);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (places_[i] != nowhere) set(places_[i], stored(boxes[i]));
    }
    refit_all();
  }

  /// Makes room for so many ids.
  void resize(std::size_t boxes) { places_.resize(boxes, nowhere); }

  const kernels::KeptTree<D>& tree() const noexcept { return tree_; }

  /// A box's place, or nowhere.
  std::uint32_t place(BoxId id) const { return places_[index(id)]; }

  Box<D> at(std::uint32_t place) const;

  /// Puts a box where bounds grow least, and widens them. There must be room.
  void insert(BoxId id, const Box<D>& box);

  /// Leaves the bounds as they are, but for the leaf's own.
  void remove(BoxId id);

  /// Says that the box at a place has changed, so that refit() looks there.
  void touch(std::uint32_t place);

  /// Brings bounds up to date around what was touched since the last time. Cost: O(touched).
  void refit();

  std::size_t places() const noexcept { return tree_.ids == nullptr ? 0 : sizes_[0] * kernels::kept_width; }
  std::size_t boxes() const noexcept { return boxes_; }
  std::size_t nodes() const noexcept;
  std::size_t bytes() const noexcept;

 private:
  static constexpr std::size_t width = kernels::kept_width;
  using Bounds = kernels::KeptBounds<D>;

  void pack(std::span<const Box<D>> boxes);
  void lay_out(std::size_t leaves);
  std::size_t element_of(std::size_t leaf) const;
  void refit_all();
  void set(std::uint32_t place, const Box<D>& box);
  void widen(std::uint32_t place, const Box<D>& box);
  void count_room(std::size_t leaf, std::uint32_t change);

  kernels::KeptTree<D> tree_{};
  std::array<std::size_t, kernels::most_kept_levels> sizes_{};  // elements of each level that are there
  std::array<std::vector<Bounds>, kernels::most_kept_levels> nodes_;
  std::array<std::vector<std::uint32_t>, kernels::most_kept_levels> room_;
  std::array<std::vector<std::uint8_t>, kernels::most_kept_levels> is_touched_;
  std::array<std::vector<std::uint32_t>, kernels::most_kept_levels> touched_;
  std::vector<std::uint32_t> ids_;
  std::vector<std::uint32_t> places_;
  std::array<std::vector<std::uint32_t>, 2> lists_;
  std::size_t boxes_ = 0;

  // For building.
  BoxTreePacker<D> packer_;
  std::vector<Box<D>> present_;
  std::vector<std::uint32_t> present_ids_;
};

}  // namespace broadside::own
