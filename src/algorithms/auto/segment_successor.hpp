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
    MissingSink missing(is_missing, input_.boxes, pairs_);
    Checkpoint checkpoint(input_.workers.checkpoint);
    work_ = join_->join(input_.boxes, input_.left_count, input_.doubles, checkpoint, missing);
    missing.flush();
  }

  /// What finish() did; empty if the search did not give up.
  const std::optional<Statistics>& work() const noexcept { return work_; }

 private:
  /// Passes on the pairs that a search did not write before it gave up.
  class MissingSink final : public core::FilterSink {
   public:
    MissingSink(const IsMissing& is_missing, std::span<const Box<D>> boxes, PairSink& target)
        : FilterSink(target), is_missing_(is_missing), boxes_(boxes) {}

    std::unique_ptr<FilterSink> onto(PairSink& target) const override {
      return std::make_unique<MissingSink>(is_missing_, boxes_, target);
    }

   private:
    void consume(std::span<const Pair> pairs) override {
      for (const Pair pair : pairs) {
        const Box<D>& first = boxes_[index(pair.first)];
        const Box<D>& second = boxes_[index(pair.second)];
        if (is_missing_(first, pair.first, second, pair.second)) target().add(pair.first, pair.second);
      }
    }

    const IsMissing& is_missing_;
    std::span<const Box<D>> boxes_;
  };

  const SearchInput<D>& input_;
  PairSink& pairs_;
  std::unique_ptr<SegmentJoin<D>>& join_;
  std::optional<Statistics> work_;
};

}  // namespace broadside::algorithm
