// FollowPolicy and EnlargePolicy: which of its four ways a tracker goes in a frame.
//
// Both decide by counts alone, of boxes, changes, tests and pairs, so that the same history always goes the
// same way.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "broadside/algorithm.hpp"
#include "broadside/searcher.hpp"

namespace broadside::track {

/// What is known of a structure that follows boxes, as FollowerChoice states it.
struct StructureCosts {
  FollowCosts costs{};
  std::size_t max_boxes = 0;

  bool compares_all() const noexcept { return max_boxes > 0; }
};

/// Whether a frame's changes are followed, and in which structure, or all pairs found anew. Cost of a frame:
/// near the lesser of the two ways', and never much more than finding all pairs anew, since a structure whose
/// movers make too many tests is not followed.
class FollowPolicy {
 public:
  /// `shares_candidates`: the same pairs have to be looked at again in every structure, as those of boxes of
  /// doubles do.
  FollowPolicy(Update update, const FindCosts& finding, const std::vector<StructureCosts>& structures,
               bool shares_candidates = false);

  /// Whether the next frame is to be followed, in the structure of number current(). `rebuild` says that
  /// nothing of the frame before is known.
  bool follows(std::size_t boxes, std::size_t changed, bool rebuild);

  /// Says that all pairs were found anew, and what that took.
  void found(std::size_t boxes, std::size_t pairs, const std::optional<Statistics>& statistics);

  /// Says that the structure followed a frame, and what that took.
  void followed(std::size_t changed, const std::optional<Statistics>& statistics);

  /// Says that no structure has the boxes of the last frame.
  void lost() noexcept;

  /// The structure in use, and the one that costs least by what is known. use() gives up one for another.
  std::size_t current() const noexcept { return current_; }
  std::size_t cheapest() const;
  void use(std::size_t structure);

  /// After all structures were tried: a change to another is not yet one of many.
  void settle() noexcept { change_.patience = 1; }

  Update update() const noexcept { return update_; }

  /// Whether the structure has the boxes of the last frame.
  bool is_following() const noexcept { return follows_; }

  /// Whether the boxes of the last frame were so few that only the structure that compares all is used.
  bool are_few() const noexcept { return are_few_; }

  /// Up to how many changed boxes following cost less, in the last frame.
  std::size_t break_even() const noexcept { return break_even_; }

 private:
  double cost_of_mover(std::size_t structure) const;
  void take_count(std::size_t boxes);

  struct KnownStructure : StructureCosts {
    double of_mover;  // the cost of a mover when it was last used, or the expected one
  };

  /// Candidates that have to be looked at in every structure, and what those of a mover cost.
  struct SharedCandidates {
    bool exist;
    double of_mover = 0;
  };

  /// Hysteresis: a change must have paid for itself, more so after each change of structures, so that they do
  /// not take turns.
  struct ChangeOfWay {
    double saved = 0;  // what following, or another structure, would have saved since it was last done
    double patience = 1;
  };

  /// What the structure took since it was last weighed.
  struct Seen {
    std::uint64_t movers = 0;
    std::uint64_t tests = 0;
    std::uint64_t candidates = 0;
  };

  Update update_;
  FindCosts finding_;
  double of_box_;  // the cost of finding all pairs anew, a box
  std::vector<KnownStructure> structures_;
  SharedCandidates shared_candidates_;
  std::size_t boxes_ = 0;  // of the last frame
  bool are_few_ = false;
  std::size_t break_even_ = 0;
  bool follows_ = false;
  std::size_t current_ = 0;
  ChangeOfWay change_;
  Seen seen_;
};

/// What a frame of enlarged boxes took.
struct EnlargedFrame {
  std::size_t boxes = 0;
  std::size_t changed = 0;     ///< boxes
  std::size_t left = 0;        ///< of them, those that left their enlarged ones
  std::size_t candidates = 0;  ///< pairs of enlarged boxes
};

/// Whether boxes are enlarged: while many move and hardly any moves far.
class EnlargePolicy {
 public:
  /// `may_compare_all`: a structure that compares all boxes is at hand.
  explicit EnlargePolicy(bool may_compare_all) : may_compare_all_(may_compare_all) {}

  /// Whether to enlarge the boxes after a frame that was handled otherwise, if these moved little enough.
  bool tries(std::size_t boxes, std::size_t changed);

  void started() noexcept;

  /// Whether boxes stay enlarged. If not, the next try is not soon.
  bool goes_on(const EnlargedFrame& frame);

  /// Says that there would be too many candidates, that there was no memory for them, or that the search for
  /// them was ended.
  void limit_passed() noexcept;
  void out_of_memory() noexcept;
  void interrupted() noexcept;

 private:
  void give_up(std::size_t pause) noexcept { pause_ = next_pause_ = pause; }

  bool may_compare_all_;
  double left_share_ = 0;        // of the changed boxes, on average
  std::size_t calm_frames_ = 0;  // in a row, in which following would have cost less
  std::size_t pause_ = 1;        // frames with many movers until the next try
  std::size_t next_pause_ = 0;   // hysteresis: grows with each try that did not last
  std::size_t lasted_ = 0;       // frames of this try
};

}  // namespace broadside::track
