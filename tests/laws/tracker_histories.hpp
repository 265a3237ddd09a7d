// Hard histories for trackers, by name.
#pragma once

#include <string>
#include <vector>

#include "broadside/algorithm.hpp"

#include "whole_frames.hpp"

namespace broadside::laws {

/// Frames and what is hard about them.
template <int D>
struct NamedFrames {
  std::string name;
  std::vector<WholeFrame<D>> frames;
};

/// Random histories within the algorithm's declared limits, of each kind of coordinates.
template <int D>
std::vector<NamedFrames<D>> drawn_histories(const Algorithm& algorithm);

/// Histories made against what trackers keep from frame to frame: bounds, cells, orders, trees; within the
/// algorithm's declared limits, of at most some hundred boxes. Those that a structure can only survive if it
/// was made to are for our own and the paper's algorithms alone.
template <int D>
std::vector<NamedFrames<D>> scripted_histories(const Algorithm& algorithm);

/// A history of so many boxes, some thousands, in which everything happens: a tenth moves, all of them do,
/// boxes go and come, all jump at once.
template <int D>
std::vector<WholeFrame<D>> large_history(std::size_t count);

}  // namespace broadside::laws
