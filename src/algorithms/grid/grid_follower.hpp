// GridFollower: moves boxes from cell to cell and searches for what the moved ones overlap.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "broadside/algorithm.hpp"

#include "algorithms/grid/cells.hpp"
#include "core/moved_box.hpp"
#include "core/parallel.hpp"

namespace broadside::algorithm {

/// Cost of an update: O(boxes that changed and what is near them), and now and then O(n), when the cells no
/// longer suit the boxes, and their searches have cost that much more than usual.
template <int D>
class GridFollower final : public Follower<D> {
 public:
  explicit GridFollower(const Settings& settings) : cells_(settings.optional_number("cell")) {}

  std::optional<Statistics> follow(const Change<D>& change, PairSink& begun, PairSink& ended) override;
  std::size_t bytes() const noexcept override;

 private:
  /// What each of several threads moves and finds.
  struct Part {
    std::vector<core::MovedBox<D>> boxes;
    std::vector<Pair> begun;
    std::vector<Pair> ended;
    core::ChangeWork work;
    std::uint64_t candidates = 0;  // pairs looked at in both frames
  };

  void settle(const Change<D>& change);
  void move(const Change<D>& change, std::span<const BoxId> ids);
  void search(const Change<D>& change, PairSink& begun, PairSink& ended);
  bool needs_rebuild(const Change<D>& change) const;
  void build(const Change<D>& change);
  void weigh(const core::ChangeWork& work, std::size_t queries);

  /// Those of this update.
  std::span<Part> parts() { return std::span(parts_).first(parallel_.range_count()); }

  HierarchicalCells<D> cells_;
  std::vector<BoxId> moved_;  // whose entries cover more than where they are
  std::vector<BoxId> moving_;
  core::Parallel parallel_;
  std::vector<Part> parts_;  // of those that move, by range
  std::size_t built_for_ = 0;
  double usual_blocks_ = 0;  // a query, since the cells were laid out
  std::uint64_t first_queries_ = 0;
  double excess_ = 0;  // blocks looked at beyond what is usual
};

}  // namespace broadside::algorithm
