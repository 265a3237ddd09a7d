// The tree of bounds that stays: packed as the finder's, but with gaps.
#include "algorithms/bvh/kept.hpp"

#include <algorithm>
#include <utility>

namespace broadside::own {
namespace {

/// So many places of a leaf, and children of a node, are filled at first.
constexpr std::size_t filled_places = 13;
constexpr std::size_t filled_children = 15;

constexpr std::size_t round_up(std::size_t size) { return (size + 15) / 16 * 16; }

/// Makes `memory` hold `size` times `value`, and gives back what far exceeds that.
template <typename Element>
Element* filled(std::vector<Element>& memory, std::size_t size, const Element& value) {
  if (memory.capacity() > 4 * size + 1024) memory = {};
  memory.assign(size, value);
  return memory.data();
}

}  // namespace

/// The physical number of a leaf: the last child of each node is left out.
template <int D>
std::size_t BvhKept<D>::element_of(std::size_t leaf) const {
  std::size_t element = 0;
  std::size_t factor = 1;
  for (; leaf > 0; leaf /= filled_children, factor *= width) element += leaf % filled_children * factor;
  return element;
}

template <int D>
void BvhKept<D>::lay_out(std::size_t leaves) {
  Bounds nothing;
  for (int axis = 0; axis < D; ++axis) {
    std::fill_n(nothing.min[axis], width, absent_box<D>().min[axis]);
    std::fill_n(nothing.max[axis], width, absent_box<D>().max[axis]);
  }
  sizes_[0] = round_up(element_of(std::max<std::size_t>(leaves, 1) - 1) + 1);
  std::size_t below = sizes_[0];
  tree_.nodes[0] = filled(nodes_[0], below, nothing);
  tree_.top = 0;
  do {
    const std::size_t level = ++tree_.top;
    const std::size_t size = round_up(below) / width;
    tree_.room[level - 1] = filled(room_[level - 1], round_up(below), 0U);
    filled(is_touched_[level - 1], below, std::uint8_t{0});
    touched_[level - 1].clear();
    tree_.nodes[level] = filled(nodes_[level], size, nothing);
    sizes_[level] = below = size;
  } while (below > 1);
  tree_.ids = filled(ids_, sizes_[0] * width, kernels::no_box);
  for (std::size_t i = 0; i < lists_.size(); ++i)
    tree_.lists[i] = filled(lists_[i], sizes_[0] + 2 * width, 0U);
}

/// Gives every box that is present a place.
template <int D>
void BvhKept<D>::pack(std::span<const Box<D>> boxes) {
  present_.clear();
  present_ids_.clear();
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    if (!is_present(boxes[i])) continue;
    present_.push_back(boxes[i]);
    present_ids_.push_back(i);
  }
  boxes_ = present_.size();
  filled(places_, boxes.size(), nowhere);
  lay_out((boxes_ + filled_places - 1) / filled_places);
  std::size_t placed = 0;
  if (boxes_ > 0) {
    packer_.pack(present_);
    const kernels::TreeLevel<D>& packed = packer_.tree().levels[0];
    for (std::size_t at = 0; at < packed.size; ++at) {
      if (!(packed.min[0][at] == packed.min[0][at])) continue;  // a gap between classes of size
      const std::uint32_t id = present_ids_[index(packer_.ids()[at])];
      const std::size_t leaf = element_of(placed / filled_places);
      const auto place = static_cast<std::uint32_t>(leaf * width + placed % filled_places);
      places_[id] = place;
      ids_[place] = id;
      ++placed;
    }
  }
  for (std::size_t leaf = 0; leaf < sizes_[0]; ++leaf) {
    std::uint32_t room = 0;
    for (std::size_t lane = 0; lane < width; ++lane)
      room += static_cast<std::uint32_t>(ids_[leaf * width + lane] == kernels::no_box);
    room_[0][leaf] = room;
  }
  for (std::size_t level = 1; level < tree_.top; ++level) {
    for (std::size_t i = 0; i < sizes_[level - 1]; ++i) room_[level][i / width] += room_[level - 1][i];
  }
}

template <int D>
void BvhKept<D>::refit_all() {
  std::vector<std::uint32_t>& all = touched_[0];
  for (std::size_t level = 1; level <= tree_.top; ++level) {
    all.resize(sizes_[level - 1]);
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    kernels::refit(tree_, level, std::span<const std::uint32_t>(all));
  }
  all.clear();
}

