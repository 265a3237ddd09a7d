// Difficult histories for trackers, by name.
#pragma once

#include <string>
#include <vector>

#include "broadside/algorithm.hpp"

#include "whole_frames.hpp"

namespace broadside::laws {

/// Frames, and why they are difficult.
template <int D>
struct NamedFrames {
  std::string name;
  std::vector<WholeFrame<D>> frames;
};

/// Random histories within the algorithm's declared limits, of each kind of coordinates.
template <int D>
std::vector<NamedFrames<D>> drawn_histories(const Algorithm& algorithm);

/// Histories that attack the state which trackers keep between frames: bounds, cells, orders, trees. They are
/// within the algorithm's declared limits, of at most some hundred boxes. Histories that a structure survives
/// only by design are included only for our own and the paper's algorithms.
template <int D>
std::vector<NamedFrames<D>> scripted_histories(const Algorithm& algorithm);

/// A history of that many boxes (thousands) in which everything happens: a tenth moves, all move, boxes are
/// added and removed, all jump at once.
template <int D>
std::vector<WholeFrame<D>> large_history(std::size_t count);

}  // namespace broadside::laws
