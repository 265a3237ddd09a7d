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

#include "world/world_parts.hpp"
#include "world/world_tracker.hpp"

namespace broadside::world {

template <int D, typename Real>
class SnapshotCodec {
 public:
  using Parts = WorldParts<D, Real>;
  using Tracker = WorldTracker<D, Real>;

  /// What a snapshot says, as far as it can be checked without a tracker.
  struct Decoded {
    std::unique_ptr<Parts> parts;      ///< without a predicate
    Spec spec{};                       ///< of the tracker
    TakenFrame<D, Real> last_frame{};  ///< that the tracker took last
  };

  /// Writes the world that consists of these. In the default floating-point environment.
  static void encode(const Parts& parts, const Tracker& tracker, detail::Output<std::byte>& bytes);

  /// Reads a snapshot for the world that consists of these. Throws InvalidSnapshot if the bytes are not a
  /// whole one of the same dimension, type of coordinate and a known version, or contradict themselves, or if
  /// just one of the two worlds has a predicate.
  static Decoded decode(std::span<const std::byte> bytes, const Parts& parts, const Tracker& tracker);

  /// Checks decoded parts against the pairs that hold in the last frame; `tracked` is sorted. Throws
  /// InvalidSnapshot.
  static void check_pairs(const Parts& parts, const std::vector<Pair>& tracked);
};

}  // namespace broadside::world
