// StaggeredMargins: how far a tracker enlarges its boxes. They differ from box to box at first, since boxes
// that move alike would leave their enlarged boxes in the same frames; later they follow how many boxes
// leave.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>

#include "broadside/follower.hpp"

#include "core/margins.hpp"

namespace broadside::track {

template <int D, typename Real>
class StaggeredMargins {
 public:
  /// Margins that suit a sample of the changed boxes; nothing if these moved too far or not at all.
  static std::optional<core::Margins<D, Real>> suiting(const Change<D, Real>& change);

  /// The largest margins that a sample of the boxes allows, for boxes whose motion is unknown yet; nothing if
  /// most boxes have no volume.
  static std::optional<core::Margins<D, Real>> guessed(std::span<const Box<D, Real>> boxes);

  StaggeredMargins() = default;
  explicit StaggeredMargins(const core::Margins<D, Real>& first) : first_(first), now_(first) {}

  /// The margins of boxes that are enlarged from now on.
  const core::Margins<D, Real>& now() const noexcept { return now_; }

  /// Enlarges each box by a share of its margin that depends on its place, for the frame that enlarges all.
  void enlarge_all(std::span<const Box<D, Real>> boxes, std::span<Box<D, Real>> enlarged) const;

  /// Whether smaller enlarged boxes would save candidates: the boxes or the margins shrank.
  bool are_much_too_large(const Box<D, Real>& enlarged, const Box<D, Real>& box) const;

  /// Notes how many of the boxes left their enlarged boxes in a frame. Margins grow again if these are many.
  void note_left(std::size_t left, std::size_t boxes);

  /// Calls visit(i) for the next share of the boxes. After a sweep over all of them, margins shrink if hardly
  /// any box has left: smaller ones make fewer candidates.
  template <typename Visit>
  void review(std::size_t boxes, Visit visit) {
    const std::size_t end = std::min(boxes, next_ + boxes / frames_of_sweep + 1);
    for (; next_ < end; ++next_) visit(next_);
    if (next_ >= boxes) end_sweep(boxes);
  }

 private:
  static constexpr std::size_t frames_of_sweep = 64;

  void end_sweep(std::size_t boxes);

  core::Margins<D, Real> first_{};
  core::Margins<D, Real> now_{};
  double share_ = 1;  // of the first margins
  bool may_shrink_ = true;
  std::size_t next_ = 0;  // box of the sweep
  std::size_t left_ = 0;  // boxes that left their enlarged boxes in this sweep
};

}  // namespace broadside::track
