// Motion: still boxes set moving, and random histories that contain everything a history may contain.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "lab/scenes/scene.hpp"

namespace broadside::lab {

/// Still boxes set moving, one step at a time: for motion that is too long to keep in memory.
///
/// A fraction request.moving of the boxes, chosen once, are movers. Each moves in its own direction by
/// request.drift times its mean extent per frame (the mean of all boxes if it is a point), and is reflected
/// at the bounds of `boxes`, so that it never leaves them. In each frame, a random fraction request.teleport
/// of the movers jumps anywhere within the bounds instead. Sizes are constant apart from rounding. Infinite
/// and absent boxes do not move.
///
/// With `whole_steps`, a mover moves by an integer per frame on each axis, at least 1 on one of them, so that
/// integers remain integers. Memory: O(movers). A step costs O(movers).
template <int D, typename Real = float>
class MovingBoxes {
 public:
  /// Throws InvalidSpec if a fraction is not from 0 to 1, or if the drift is negative or not finite.
  MovingBoxes(std::span<const Box<D, Real>> boxes, const SceneRequest& request, bool whole_steps);
  ~MovingBoxes();
  MovingBoxes(const MovingBoxes&) = delete;
  MovingBoxes& operator=(const MovingBoxes&) = delete;

  /// The step to the next frame: the movers whose bounds changed.
  Step<D, Real> next();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The first request.frames steps of MovingBoxes, in memory. Cost: O(frames x movers) time and memory.
template <int D, typename Real = float>
History<D, Real> set_moving(std::vector<Box<D, Real>> boxes, const SceneRequest& request, bool whole_steps);

/// The contents of a random history.
struct Churn {
  std::size_t boxes = 60;      ///< approximate number of boxes
  std::size_t frames = 30;     ///< steps after the first frame
  std::uint64_t seed = 1;      ///< the same seed gives the same history on every machine
  bool infinite_boxes = true;  ///< whether some boxes are infinite, and some as large as floats allow
};

/// A history for tests of trackers. From frame to frame, boxes are added, moved, removed and teleported;
/// places are reused, some in the frame in which their box is removed; the array grows and shrinks; some
/// frames change nothing, some everything, and some list an unchanged box. Coordinates are small integers, so
/// ties are frequent; there are points, duplicates and -0.0.
template <int D>
History<D> random_history(const Churn& churn);

}  // namespace broadside::lab
