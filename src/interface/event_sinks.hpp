// EventSinks: where a structure writes the events of an update, and the pairs that may be events.
#pragma once

#include <span>

#include "broadside/pair.hpp"
#include "broadside/tracker.hpp"

#include "core/moved_box.hpp"

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

/// Without filters, what overlaps a box at rest is all there is to ask; else every pair is a candidate. Where
/// the caller judges `every_pair`, all are written to `begun` as they are found.
template <int D>
class EventSinks {
 public:
  EventSinks(const Change<D>& change, PairSink& begun, PairSink& ended, bool every_pair = false)
      : candidates_(change, begun, ended),
        sinks_{.begun = every_pair || change.filters_now.empty() ? begun : candidates_,
               .ended = every_pair                   ? begun
                        : change.filters_now.empty() ? ended
                                                     : candidates_,
               .candidates = every_pair ? begun : candidates_,
               .moves = change.flags.data()} {}
  EventSinks(const EventSinks&) = delete;
  EventSinks& operator=(const EventSinks&) = delete;

  const ChangeSinks& sinks() const noexcept { return sinks_; }
  void flush() { candidates_.flush(); }

 private:
  CandidateSink<D> candidates_;
  ChangeSinks sinks_;
};

}  // namespace broadside::core
