// DoubleFollower: follows double boxes as floats. A structure of floats tells which pairs may have changed,
// and a test in double decides.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "broadside/follower.hpp"

#include "core/grow.hpp"
#include "core/rounding.hpp"

namespace broadside::track {

/// Rounding keeps order, as in find::DoubleSearch: boxes that overlap in double overlap in float. So every
/// pair that began or ended is of a changed box and a box that it overlaps, or overlapped, in float. The
/// rounding is chosen for the boxes of the first frame, and again when boxes have moved to where it makes too
/// many false candidates. Cost: that of the floats, and a test in double for each candidate.
template <int D>
class DoubleFollower {
 public:
  /// `floats` must support Change::wants_candidates.
  explicit DoubleFollower(std::unique_ptr<Follower<D>> floats) : floats_(std::move(floats)) {}

  /// As Follower::follow(). Statistics::hits are the candidates. Boxes that rounding makes equal cause false
  /// candidates. If there are too many, even in the middle of a frame, all boxes are rounded anew. Events may
  /// then be written twice, which is harmless.
  std::optional<Statistics> follow(const Change<D, double>& change, PairSink& begun, PairSink& ended) {
    const std::uint64_t max_false = max_false_candidates * change.now.size();
    if (!change.rebuild && false_candidates_ <= max_false) {
      try {
        return follow(change, false, max_false - false_candidates_, begun, ended);
      } catch (const TooManyFalse&) {
      }
    }
    start(change);
    return follow(change, true, std::numeric_limits<std::uint64_t>::max(), begun, ended);
  }

  std::size_t bytes() const noexcept {
    std::size_t bytes = core::bytes_of(before_, now_);
    for (const core::QuantileRounding& rounding : quantiles_) bytes += rounding.bytes();
    return bytes + floats_->bytes();
  }

 private:
  /// The number of false candidates per box that costs about as much as rounding all boxes anew.
  static constexpr std::uint64_t max_false_candidates = 32;

  struct TooManyFalse {};

  /// Writes the events among the candidates, and counts false candidates. Throws TooManyFalse if there are
  /// more than `max_false`.
  class Candidates final : public PairSink {
   public:
    Candidates(const Change<D, double>& change, std::uint64_t max_false, PairSink& begun, PairSink& ended)
        : change_(change), max_false_(max_false), begun_(begun), ended_(ended) {}

    std::uint64_t count() const noexcept { return count_; }
    std::uint64_t false_count() const noexcept { return false_count_; }

   private:
    void consume(std::span<const Pair> pairs) override {
      count_ += pairs.size();
      for (const Pair pair : pairs) {
        change_.report(pair.first, pair.second, begun_, ended_);
        const bool was_near = overlap(change_.before[index(pair.first)], change_.before[index(pair.second)]);
        const bool is_near = overlap(change_.now[index(pair.first)], change_.now[index(pair.second)]);
        false_count_ += static_cast<std::uint64_t>(!was_near && !is_near);
      }
      if (false_count_ > max_false_) throw TooManyFalse();
    }

    const Change<D, double>& change_;
    std::uint64_t max_false_;
    PairSink& begun_;
    PairSink& ended_;
    std::uint64_t count_ = 0;
    std::uint64_t false_count_ = 0;
  };

  Box<D> rounded(const Box<D, double>& box) const {
    if (!is_present(box)) return absent_box<D>();
    return by_quantiles_ ? core::rounded(box, quantiles_) : core::rounded(box, fit_);
  }

  /// Chooses a rounding that suits this frame, and rounds all boxes of the frame before with it.
  void start(const Change<D, double>& change) {
    false_candidates_ = 0;
    fit_ = core::fit_linear<D>(change.now);
    const std::uint64_t hash = core::hash_of<D>(change.now);
    by_quantiles_ = core::makes_false_pairs<D>(fit_, change.now, 0, hash);
    quantiles_ =
        by_quantiles_ ? core::fit_quantiles<D>(change.now, hash) : std::array<core::QuantileRounding, D>{};
    before_.resize(change.before.size());
    for (std::size_t i = 0; i < before_.size(); ++i) before_[i] = rounded(change.before[i]);
    now_ = before_;
  }

  /// Follows the boxes; throws TooManyFalse if there are more than `max_false` false candidates.
  std::optional<Statistics> follow(const Change<D, double>& change, bool starts, std::uint64_t max_false,
                                   PairSink& begun, PairSink& ended) {
    before_.resize(change.now.size(), absent_box<D>());
    now_.resize(change.now.size(), absent_box<D>());
    for (const BoxId id : change.changed) now_[index(id)] = rounded(change.now[index(id)]);
    Candidates candidates(change, max_false, begun, ended);
    std::optional<Statistics> statistics = floats_->follow({.before = before_,
                                                            .now = now_,
                                                            .changed = change.changed,
                                                            .flags = change.flags,
                                                            .rebuild = starts,
                                                            .wants_candidates = true,
                                                            .max_tests = change.max_tests,
                                                            .workers = change.workers},
                                                           candidates, candidates);
    candidates.flush();
    if (statistics) statistics->hits = candidates.count();
    false_candidates_ += candidates.false_count();
    for (const BoxId id : change.changed) before_[index(id)] = now_[index(id)];
    return statistics;
  }

  std::array<core::LinearRounding, D> fit_{};
  std::array<core::QuantileRounding, D> quantiles_;
  bool by_quantiles_ = false;
  std::uint64_t false_candidates_ = 0;  // since all boxes were rounded
  std::unique_ptr<Follower<D>> floats_;
  std::vector<Box<D>> before_;
  std::vector<Box<D>> now_;
};

}  // namespace broadside::track
