// Histories of boxes for trackers, drawn from a source of choices: boxes come, move, tremble, jump and go,
// and so do filters and ignored pairs; sinks fail; frames are handed in again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/support/rng.hpp"
#include "whole_frames.hpp"

namespace broadside::laws {

/// Which boxes are drawn.
enum class Coordinates : std::uint8_t {
  whole,   ///< small whole numbers: touching and coinciding all the time
  halves,  ///< on a lattice on which each box has a few neighbours, however many there are
  real,
  any  ///< at the ends of what a float can hold
};

/// How a history goes. Chances are given as one in so many; 0: never.
struct FrameCourse {
  std::size_t frames = 60;
  std::size_t boxes = 150;        ///< places in the first frame; later there are up to twice as many
  std::size_t changes = 8;        ///< most places that change by themselves in a frame
  std::size_t resize_one_in = 0;  ///< frames in which the array grows or shrinks
  std::size_t rest_one_in = 0;    ///< frames in which nothing changes
  std::size_t sweep_one_in = 0;   ///< frames in which many boxes change in one way
  Coordinates coordinates = Coordinates::whole;
  bool trembles = false;     ///< nearly all boxes move to and fro, so that trackers enlarge them
  bool has_filters = false;  ///< as with_filters() gives them
};

/// A history of this course, shorter where the choices are spent.
template <int D, typename Real = float>
std::vector<WholeFrame<D, Real>> draw_frames(Choices& choices, const FrameCourse& course);

/// The same frames with filters and ignored pairs that come, change and go, with and without changes of
/// boxes; with sinks of which some fail, and some frames handed in twice.
template <int D, typename Real = float>
std::vector<WholeFrame<D, Real>> with_filters(std::vector<WholeFrame<D, Real>> frames, std::uint64_t seed);

}  // namespace broadside::laws
