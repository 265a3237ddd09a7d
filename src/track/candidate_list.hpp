// MarginTracker: where many boxes move and hardly any moves far, keeps the pairs of enlarged boxes and tests
// only these.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "broadside/tracker.hpp"

#include "core/lean.hpp"
#include "core/parallel.hpp"
#include "interface/adaptive_tracker.hpp"
#include "interface/margins.hpp"

namespace broadside::core {

/// Lets another tracker follow the boxes; while many of them move and hardly any far, lets it follow enlarged
/// boxes instead, which change only where a box has left its own. Their pairs are the candidates, of which
/// each frame tests all (a Verlet list: L. Verlet, Phys. Rev. 159, 1967; "fat" boxes in physics engines). The
/// events are the same either way.
///
/// Cost of a frame with enlarged boxes: a comparison a changed box, a test a candidate, and the other
/// tracker's for the boxes that left theirs. The number of candidates, and of tests to find them, is limited
/// by the numbers of boxes and pairs. The limit is checked during the search. If it is exceeded, boxes are no
/// longer enlarged, the frame is processed without margins, and the memory is released.
template <int D, typename Real = float>
class MarginTracker final : public PairTracker<D, Real> {
 public:
  explicit MarginTracker(std::unique_ptr<AdaptiveTracker<D, Real>> tracker) : tracker_(std::move(tracker)) {}

  std::string explanation() const override;

 private:
  void update_valid(const Change<D, Real>& change, PairSink& begun, PairSink& ended) override;
  std::size_t algorithm_bytes() const noexcept override;
  /// An index over enlarged boxes would answer queries wrongly.
  const BoxIndex<D, Real>* algorithm_index() const noexcept override {
    return boxes_ == Boxes::exact ? this->index_of(*tracker_) : nullptr;
  }

  void update_exactly(const Change<D, Real>& change, PairSink& begun, PairSink& ended);
  bool suits_margins(const Change<D, Real>& change);
  std::uint64_t start(const Change<D, Real>& change);
  std::size_t max_candidates() const noexcept;
  std::size_t pause_after_limit() const noexcept;
  void give_up(std::size_t pause) noexcept;
  void release() noexcept;
  bool follow_enlarged(const Change<D, Real>& change, PairSink& begun, PairSink& ended);
  void find_candidates(const Change<D, Real>& change);
  void enlarge_anew(const Change<D, Real>& change);
  void change_candidates(PairSink& ended);
  void report(const Change<D, Real>& change, PairSink& begun, PairSink& ended);
  void test_candidates(std::span<const Box<D, Real>> boxes);
  void judge();

  /// The boxes that the other tracker knows.
  enum class Boxes : std::uint8_t {
    exact,
    enlarged,
    ending  ///< enlarged ones of former frames: it has to be rebuilt
  };

  std::unique_ptr<AdaptiveTracker<D, Real>> tracker_;
  Margins<D, Real> margins_{};
  Boxes boxes_ = Boxes::exact;
  bool was_enlarged_ = false;  // whether the last update tested candidates

  std::vector<Box<D, Real>> before_;  // enlarged, of the frame before
  std::vector<Box<D, Real>> now_;
  std::vector<BoxId> left_;          // boxes that left their enlarged ones, or whose filter changed
  std::vector<std::uint8_t> flags_;  // for each box, 1 if it is in left_; all 0 between updates
  std::vector<Pair> candidates_;     // sorted
  std::vector<std::uint8_t> holds_;  // for each candidate, whether the boxes themselves overlap
  std::vector<std::uint8_t> held_;   // likewise, in the frame before
  std::size_t holding_ = 0;          // candidates that hold
  std::vector<Pair> begun_;          // candidates
  std::vector<Pair> ended_;
  std::vector<Pair> spare_;
  Parallel parallel_;

  std::size_t changed_ = 0;          // boxes, in the last update with candidates
  std::size_t candidate_count_ = 0;  // candidates that it tested
  double left_share_ = 0;            // of the changed boxes, on average
  std::size_t calm_frames_ = 0;      // in a row, in which few boxes changed
  std::size_t pause_ = 1;            // frames with many movers until the next try
  std::size_t next_pause_ = 0;       // hysteresis: grows with each try that did not last
  std::size_t lasted_ = 0;           // frames of this try
};

/// An AdaptiveTracker, whose boxes are enlarged while many move and hardly any far; not where `update` asks
/// for one way, nor in lean builds.
template <int D, typename Real>
std::unique_ptr<PairTracker<D, Real>> adaptive_tracker(
    Update update, std::unique_ptr<PairFinder<D, Real>> finder, const FindCosts& finding,
    std::vector<Follower<D, Real>> followers, std::unique_ptr<PairTracker<D, Real>> for_few = nullptr) {
  auto tracker = std::make_unique<AdaptiveTracker<D, Real>>(update, std::move(finder), finding,
                                                            std::move(followers), std::move(for_few));
  if constexpr (!is_lean) {
    if (update == Update::automatic) return std::make_unique<MarginTracker<D, Real>>(std::move(tracker));
  }
  return tracker;
}

}  // namespace broadside::core
