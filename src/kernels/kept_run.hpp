// KeptRun: a run of boxes that persists from frame to frame.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "kernels/run.hpp"

namespace broadside::kernels {

/// Boxes as a structure of arrays, set one by one; without dedup masks.
template <int D>
struct KeptRun {
  std::array<std::vector<float>, D> min;
  std::array<std::vector<float>, D> max;
  std::vector<BoxId> id;

  /// Makes room for `size` boxes, and for what kernels read ahead.
  void resize(std::size_t size) {
    for (int axis = 0; axis < D; ++axis) {
      min[axis].resize(size + read_ahead);
      max[axis].resize(size + read_ahead);
    }
    id.resize(size + read_ahead);
  }

  void set(std::size_t place, const Box<D>& box) {
    for (int axis = 0; axis < D; ++axis) {
      min[axis][place] = box.min[axis];
      max[axis][place] = box.max[axis];
    }
  }

  Box<D> box(std::size_t place) const {
    Box<D> box;
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] = min[axis][place];
      box.max[axis] = max[axis][place];
    }
    return box;
  }

  /// The run, valid until the next resize().
  Run<D> view() const {
    Run<D> run{};
    for (int axis = 0; axis < D; ++axis) {
      run.min[axis] = min[axis].data();
      run.max[axis] = max[axis].data();
    }
    run.id = id.data();
    run.size = id.size() - read_ahead;
    return run;
  }
};

}  // namespace broadside::kernels
