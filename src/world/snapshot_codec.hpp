// SnapshotCodec: writes a world as bytes, and reads and checks them. What they mean is in
// docs/snapshot-format.md.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "broadside/export.hpp"
#include "broadside/pair.hpp"
#include "broadside/spec.hpp"
#include "broadside/world.hpp"

#include "world/world_state.hpp"
#include "world/world_tracker.hpp"

namespace broadside::world {

/// What a snapshot says. The checks throw InvalidSnapshot.
template <int D, typename Real>
struct DecodedSnapshot {
  std::unique_ptr<WorldParts<D, Real>> parts;  ///< without a predicate
  Spec spec{};                                 ///< of the tracker
  TakenFrame<D, Real> last_frame{};            ///< that the tracker took last

  /// The last frame and what differs from it: every difference is listed, and what the tracker saw is in
  /// slots that exist and that no other box has since.
  void check_last_frame() const;

  /// What has happened, and what is still to be delivered. `is_settled`: nothing is, as the snapshot says.
  void check_pending(bool is_settled, bool asks_predicate) const;

  /// All pairs and events against the pairs that hold in the last frame; `tracked` is sorted. The only check
  /// that takes a tracker, and so the only one that decode() leaves to its caller.
  void check_pairs(const std::vector<Pair>& tracked) const;

 private:
  void check_differences() const;
  void check_marks(bool asks_predicate) const;
};

template <int D, typename Real>
class SnapshotCodec {
 public:
  using Parts = WorldParts<D, Real>;
  using Tracker = WorldTracker<D, Real>;

  /// Writes the world that consists of these. In the default floating-point environment.
  static void encode(const Parts& parts, const Tracker& tracker, detail::Output<std::byte>& bytes);

  /// Reads a snapshot for the world that consists of these. Throws InvalidSnapshot if the bytes are not a
  /// whole one of the same dimension, type of coordinate and a known version, or contradict themselves, or if
  /// just one of the two worlds has a predicate.
  static DecodedSnapshot<D, Real> decode(std::span<const std::byte> bytes, const Parts& parts,
                                         const Tracker& tracker);
};

}  // namespace broadside::world
