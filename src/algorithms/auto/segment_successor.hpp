// SegmentSuccessor: finishes a search that gave up, by a segment tree.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "broadside/searcher.hpp"

#include "algorithms/auto/segment_join.hpp"
#include "core/filter_sink.hpp"

namespace broadside::algorithm {

template <int D>
class SegmentSuccessor final : public Successor<D> {
 public:
  using IsMissing = typename Successor<D>::IsMissing;

  /// Makes `join` when it is first needed; its memory serves later searches.
  SegmentSuccessor(const SearchInput<D>& input, PairSink& pairs, std::unique_ptr<SegmentJoin<D>>& join)
      : input_(input), pairs_(pairs), join_(join) {}

  void finish(const IsMissing& is_missing) override {
    if (!join_) join_ = std::make_unique<SegmentJoin<D>>();
    Checkpoint checkpoint(input_.workers.checkpoint);
    work_ = core::search_through(
        core::PassingSink(PassMissing{is_missing, input_.boxes}, pairs_), [&](PairSink& missing) {
          return join_->join(input_.boxes, input_.left_count, input_.doubles, checkpoint, missing);
        });
  }

  /// What finish() did; empty if the search did not give up.
  const std::optional<Statistics>& work() const noexcept { return work_; }

 private:
  /// Passes on the pairs that the search did not write before it gave up.
  struct PassMissing {
    bool operator()(Pair pair, Pair& to) const {
      to = pair;
      return is_missing(boxes[index(pair.first)], pair.first, boxes[index(pair.second)], pair.second);
    }

    const IsMissing& is_missing;
    std::span<const Box<D>> boxes;
  };

  const SearchInput<D>& input_;
  PairSink& pairs_;
  std::unique_ptr<SegmentJoin<D>>& join_;
  std::optional<Statistics> work_;
};

}  // namespace broadside::algorithm
