// Sinks that stop a search when it finds too many candidates. They check the limit while pairs are written,
// not after the search.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"
#include "broadside/searcher.hpp"
#include "broadside/sinks.hpp"

#include "core/filter_sink.hpp"
#include "kernels/overlap_flags.hpp"

namespace broadside::track {

/// Thrown from a search that would exceed its limit of pairs or tests.
struct LimitPassed {};

/// Throws LimitPassed when a search gives up because it makes too many tests.
template <int D>
class LimitedTests final : public Successor<D> {
 public:
  void finish(const typename Successor<D>::IsMissing& /*is_missing*/) override { throw LimitPassed(); }
};

/// Appends candidates to a vector. Throws LimitPassed before there are more than `max`, plus
/// `max_per_holding` for each candidate whose boxes in `boxes` overlap.
template <int D, typename Real>
class CandidateCollector final : public PairSink {
 public:
  CandidateCollector(std::vector<Pair>& candidates, std::size_t max, std::size_t max_per_holding = 0,
                     std::span<const Box<D, Real>> boxes = {})
      : candidates_(candidates),
        collector_(candidates),
        max_(max),
        max_per_holding_(max_per_holding),
        boxes_(boxes) {}

 private:
  void consume(std::span<const Pair> pairs) override {
    if (max_per_holding_ > 0) {
      std::array<std::uint8_t, 2 * max_room> holds;
      kernels::set_overlap_flags(boxes_, pairs, holds.data());
      max_ += max_per_holding_ *
              static_cast<std::size_t>(std::count(holds.begin(), holds.begin() + pairs.size(), 1));
    }
    if (candidates_.size() + pairs.size() > max_) throw LimitPassed();
    collector_.put(pairs);
  }

  const std::vector<Pair>& candidates_;
  PairCollector collector_;  // requests large pages
  std::size_t max_;
  std::size_t max_per_holding_;
  std::span<const Box<D, Real>> boxes_;
};

/// Passes pairs on. Throws LimitPassed before all threads together pass more than `max_pairs`.
class LimitSink final : public core::FilterSink {
 public:
  LimitSink(std::size_t max_pairs, PairSink& target)
      : FilterSink(target), max_pairs_(max_pairs), passed_(&count_) {}

  std::unique_ptr<core::FilterSink> onto(PairSink& target) const override {
    auto sink = std::make_unique<LimitSink>(max_pairs_, target);
    sink->passed_ = passed_;
    return sink;
  }

 private:
  void consume(std::span<const Pair> pairs) override {
    if (passed_->fetch_add(pairs.size(), std::memory_order_relaxed) + pairs.size() > max_pairs_)
      throw LimitPassed();
    target().put(pairs);
  }

  std::size_t max_pairs_;
  std::atomic<std::size_t> count_ = 0;
  std::atomic<std::size_t>* passed_;  // count_ of the original sink
};

}  // namespace broadside::track
