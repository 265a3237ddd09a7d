// ListingSearcher: common parts of the searchers over the paper's listings.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "broadside/executor.hpp"
#include "broadside/searcher.hpp"

#include "paper/listings/phases.hpp"

namespace broadside::paper {

/// Copies the boxes for a listing. It reads each box many times, and another thread may change the caller's
/// array meanwhile, but the cell computed from a box must match the box looked up later.
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
  /// search() on boxes that do not change; boxes that became invalid are absent. Counts each test in
  /// `checkpoint`. Ends each phase but the last, which is searching. Returns its counts.
  virtual Statistics search_listed(std::span<const Box<D>> boxes, PairSink& pairs,
                                   Checkpoint& checkpoint) = 0;

  std::vector<Box<D>> boxes_;
};

}  // namespace broadside::paper
