// SnapshotCodec: writes a world as bytes, and reads and checks them. See docs/snapshot-format.md.
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

/// The content of a snapshot. The checks throw InvalidSnapshot.
template <int D, typename Real>
struct DecodedSnapshot {
  std::unique_ptr<WorldParts<D, Real>> parts;  ///< without a predicate
  Spec spec{};                                 ///< of the tracker
  TakenFrame<D, Real> last_frame{};            ///< the last frame that the tracker took

  /// Checks that every difference from the last frame is listed, and that the boxes of the last frame are in
  /// slots that exist and that no other box has taken since.
  void check_last_frame() const;

  /// Checks what has happened and what is still to be delivered. `is_settled`: the snapshot says that nothing
  /// is pending.
  void check_pending(bool is_settled, bool asks_predicate) const;

  /// Checks all pairs and events against `tracked`: the pairs that hold in the last frame, sorted. Only this
  /// check needs a tracker, so decode() leaves it to its caller.
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

  /// Writes the world with these parts. Call it in the default floating-point environment.
  static void encode(const Parts& parts, const Tracker& tracker, detail::Output<std::byte>& bytes);

  /// Reads a snapshot for the world with these parts. Throws InvalidSnapshot if the bytes are not a whole
  /// snapshot of a known version with the same dimension and type of coordinate, if they contradict
  /// themselves, or if just one of the two worlds has a predicate.
  static DecodedSnapshot<D, Real> decode(std::span<const std::byte> bytes, const Parts& parts,
                                         const Tracker& tracker);
};

}  // namespace broadside::world
