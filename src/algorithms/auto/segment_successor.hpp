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
  using IsLeft = typename Successor<D>::IsLeft;

  /// Makes `join` when it is first needed; its memory serves later searches.
  SegmentSuccessor(const SearchInput<D>& input, PairSink& pairs, std::unique_ptr<SegmentJoin<D>>& join)
      : input_(input), pairs_(pairs), join_(join) {}

  void finish(const IsLeft& is_left) override {
    if (!join_) join_ = std::make_unique<SegmentJoin<D>>();
    LeftSink left(is_left, input_.boxes, pairs_);
    Checkpoint checkpoint(input_.workers.checkpoint);
    work_ = join_->join(input_.boxes, input_.left_count, input_.doubles, checkpoint, left);
    left.flush();
  }

  /// What finish() did; empty if the search did not give up.
  const std::optional<Statistics>& work() const noexcept { return work_; }

 private:
  /// Passes on the pairs that a search did not write before it gave up.
  class LeftSink final : public core::FilterSink {
   public:
    LeftSink(const IsLeft& is_left, std::span<const Box<D>> boxes, PairSink& target)
        : FilterSink(target), is_left_(is_left), boxes_(boxes) {}

    std::unique_ptr<FilterSink> onto(PairSink& target) const override {
      return std::make_unique<LeftSink>(is_left_, boxes_, target);
    }

   private:
    void consume(std::span<const Pair> pairs) override {
      for (const Pair pair : pairs) {
        const Box<D>& first = boxes_[index(pair.first)];
        const Box<D>& second = boxes_[index(pair.second)];
        if (is_left_(first, pair.first, second, pair.second)) target().add(pair.first, pair.second);
      }
    }

    const IsLeft& is_left_;
    std::span<const Box<D>> boxes_;
  };

  const SearchInput<D>& input_;
  PairSink& pairs_;
  std::unique_ptr<SegmentJoin<D>>& join_;
  std::optional<Statistics> work_;
};

}  // namespace broadside::algorithm
