// SnapshotReader: reads the content of a snapshot, and checks it part by part.
#pragma once

#include <cstdint>
#include <vector>

#include "broadside/pair.hpp"
#include "broadside/world.hpp"

#include "world/byte_stream.hpp"
#include "world/snapshot_codec.hpp"

namespace broadside::world {

/// Reads the bytes between header and checksum. No claim in them takes more memory than their length
/// justifies.
template <int D, typename Real>
class SnapshotReader {
 public:
  using Parts = WorldParts<D, Real>;
  using Decoded = DecodedSnapshot<D, Real>;

  SnapshotReader(ByteReader& in, Decoded& decoded) noexcept : in_(in), decoded_(decoded) {}

  /// Reads everything, for a world with these parts. Throws InvalidSnapshot.
  void read(const Parts& world, const WorldTracker<D, Real>& tracker);

 private:
  bool is_set(std::uint32_t flag) const noexcept { return (flags_ & flag) != 0; }

  void read_options(const Parts& world, const WorldTracker<D, Real>& tracker);
  void read_slots(std::uint32_t first_generation);
  std::vector<RemovedBox<D, Real>> read_removed(const std::vector<SlotState>& states, SlotState state,
                                                const char* things);
  void read_changes();
  void read_ignored();
  void read_last_frame();
  void read_pairs(std::size_t pair_count);
  void read_edges();
  std::vector<Pair> read_paired(const char* things);
  std::vector<BoxId> read_marked(const char* things);

  ByteReader& in_;
  Decoded& decoded_;
  std::uint32_t flags_ = 0;
  RefinerState refiner_;
};

}  // namespace broadside::world
