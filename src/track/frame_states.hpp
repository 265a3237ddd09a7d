// FrameStates: the boxes and filters of the last whole frame and of the one that is being taken.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadside/error.hpp"
#include "broadside/follower.hpp"
#include "broadside/tracker.hpp"

#include "core/parallel.hpp"

namespace broadside::track {

/// Invalid boxes of a frame count as absent, and are listed as long as they do not change.
template <int D, typename Real>
class FrameStates {
 public:
  /// Takes the next frame. `takes_all`: every box counts as changed. `lists_once`: no box is listed twice,
  /// and each is valid or absent.
  void take(const Frame<D, Real>& frame, bool takes_all, bool lists_once, core::Parallel& parallel);

  /// What differs between the two frames, once one is taken.
  Change<D, Real> change(bool rebuild, const Workers& workers) const noexcept;

  /// Takes the memory that keep() needs.
  void prepare_to_keep() { quarantined_.reserve(quarantined_.size() + invalid_.size()); }

  /// Makes the frame that was taken the last whole one.
  void keep(const Frame<D, Real>& frame, core::Parallel& parallel) noexcept;

  /// How many boxes there are to be changed: those of the last frame, whether or not it was a whole one.
  std::size_t size() const noexcept { return before_.size(); }

  /// The boxes of the last whole frame, and their filters.
  std::span<const Box<D, Real>> last_boxes() const noexcept { return std::span(before_).first(known_); }
  std::span<const Filter> last_filters() const noexcept {
    return std::span(filters_before_).first(filters_before_.empty() ? 0 : known_);
  }

  /// The places of the last whole frame's invalid boxes, ascending.
  std::span<const BoxId> quarantined() const noexcept { return quarantined_; }

  std::size_t bytes() const noexcept;

 private:
  std::vector<Box<D, Real>> before_;
  std::size_t known_ = 0;  // an update that failed may have left before_ longer
  std::vector<Box<D, Real>> now_;
  std::vector<Filter> filters_before_;  // both empty until there are filters
  std::vector<Filter> filters_now_;     // after keep() as long as it was, for an index that uses it
  std::vector<BoxId> changed_;
  std::vector<std::uint8_t> flags_;
  std::vector<BoxId> invalid_;  // of the changed ones
  std::vector<BoxId> quarantined_;
};

}  // namespace broadside::track
