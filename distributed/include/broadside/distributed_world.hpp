// Boxes of all ranks of an MPI program that come, move and go, and the pairs that begin and end.
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

/// How a distributed world works; the same on each rank.
struct DistributedWorldOptions {
  std::string algorithm{default_algorithm};  ///< the spec by which each rank follows its part
  std::optional<std::size_t> threads{};      ///< of each rank; empty: as the spec says

  /// Space is cut anew if the work of the rank with the most, over the mean of all ranks, exceeds this;
  /// greater than 1. Cuts that did not achieve it are tried again once the imbalance has grown by a tenth,
  /// the boxes have doubled or the work has halved. Worlds of fewer than 256 boxes a rank are left as they
  /// are.
  double max_imbalance = 1.25;

  std::size_t sample = 0;  ///< as Options::sample
};

/// What one update brought to this rank, sorted. Valid until the next update.
struct DistributedEvents {
  std::span<const LargePair> begun;
  std::span<const LargePair> ended;
};

/// What a distributed world holds on this rank, and what the last update did.
struct DistributedWorldStatistics {
  std::size_t boxes = 0;              ///< that this rank owns
  std::size_t part_boxes = 0;         ///< that touch this rank's part of space
  std::uint64_t part_pairs = 0;       ///< of them that overlap
  std::uint64_t sent_bytes = 0;       ///< to other ranks, in the last update
  std::uint64_t cuts = 0;             ///< how often space was cut
  double largest_over_mean_work = 1;  ///< of all ranks; work is Partition::cost() of boxes and pairs
};

/// A set of boxes on all ranks that changes, and its overlapping pairs.
///
/// The caller gives each box an id, which no other box of any rank has. A box is owned by one rank: the one
/// that added it, until it hands it over. Each rank follows a part of space by a Tracker. An update
/// sends a box that changed to the ranks whose parts it touches or has left, and nothing of others; where the
/// load has shifted, space is cut anew and boxes move to their new parts, which shows in no event.
///
/// Events do not depend on the number of ranks, the cuts or which rank owns a box. Constructor, destructor
/// and update() are collective, and no other members are. One thread at a time. Memory: some 100 bytes for
/// each owned box, and 40 for the register of ids; three copies of each box of the part, and what the tracker
/// keeps.
template <int D, typename Real = float>
class BROADSIDE_PUBLIC DistributedWorld {
 public:
  /// Throws on all ranks: InvalidSpec, also where options differ between ranks; std::invalid_argument for an
  /// imbalance of 1 or less.
  explicit DistributedWorld(MPI_Comm comm, const DistributedWorldOptions& options = {});
  DistributedWorld(DistributedWorld&& other) noexcept;
  DistributedWorld& operator=(DistributedWorld&& other) noexcept;
  ~DistributedWorld();

  /// Adds a box under an id. Throws InvalidInput if the box has a NaN or min > max, InvalidFrame if this rank
  /// owns a box of that id or has removed one since the last update.
  void add(std::uint64_t id, const Box<D, Real>& box);

  /// Replaces a box. Throws InvalidHandle if this rank does not own it, InvalidInput as add() does.
  void move(std::uint64_t id, const Box<D, Real>& box);

  /// Takes a box out. Its pairs end at the next update, after which its id may be used again, on any
  /// rank. Throws InvalidHandle if this rank does not own it.
  void remove(std::uint64_t id);

  /// Makes another rank the box's owner at the beginning of the next update, whose events already go there.
  /// Throws InvalidHandle if this rank does not own the box, std::invalid_argument if there is no such rank.
  void hand_over(std::uint64_t id, int rank);

  /// Brings the pairs up to date. Each pair that begins or ends is reported once, with first < second, on the
  /// rank that owns the first box or has just removed it. Collective.
  ///
  /// Throws on all ranks: InvalidFrame if a box was added, or is handed over to a rank, under an id that
  /// another box has; remove the added box, and the update can be tried again. If anything else is thrown on
  /// a rank, such as std::bad_alloc, the others throw RankError; the next update then cuts space anew and
  /// reports what has changed since the last update that did not throw.
  DistributedEvents update();

  /// Whether this rank owns a box of this id, as of now.
  bool contains(std::uint64_t id) const noexcept;

  /// The box as it was last set. Valid until the next call that changes the world. Throws InvalidHandle if
  /// this rank does not own it.
  const Box<D, Real>& box(std::uint64_t id) const;

  /// The number of boxes that this rank owns.
  std::size_t size() const noexcept;

  DistributedWorldStatistics statistics() const noexcept;

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace broadside::mpi
