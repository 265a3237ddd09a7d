// How the experiments on section VI time the paper's trackers: mending, searching and the whole frame apart.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "paper/experiments/laboratory.hpp"

namespace broadside::lab {

/// One of the paper's trackers on a history: the median frame, and counts of a mean one.
struct MendingCost {
  double mending_ms = 0;    ///< to find out what changed and mend the structure, or to build it anew
  double structure_ms = 0;  ///< the second part of that alone
  double searching_ms = 0;
  double frame_ms = 0;    ///< the whole update, the comparison with the pairs before in it
  double moved = 0;       ///< entries moved, a mover (UpdateParts::moved)
  double visited = 0;     ///< likewise (UpdateParts::visited)
  double references = 0;  ///< a box
  double mover_ns = 0;    ///< mending_ms for each box that changes
};

/// The costs of `specs`, trackers of the paper's listings, in that order; they take turns, round by round, on
/// the history that the request describes. The events of every timed frame are checked. Throws
/// std::runtime_error if a frame's are wrong, and Stopped.
template <int D>
std::vector<MendingCost> measure_mending(const Laboratory& laboratory, const std::vector<std::string>& specs,
                                         const CaseRequest& request);

/// The same on a history of the experiment's own; `name` is what it is called.
template <int D>
std::vector<MendingCost> measure_mending(const Laboratory& laboratory, const std::vector<std::string>& specs,
                                         const std::string& name, const History<D>& history);

/// The specs of paper_sweep_and_prune with each of these values of `update`.
std::vector<std::string> sweeps_by(const std::vector<std::string>& updates);

}  // namespace broadside::lab
