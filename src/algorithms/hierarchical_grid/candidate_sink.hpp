// A sink for pairs that may be events: those that are go on.
#pragma once

#include <span>

#include "broadside/pair.hpp"
#include "broadside/pair_tracker.hpp"

namespace broadside::core {

/// Looks at each pair's boxes and filters in both frames, and writes it to the sink it belongs to, if any.
/// To be flushed before the update ends.
template <int D>
class CandidateSink final : public PairSink {
 public:
  CandidateSink(const Change<D>& change, PairSink& begun, PairSink& ended)
      : change_(change), begun_(begun), ended_(ended) {}

 private:
  void consume(std::span<const Pair> pairs) override {
    for (const Pair pair : pairs) change_.report(pair.first, pair.second, begun_, ended_);
  }

  const Change<D>& change_;
  PairSink& begun_;
  PairSink& ended_;
};

}  // namespace broadside::core
