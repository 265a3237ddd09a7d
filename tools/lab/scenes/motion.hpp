// Motion: still boxes set moving, and random histories that do everything a history may do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "lab/scenes/scene.hpp"

namespace broadside::lab {

/// Boxes set moving, one step at a time: for motion that is too long to be kept.
///
/// A fraction request.moving of the boxes, drawn once, are movers. Each goes in a direction of its own,
/// request.drift times its mean extent a frame (the mean of all boxes where it is a point), and turns back at
/// the bounds of `boxes`, so that none ever leaves them; in each frame the fraction request.teleport of the
/// movers, drawn anew, jumps anywhere within the bounds instead. Sizes stay as they are but for rounding.
/// Boxes with an infinite extent, and absent ones, do not move.
///
/// With `whole_steps`, a mover goes a whole number a frame on each axis, at least 1 on one, so that integers
/// remain integers. Memory O(movers), a step costs O(movers).
template <int D, typename Real = float>
class MovingBoxes {
 public:
  /// Throws InvalidSpec if a fraction is not from 0 to 1, or the drift is negative or not finite.
  MovingBoxes(std::span<const Box<D, Real>> boxes, const SceneRequest& request, bool whole_steps);
  ~MovingBoxes();
  MovingBoxes(const MovingBoxes&) = delete;
  MovingBoxes& operator=(const MovingBoxes&) = delete;

  /// The step to the next frame: the movers that are elsewhere than before.
  Step<D, Real> next();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The first request.frames steps of MovingBoxes, kept. Cost O(frames x movers) in time and memory.
template <int D, typename Real = float>
History<D, Real> set_moving(std::vector<Box<D, Real>> boxes, const SceneRequest& request, bool whole_steps);

/// What a random history is to contain.
struct Churn {
  std::size_t boxes = 60;      ///< about how many boxes there are
  std::size_t frames = 30;     ///< steps after the first frame
  std::uint64_t seed = 1;      ///< the same seed gives the same history on every machine
  bool infinite_boxes = true;  ///< whether some boxes are infinite, and some as large as a float can be
};

/// A history for tests of trackers. From frame to frame boxes are added, moved, removed and teleported;
/// places are used again, some in the very frame in which their box is removed; the array grows and shrinks;
/// some frames change nothing, some everything, and some list a box that stays as it was. Coordinates are
/// small integers, so ties abound; among the boxes are points, duplicates and -0.0.
template <int D>
History<D> random_history(const Churn& churn);

}  // namespace broadside::lab