template <int D>
Box<D> BvhKept<D>::at(std::uint32_t place) const {
  const Bounds& leaf = tree_.nodes[0][place / width];
  Box<D> box;
  for (int axis = 0; axis < D; ++axis) {
    box.min[axis] = leaf.min[axis][place % width];
    box.max[axis] = leaf.max[axis][place % width];
  }
  return box;
}

template <int D>
void BvhKept<D>::set(std::uint32_t place, const Box<D>& box) {
  Bounds& leaf = tree_.nodes[0][place / width];
  for (int axis = 0; axis < D; ++axis) {
    leaf.min[axis][place % width] = box.min[axis];
    leaf.max[axis][place % width] = box.max[axis];
  }
}

template <int D>
void BvhKept<D>::insert(BoxId id, const Box<D>& box) {
  const std::uint32_t leaf = kernels::choose_leaf(tree_, box);
  std::uint32_t place = static_cast<std::uint32_t>(leaf * width);
  while (ids_[place] != kernels::no_box) ++place;
  ids_[place] = index(id);
  places_[index(id)] = place;
  set(place, box);
  widen(place, box);
  touch(place);
  count_room(leaf, static_cast<std::uint32_t>(-1));
  ++boxes_;
}

template <int D>
void BvhKept<D>::remove(BoxId id) {
  const std::uint32_t place = std::exchange(places_[index(id)], nowhere);
  ids_[place] = kernels::no_box;
  set(place, absent_box<D>());
  const auto leaf = static_cast<std::uint32_t>(place / width);
  kernels::refit(tree_, 1, std::span<const std::uint32_t>(&leaf, 1));
  touch(place);
  count_room(leaf, 1);
  --boxes_;
}

template <int D>
void BvhKept<D>::widen(std::uint32_t place, const Box<D>& box) {
  std::size_t element = place / width;
  for (std::size_t level = 1; level <= tree_.top; ++level, element /= width) {
    Bounds& node = tree_.nodes[level][element / width];
    for (int axis = 0; axis < D; ++axis) {
      float& min = node.min[axis][element % width];
      float& max = node.max[axis][element % width];
      min = std::min(min, box.min[axis]);
      max = std::max(max, box.max[axis]);
    }
  }
}

template <int D>
void BvhKept<D>::count_room(std::size_t leaf, std::uint32_t change) {
  for (std::size_t level = 0; level < tree_.top; ++level, leaf /= width) tree_.room[level][leaf] += change;
}

template <int D>
void BvhKept<D>::touch(std::uint32_t place) {
  const auto leaf = static_cast<std::uint32_t>(place / width);
  if (std::exchange(is_touched_[0][leaf], std::uint8_t{1}) == 0) touched_[0].push_back(leaf);
}

template <int D>
void BvhKept<D>::refit() {
  for (std::size_t level = 1; level <= tree_.top; ++level) {
    std::vector<std::uint32_t>& below = touched_[level - 1];
    kernels::refit(tree_, level, std::span<const std::uint32_t>(below));
    for (const std::uint32_t child : below) {
      is_touched_[level - 1][child] = 0;
      const auto node = static_cast<std::uint32_t>(child / width);
      if (level < tree_.top && std::exchange(is_touched_[level][node], std::uint8_t{1}) == 0)
        touched_[level].push_back(node);
    }
    below.clear();
  }
}

template <int D>
std::size_t BvhKept<D>::nodes() const noexcept {
  std::size_t count = 0;
  for (std::size_t level = 0; level <= tree_.top; ++level) count += sizes_[level];
  return count;
}

template <int D>
std::size_t BvhKept<D>::bytes() const noexcept {
  const auto held = [](const auto& memory) { return memory.capacity() * sizeof(memory[0]); };
  std::size_t bytes = held(ids_) + held(places_) + held(lists_[0]) + held(lists_[1]) + packer_.bytes() +
                      held(present_) + held(present_ids_);
  for (std::size_t level = 0; level < kernels::most_kept_levels; ++level)
    bytes += held(nodes_[level]) + held(room_[level]) + held(is_touched_[level]) + held(touched_[level]);
  return bytes;
}

template class BvhKept<2>;
template class BvhKept<3>;

}  // namespace broadside::own
