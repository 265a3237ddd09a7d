// ListingFinder: what the finders over the paper's listings have in common.
#pragma once

#include <span>
#include <vector>

#include "broadside/executor.hpp"
#include "broadside/finder.hpp"

namespace broadside::paper {

/// Gives a listing boxes of its own. It looks at each box many times, and the caller's array may be changed
/// by another thread meanwhile: what a cell was computed from must be what is looked up later.
template <int D>
class ListingFinder : public PairFinder<D> {
 private:
  /// find_valid() on boxes that do not change. Those that are invalid by now are absent. `checkpoint` is to
  /// be told of each test.
  virtual void find_listed(std::span<const Box<D>> boxes, PairSink& pairs, Checkpoint& checkpoint) = 0;

  void find_valid(std::span<const Box<D>> boxes, PairSink& pairs) final {
    boxes_.assign(boxes.begin(), boxes.end());
    for (Box<D>& box : boxes_) {
      if (!is_present(box)) box = absent_box<D>();
    }
    Checkpoint checkpoint(this->workers().checkpoint);
    find_listed(boxes_, pairs, checkpoint);
  }

  std::vector<Box<D>> boxes_;
};

}  // namespace broadside::paper
