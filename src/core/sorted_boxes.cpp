// Boxes in the order in which a sweep meets them.
#include "core/sorted_boxes.hpp"

namespace broadside::core {

template <int D>
std::span<const SortedBox<D>> SortedBoxes<D>::sort(std::span<const Box<D>> boxes,
                                                   const std::array<int, D>& axes) {
  const std::span<KeyedPlace> places = radix_.places(boxes.size());
  const int swept = axes[0];
  for (std::uint32_t i = 0; i < places.size(); ++i) places[i] = {sort_key(boxes[i].min[swept]), i};
  sorted_.resize(boxes.size());
  SortedBox<D>* out = sorted_.data();
  for (const KeyedPlace& place : radix_.sort()) {
    const Box<D>& box = boxes[place.place];
    for (int axis = 0; axis < D; ++axis) {
      out->box.min[axis] = box.min[axes[axis]];
      out->box.max[axis] = box.max[axes[axis]];
    }
    out->id = BoxId{place.place};
    ++out;
  }
  return sorted_;
}

template class SortedBoxes<2>;
template class SortedBoxes<3>;

}  // namespace broadside::core
