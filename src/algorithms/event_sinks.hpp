// Shared by the followers: append_moved() lists the changed boxes of an update, and EventSinks takes the
// events that a structure finds and the pairs that may be events.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadside/executor.hpp"
#include "broadside/follower.hpp"
#include "broadside/pair.hpp"

#include "core/moved_box.hpp"
#include "kernels/overlap_flags.hpp"

namespace broadside::algorithm {

/// Appends each box of `ids` (a part of `change.changed`) that was or is present, and has other bounds or
/// another filter now. If `change.wants_candidates`, appends unchanged boxes too, and sets `filter_changed`
/// for all.
template <int D>
void append_moved(const Change<D>& change, std::span<const BoxId> ids,
                  std::vector<core::MovedBox<D>>& moved) {
  for (const BoxId id : ids) {
    const Box<D>& before = change.before[index(id)];
    const Box<D>& now = change.now[index(id)];
    const bool filter_changed =
        change.wants_candidates ||
        (!change.filters_now.empty() && change.filters_before[index(id)] != change.filters_now[index(id)]);
    if (!filter_changed && before == now) continue;
    const bool was = is_present(before);
    const bool is = is_present(now);
    if (!was && !is) continue;
    moved.push_back({.before = was ? before : core::nan_box<D>(),
                     .now = is ? now : core::nan_box<D>(),
                     .bounds = merged(before, now),
                     .id = id,
                     .was_present = was,
                     .is_present = is,
                     .filter_changed = filter_changed});
  }
}

/// Tests each pair in both frames, by boxes and filters, and writes it to `begun` or `ended` if it is an
/// event. Flush it before the update ends.
template <int D>
class CandidateSink final : public PairSink {
 public:
  CandidateSink(const Change<D>& change, PairSink& begun, PairSink& ended)
      : change_(change), begun_(begun), ended_(ended) {}

  /// The number of pairs tested so far.
  std::uint64_t count() const noexcept { return count_; }

 private:
  void consume(std::span<const Pair> pairs) override {
    constexpr std::size_t at_once = 256;
    std::array<std::uint8_t, at_once> did;
    std::array<std::uint8_t, at_once> does;
    const bool has_filters = !change_.filters_now.empty();
    count_ += pairs.size();
    while (!pairs.empty()) {
      const std::span<const Pair> some = pairs.first(std::min(at_once, pairs.size()));
      kernels::set_overlap_flags(change_.before, some, did.data());
      kernels::set_overlap_flags(change_.now, some, does.data());
      for (std::size_t i = 0; i < some.size(); ++i) {
        if (has_filters && (did[i] | does[i]) != 0)
          change_.report(some[i].first, some[i].second, begun_, ended_);
        else if (did[i] != does[i])
          (does[i] != 0 ? begun_ : ended_).add(some[i].first, some[i].second);
      }
      pairs = pairs.subspan(some.size());
    }
  }

  const Change<D>& change_;
  PairSink& begun_;
  PairSink& ended_;
  std::uint64_t count_ = 0;
};

/// The sinks of an update. Without filters, pairs of a mover and a box at rest go straight to `begun` and
/// `ended`; pairs of two movers are candidates. With filters, every pair is a candidate. If
/// `change.wants_candidates`, every pair goes to `begun` untested.
template <int D>
class EventSinks {
 public:
  /// `all_placed` as in core::ChangeSinks.
  EventSinks(const Change<D>& change, PairSink& begun, PairSink& ended, Checkpoint* checkpoint = nullptr,
             bool all_placed = false)
      : candidates_(change, begun, ended),
        sinks_{.begun = change.wants_candidates || change.filters_now.empty() ? begun : candidates_,
               .ended = change.wants_candidates      ? begun
                        : change.filters_now.empty() ? ended
                                                     : candidates_,
               .candidates = change.wants_candidates ? begun : candidates_,
               .moves = change.flags.data(),
               .checkpoint = checkpoint,
               .all_placed = all_placed,
               .max_tests = change.max_tests} {}
  EventSinks(const EventSinks&) = delete;
  EventSinks& operator=(const EventSinks&) = delete;

  const core::ChangeSinks& sinks() const noexcept { return sinks_; }
  void flush() { candidates_.flush(); }

  /// The number of candidates tested, up to the last flush().
  std::uint64_t candidates() const noexcept { return candidates_.count(); }

 private:
  CandidateSink<D> candidates_;
  core::ChangeSinks sinks_;
};

}  // namespace broadside::algorithm
