// A set of boxes, distributed over the ranks of an MPI program, that are added, moved and removed, with
// events for pairs that begin and end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include <mpi.h>

#include "broadside/box.hpp"
#include "broadside/export.hpp"
#include "broadside/finder.hpp"
#include "broadside/large_pair.hpp"
#include "broadside/mpi.hpp"

namespace broadside::mpi {

/// Options of a distributed world; the same on each rank.
struct DistributedWorldOptions {
  std::string algorithm{default_algorithm};  ///< spec of the algorithm with which each rank follows its part
  std::optional<std::size_t> threads{};      ///< per rank; empty: as the spec says

  /// Space is repartitioned if the largest work of a rank over the mean of all ranks exceeds this; greater
  /// than 1. If new cuts do not achieve it, they are tried again once the imbalance has grown by 10 %, the
  /// number of boxes has doubled or the work has halved. Worlds of fewer than 256 boxes per rank are not
  /// repartitioned.
  double max_imbalance = 1.25;

  std::size_t sample = 0;  ///< as Options::sample
};

/// Events of one update for this rank, sorted. Valid until the next update.
struct DistributedEvents {
  std::span<const LargePair> begun;
  std::span<const LargePair> ended;
};

/// Contents of a distributed world on this rank, and figures of the last update.
struct DistributedWorldStatistics {
  std::size_t boxes = 0;              ///< owned by this rank
  std::size_t part_boxes = 0;         ///< touching this rank's part of space
  std::uint64_t part_pairs = 0;       ///< overlapping pairs of these
  std::uint64_t sent_bytes = 0;       ///< to other ranks, in the last update
  std::uint64_t cuts = 0;             ///< how often space was partitioned
  double largest_over_mean_work = 1;  ///< over all ranks; work is Partition::cost() of boxes and pairs
};

/// A changing set of boxes on all ranks, and its overlapping pairs.
///
/// The caller gives each box an id that is unique over all ranks. Each box is owned by one rank: the rank
/// that added it, until it hands the box over. Each rank follows one part of space with a Tracker. An update
/// sends only changed boxes, each to the ranks whose parts it touches or has left. If the load has shifted,
/// space is repartitioned and boxes move to their new parts; this causes no events.
///
/// Events do not depend on the number of ranks, on the cuts, or on which rank owns a box. The constructor,
/// the destructor and update() are collective; no other members are. Not thread-safe. Memory: about 100 bytes
/// for each owned box and 40 for the register of ids; three copies of each box of the part, and the tracker's
/// memory.
template <int D, typename Real = float>
class BROADSIDE_PUBLIC DistributedWorld {
 public:
  /// Throws on all ranks: InvalidSpec, also if options differ between ranks; std::invalid_argument for an
  /// imbalance of 1 or less.
  explicit DistributedWorld(MPI_Comm comm, const DistributedWorldOptions& options = {});
  DistributedWorld(DistributedWorld&& other) noexcept;
  DistributedWorld& operator=(DistributedWorld&& other) noexcept;
  ~DistributedWorld();

  /// Adds a box under an id. Throws InvalidInput if the box has a NaN or min > max, and InvalidFrame if this
  /// rank owns a box with that id or has removed one since the last update.
  void add(std::uint64_t id, const Box<D, Real>& box);

  /// Replaces a box. Throws InvalidHandle if this rank does not own it, InvalidInput as add() does.
  void move(std::uint64_t id, const Box<D, Real>& box);

  /// Removes a box. Its pairs end at the next update; after that, any rank may reuse the id. Throws
  /// InvalidHandle if this rank does not own the box.
  void remove(std::uint64_t id);

  /// Makes another rank the box's owner at the beginning of the next update; events of that update already go
  /// to the new owner. Throws InvalidHandle if this rank does not own the box, std::invalid_argument if there
  /// is no such rank.
  void hand_over(std::uint64_t id, int rank);

  /// Brings the pairs up to date. Each pair that begins or ends is reported once, with first < second, on the
  /// rank that owns the first box or has just removed it. Collective.
  ///
  /// Throws on all ranks: InvalidFrame if an added or handed-over box has the id of another box. Remove the
  /// added box, and the update can be repeated. If a rank throws anything else, such as std::bad_alloc, the
  /// other ranks throw RankError; the next update then repartitions space and reports all changes since the
  /// last successful update.
  DistributedEvents update();

  /// Whether this rank currently owns a box with this id.
  bool contains(std::uint64_t id) const noexcept;

  /// The box's current bounds. Valid until the next call that changes the world. Throws InvalidHandle if this
  /// rank does not own it.
  const Box<D, Real>& box(std::uint64_t id) const;

  std::size_t size() const noexcept;

  DistributedWorldStatistics statistics() const noexcept;

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace broadside::mpi
