// CoherentFollower, section VI of paper.md: a structure is kept from frame to frame and mended where boxes
// changed, then searched as its listing does. The events of a frame are the difference to the pairs of the
// frame before.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "broadside/algorithm.hpp"
#include "broadside/executor.hpp"
#include "broadside/follower.hpp"

#include "paper/listings/phases.hpp"

namespace broadside::paper {

/// VI-A: how a follower knows which boxes changed: each has a flag, or each is compared with its previous
/// state.
enum class Detection { flag, compare };

/// The tunable `detect`.
Tunable detect_tunable();

/// A follower over one structure. Derived classes say how it is built, mended and searched.
///
/// The structure is built anew where `update` says so, after a failed frame, where the boxes have become
/// more than twice as many as it was built for, and where mend() asks for it.
template <int D>
class CoherentFollower : public Follower<D>, public Phased {
 public:
  std::optional<Statistics> follow(const Change<D>& change, PairSink& begun, PairSink& ended) final;
  std::size_t bytes() const noexcept final;

 protected:
  explicit CoherentFollower(const Settings& settings);

  /// The previous state of each box, absent ones among them. A box that mend() has dealt with is to be
  /// brought up to date by it.
  std::vector<Box<D>>& boxes() noexcept { return boxes_; }
  const std::vector<Box<D>>& boxes() const noexcept { return boxes_; }

  /// How many boxes of this frame are present.
  std::size_t present() const noexcept { return present_; }

  /// To be told of tests, and of the entries that mending looks at or moves.
  Checkpoint& checkpoint() noexcept { return *checkpoint_; }

 private:
  /// Makes the structure of boxes() as the listing does.
  virtual void build() = 0;

  /// Brings the structure and boxes() from the previous state of the movers, ascending, to `now`. False if it
  /// has to be built anew instead; all that it has changed until then does not matter.
  virtual bool mend(std::span<const BoxId> movers, std::span<const Box<D>> now) = 0;

  /// The listing's search. Returns what it counted.
  virtual Statistics search(PairSink& pairs) = 0;

  /// The bytes of the structure.
  virtual std::size_t structure_bytes() const noexcept = 0;

  void find_movers(const Change<D>& change);
  void build_anew(std::span<const Box<D>> boxes);

  Detection detection_;
  std::vector<Box<D>> boxes_;
  std::vector<BoxId> movers_;
  std::vector<Pair> pairs_;  // those that overlapped in the frame before
  std::vector<Pair> found_;
  std::size_t present_ = 0;
  std::size_t built_for_ = 0;             // boxes present when the structure was built
  std::optional<Checkpoint> checkpoint_;  // of this frame
};

}  // namespace broadside::paper
