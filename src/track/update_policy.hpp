// FollowPolicy and EnlargePolicy: which of four ways a tracker takes in a frame.
//
// Both decide by counts of boxes, changes, tests and pairs alone, so that the same history always leads to
// the same choices.
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

/// Decides whether to follow a frame's changes, and in which structure, or to find all pairs anew. A frame
/// costs about as much as the cheaper of the two, and never much more than finding all pairs anew, since a
/// structure whose movers make too many tests is not followed.
class FollowPolicy {
 public:
  /// `shares_candidates`: every structure has to test the same candidates again, as with double boxes.
  FollowPolicy(Update update, const FindCosts& finding, const std::vector<StructureCosts>& structures,
               bool shares_candidates = false);

  /// Whether to follow the next frame, in structure number current(). `rebuild`: nothing is known of the
  /// frame before.
  bool follows(std::size_t boxes, std::size_t changed, bool rebuild);

  /// Call it after all pairs were found anew, with what that took.
  void found(std::size_t boxes, std::size_t pairs, const std::optional<Statistics>& statistics);

  /// Call it after the structure followed a frame, with what that took.
  void followed(std::size_t changed, const std::optional<Statistics>& statistics);

  /// The number of tests that following this frame may take: above it, another way costs less.
  std::uint64_t max_tests() const;

  /// Call it if following a frame took more than max_tests(). Returns whether to follow it in another
  /// structure, which is then the current one, instead of finding all pairs anew. `may_follow`: otherwise
  /// returns false.
  bool passed_max_tests(std::size_t changed, bool may_follow);

  /// Call it when no structure has the boxes of the last frame.
  void lost() noexcept;

  /// The structure in use, and the cheapest one by what is known. use() switches to another.
  std::size_t current() const noexcept { return current_; }
  std::size_t cheapest() const;
  void use(std::size_t structure);

  /// Forgets the changes of structure so far, after all structures were tried.
  void settle() noexcept { change_.patience = 1; }

  Update update() const noexcept { return update_; }

  /// Whether the structure has the boxes of the last frame.
  bool is_following() const noexcept { return follows_; }

  /// Whether the last frame had so few boxes that only the structure that compares all is used.
  bool are_few() const noexcept { return are_few_; }

  /// In the last frame, following cost less up to this number of changed boxes.
  std::size_t break_even() const noexcept { return break_even_; }

 private:
  double cost_of_mover(std::size_t structure) const;
  double cost_of_finding() const { return static_cast<double>(boxes_) * of_box_; }
  void take_count(std::size_t boxes);

  struct KnownStructure : StructureCosts {
    double of_mover;  // per mover: as last measured, or the expected cost
  };

  /// Whether all structures must test the same candidates again, and what these cost per mover.
  struct SharedCandidates {
    bool exist;
    double of_mover = 0;
  };

  /// Hysteresis: a change of way must first have paid for itself. After each change of structure, it must
  /// have paid twice as much, so that structures do not take turns.
  struct ChangeOfWay {
    double saved = 0;  // savings missed since the last change
    double patience = 1;
  };

  /// What the structure did since its cost was last measured.
  struct WorkSinceMeasured {
    std::uint64_t movers = 0;
    std::uint64_t tests = 0;
    std::uint64_t candidates = 0;
  };

  Update update_;
  FindCosts finding_;
  double of_box_;  // the cost of finding all pairs anew, per box
  std::vector<KnownStructure> structures_;
  SharedCandidates shared_candidates_;
  std::size_t boxes_ = 0;  // of the last frame
  bool are_few_ = false;
  std::size_t break_even_ = 0;
  bool follows_ = false;
  std::size_t current_ = 0;
  ChangeOfWay change_;
  WorkSinceMeasured seen_;
};

/// Counts of a frame with enlarged boxes.
struct EnlargedFrame {
  std::size_t boxes = 0;
  std::size_t changed = 0;     ///< boxes
  std::size_t left = 0;        ///< of these, boxes that left their enlarged boxes
  std::size_t candidates = 0;  ///< pairs of enlarged boxes
};

/// Decides whether boxes are enlarged: while many move and hardly any moves far.
class EnlargePolicy {
 public:
  /// `may_compare_all`: there is a structure that compares all boxes.
  explicit EnlargePolicy(bool may_compare_all) : may_compare_all_(may_compare_all) {}

  /// Whether so many of the boxes change that enlarging them may pay.
  static bool are_many(std::size_t boxes, std::size_t changed) noexcept;

  /// Whether to enlarge the boxes after a frame without enlarged boxes, if they moved little enough.
  bool tries(std::size_t boxes, std::size_t changed);

  void started() noexcept;

  /// Whether boxes stay enlarged. If not, the next try comes after a pause.
  bool goes_on(const EnlargedFrame& frame);

  /// Call one of these if there would be too many candidates, if memory for them ran out, or if the search
  /// for them was interrupted.
  void limit_passed() noexcept;
  void out_of_memory() noexcept;
  void interrupted() noexcept;

 private:
  void give_up(std::size_t pause) noexcept { pause_ = next_pause_ = pause; }

  bool may_compare_all_;
  double left_share_ = 0;        // average fraction of the changed boxes
  std::size_t calm_frames_ = 0;  // in a row, in which following would have cost less
  std::size_t pause_ = 1;        // frames with many movers until the next try
  std::size_t next_pause_ = 0;   // hysteresis: grows with each try that did not last
  std::size_t lasted_ = 0;       // frames of this try
};

}  // namespace broadside::track
