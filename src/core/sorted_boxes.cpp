// Boxes in the order in which a sweep meets them.
#include "core/sorted_boxes.hpp"

namespace broadside::core {

template <int D>
std::span<const SortedBox<D>> SortedBoxes<D>::sort(std::span<const Box<D>> boxes,
                                                   const std::array<int, D>& axes, Parallel& parallel) {
  const std::span<KeyedPlace> places = radix_.places(boxes.size());
  const int swept = axes[0];
  parallel.for_ranges(boxes.size(), [&](Range range, std::size_t) {
    for (std::size_t i = range.begin; i < range.end; ++i)
      places[i] = {sort_key(boxes[i].min[swept]), static_cast<std::uint32_t>(i)};
  });
  const std::span<const KeyedPlace> order = radix_.sort(parallel);
  renew(sorted_, boxes.size());
  parallel.for_ranges(boxes.size(), [&](Range range, std::size_t) {
    SortedBox<D>* out = sorted_.data() + range.begin;
    for (const KeyedPlace& place : order.subspan(range.begin, range.size()))
      *out++ = {turned(boxes[place.place], axes), BoxId{place.place}};
  });
  return sorted_;
}

template class SortedBoxes<2>;
template class SortedBoxes<3>;

}  // namespace broadside::core
