// ListingSearcher: what the searchers over the paper's listings have in common.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "broadside/executor.hpp"
#include "broadside/searcher.hpp"

#include "paper/listings/phases.hpp"

namespace broadside::paper {

/// Gives a listing boxes of its own. It looks at each box many times, and the caller's array may be changed
/// by another thread meanwhile: what a cell was computed from must be what is looked up later.
template <int D>
class ListingSearcher : public Searcher<D>, public Phased {
 public:
  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) final {
    boxes_.assign(input.boxes.begin(), input.boxes.end());
    for (Box<D>& box : boxes_) {
      if (!is_present(box)) box = absent_box<D>();
    }
    Checkpoint checkpoint(input.workers.checkpoint);
    this->begin_phases();
    const Statistics statistics = search_listed(boxes_, pairs, checkpoint);
    this->end_phase(&Phases::searching_ms);
    return statistics;
  }

 private:
  /// search() on boxes that do not change. Those that are invalid by now are absent. Tells `checkpoint` of
  /// each test. Ends each phase but the last, which is searching. Returns what it counted.
  virtual Statistics search_listed(std::span<const Box<D>> boxes, PairSink& pairs,
                                   Checkpoint& checkpoint) = 0;

  std::vector<Box<D>> boxes_;
};

}  // namespace broadside::paper
