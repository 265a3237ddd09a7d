// SnapshotChecks: checks that the parts of a snapshot agree, so that update(), pairs() and queries can rely
// on it.
#pragma once

#include <string>
#include <vector>

#include "broadside/error.hpp"
#include "broadside/pair.hpp"

#include "world/world_parts.hpp"
#include "world/world_tracker.hpp"

namespace broadside::world {

/// Throws InvalidSnapshot, which says `what` is wrong, unless it holds.
inline void expect(bool holds, const char* what) {
  if (!holds) throw InvalidSnapshot(std::string("a snapshot contradicts itself: ") + what);
}

/// Throws InvalidSnapshot, which names a pair and says what is wrong with it.
[[noreturn]] inline void refuse(Pair pair, const std::string& what) {
  throw InvalidSnapshot("a snapshot contradicts itself: the pair (" + std::to_string(index(pair.first)) +
                        ", " + std::to_string(index(pair.second)) + ") " + what);
}

/// Checks decoded parts against each other. SnapshotReader has checked each alone. Throws InvalidSnapshot.
template <int D, typename Real>
class SnapshotChecks {
 public:
  /// Refers to `parts`, which may still be filled.
  explicit SnapshotChecks(const WorldParts<D, Real>& parts) noexcept : parts_(parts) {}

  /// The last frame and what differs from it: every difference is listed, and what the tracker saw is in
  /// slots that exist and that no other box has since.
  void check_last_frame(const TakenFrame<D, Real>& last) const;

  /// What has happened, and what is still to be delivered. `is_settled`: nothing is, as the snapshot says.
  void check_pending(bool is_settled, bool asks_predicate) const;

  /// All pairs and events against the pairs of the tracker, which are sorted.
  void check_pairs(const std::vector<Pair>& tracked) const;

 private:
  void check_differences(const TakenFrame<D, Real>& last) const;
  void check_marks(bool asks_predicate) const;

  const WorldParts<D, Real>& parts_;
};

}  // namespace broadside::world
