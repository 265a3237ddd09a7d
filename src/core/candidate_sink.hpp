// A sink for pairs that may be events: those that are go on.
#pragma once

#include <cstdint>
#include <span>

#include "broadside/pair.hpp"
#include "broadside/pair_tracker.hpp"

namespace broadside::core {

/// Looks at each pair's boxes and filters in both frames, and writes it to the sink it belongs to, if any.
/// To be flushed before the update ends.
template <int D, typename Real = float>
class CandidateSink final : public PairSink {
 public:
  CandidateSink(const Change<D, Real>& change, PairSink& begun, PairSink& ended)
      : change_(change), begun_(begun), ended_(ended) {}

  /// How many pairs it has looked at.
  std::uint64_t count() const noexcept { return count_; }

 private:
  void consume(std::span<const Pair> pairs) override {
    count_ += pairs.size();
    for (const Pair pair : pairs) change_.report(pair.first, pair.second, begun_, ended_);
  }

  const Change<D, Real>& change_;
  PairSink& begun_;
  PairSink& ended_;
  std::uint64_t count_ = 0;
};

}  // namespace broadside::core
