// The tracker of the hierarchical grid: moves boxes from cell to cell and looks for what those that moved
// meet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadside/pair_tracker.hpp"

#include "algorithms/hierarchical_grid/cells.hpp"
#include "core/moved_box.hpp"
#include "kernels/cell_blocks.hpp"

namespace broadside::own {

/// Cost of an update: O(boxes that changed and what is near them), and now and then O(n), when the cells no
/// longer suit the boxes: not before searching has cost that much too much.
template <int D>
class HierarchicalGridTracker final : public PairTracker<D> {
 public:
  /// As an update, but writes the pair of each changed box with every other one that overlaps where it was or
  /// where it is, perhaps more than once: for who judges pairs by more than these boxes.
  Statistics candidates(const Change<D>& change, PairSink& pairs);

  /// The bytes that it keeps.
  std::size_t kept_bytes() const noexcept { return algorithm_bytes(); }

 private:
  void update_valid(const Change<D>& change, PairSink& begun, PairSink& ended) override;
  std::size_t algorithm_bytes() const noexcept override;

  Statistics follow(const Change<D>& change, const kernels::CellSinks& sinks, bool all);
  bool suits(const Change<D>& change) const;
  void build(const Change<D>& change);
  void file(core::MovedBox<D>& box);
  void weigh(const kernels::CellWork& work, std::size_t queries);

  HierarchicalGridCells<D> cells_;
  std::vector<BoxId> moved_;  // whose entries say more than where they are
  std::vector<BoxId> moving_;
  std::vector<core::MovedBox<D>> boxes_;  // a batch of those that moved
  std::size_t built_for_ = 0;
  double usual_blocks_ = 0;  // a query, since the cells were laid out
  std::uint64_t first_queries_ = 0;
  double excess_ = 0;  // blocks looked at beyond what is usual
};

}  // namespace broadside::own
