// CoherentFollower, section VI of paper.md: keeps a structure from frame to frame and updates it where boxes
// changed, then searches it as in its listing. The events of a frame are the difference from the previous
// frame's pairs.
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

/// VI-A: how a follower detects changed boxes: by a flag for each box, or by comparing each with its previous
/// state.
enum class Detection { flag, compare };

/// The tunable `detect`.
Tunable detect_tunable();

/// A follower over one structure. Derived classes build, update and search it.
///
/// The structure is rebuilt if `update` says so, after a failed frame, if the number of boxes has more than
/// doubled since it was built, and if mend() asks for it.
template <int D>
class CoherentFollower : public Follower<D>, public Phased {
 public:
  std::optional<Statistics> follow(const Change<D>& change, PairSink& begun, PairSink& ended) final;
  std::size_t bytes() const noexcept final;

 protected:
  explicit CoherentFollower(const Settings& settings);

  /// The previous state of each box, including absent ones. mend() must update the entry of each box that it
  /// has processed.
  std::vector<Box<D>>& boxes() noexcept { return boxes_; }
  const std::vector<Box<D>>& boxes() const noexcept { return boxes_; }

  /// The number of present boxes in this frame.
  std::size_t present() const noexcept { return present_; }

  /// Counts tests, and the entries that mending visits or moves.
  Checkpoint& checkpoint() noexcept { return *checkpoint_; }

 private:
  /// Builds the structure of boxes() as in the listing.
  virtual void build() = 0;

  /// Updates the structure and boxes() from the previous state of the movers, ascending, to `now`. False if
  /// the structure must be rebuilt instead; changes made until then do not matter.
  virtual bool mend(std::span<const BoxId> movers, std::span<const Box<D>> now) = 0;

  /// The listing's search. Returns its counts.
  virtual Statistics search(PairSink& pairs) = 0;

  /// The bytes of the structure.
  virtual std::size_t structure_bytes() const noexcept = 0;

  void find_movers(const Change<D>& change);
  void build_anew(std::span<const Box<D>> boxes);

  Detection detection_;
  std::vector<Box<D>> boxes_;
  std::vector<BoxId> movers_;
  std::vector<Pair> pairs_;  // pairs that overlapped in the previous frame
  std::vector<Pair> found_;
  std::size_t present_ = 0;
  std::size_t built_for_ = 0;             // number of boxes present when the structure was built
  std::optional<Checkpoint> checkpoint_;  // of this frame
};

}  // namespace broadside::paper
