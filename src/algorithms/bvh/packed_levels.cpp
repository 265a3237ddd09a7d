// The bounds over packed leaves.
#include "algorithms/bvh/packed_levels.hpp"

#include <algorithm>

#include "core/nan_box.hpp"

namespace broadside::algorithm {
namespace {

using kernels::fan_out;

/// The elements of `memory`, at least `size` of them, to be set.
template <typename Element>
Element* grown(core::LargeArray<Element>& memory, std::size_t size) {
  if (memory.size() < size) core::renew(memory, size);
  return memory.data();
}

/// The neutral element of bounds.
template <int D>
constexpr Box<D> none = absent_box<D>();

}  // namespace

template <int D>
void PackedLevels<D>::start(std::size_t places) {
  resize(0, places);
  grown(ids_, places);
  gaps_.clear();
  tree_.left_size = 0;
}

template <int D>
void PackedLevels<D>::build(core::Parallel& parallel) {
  tree_.first_with_gap = tree_.levels[0].size / fan_out;
  for (const Gap gap : gaps_) {
    fill(0, gap, none<D>);
    if (gap.begin < gap.end) tree_.first_with_gap = std::min(tree_.first_with_gap, gap.begin / fan_out);
  }
  tree_.id = ids_.data();
  tree_.level_count = 1;
  do {
    const std::size_t level = tree_.level_count++;
    resize(level, whole_leaves(tree_.levels[level - 1].size) / fan_out);
    parallel.for_ranges(tree_.levels[level].size, [&](core::Range nodes, std::size_t) {
      kernels::set_bounds(tree_, level, {nodes.begin, nodes.end});
    });
    fill(level, gap_behind(level), none<D>);
  } while (tree_.levels[tree_.level_count - 1].size > fan_out);
  for (const Gap gap : gaps_) fill(0, gap, core::nan_box<D>());
  for (std::size_t level = 1; level < tree_.level_count; ++level)
    fill(level, gap_behind(level), core::nan_box<D>());
}

template <int D>
auto PackedLevels<D>::gap_behind(std::size_t level) const -> Gap {
  const std::size_t size = tree_.levels[level].size;
  return {size, whole_leaves(size)};
}

template <int D>
void PackedLevels<D>::fill(std::size_t level, Gap gap, const Box<D>& box) {
  for (std::size_t place = gap.begin; place < gap.end; ++place) {
    for (int axis = 0; axis < D; ++axis) {
      tree_.levels[level].min[axis][place] = box.min[axis];
      tree_.levels[level].max[axis][place] = box.max[axis];
    }
    if (level == 0) ids_[place] = BoxId{0};
  }
}

/// Makes `size` the size of a level, whose elements are then to be set.
template <int D>
void PackedLevels<D>::resize(std::size_t level, std::size_t size) {
  LevelMemory& memory = memory_[level];
  for (int axis = 0; axis < D; ++axis) {
    tree_.levels[level].min[axis] = grown(memory.min[axis], whole_leaves(size));
    tree_.levels[level].max[axis] = grown(memory.max[axis], whole_leaves(size));
  }
  tree_.levels[level].size = size;
}

template <int D>
std::size_t PackedLevels<D>::bytes() const noexcept {
  const auto held = [](const auto& memory) { return memory.capacity() * sizeof(memory[0]); };
  std::size_t bytes = held(gaps_) + held(ids_);
  for (const LevelMemory& level : memory_) {
    for (int axis = 0; axis < D; ++axis) bytes += held(level.min[axis]) + held(level.max[axis]);
  }
  return bytes;
}

template class PackedLevels<2>;
template class PackedLevels<3>;

}  // namespace broadside::algorithm
