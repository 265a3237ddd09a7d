// How the experiments on section VI time the paper's trackers: finding out what changed, mending the
// structure and searching it apart, and the whole frame.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "paper/experiments/laboratory.hpp"
#include "paper/experiments/table.hpp"

namespace broadside::lab {

/// The milliseconds of each frame, round by round.
struct FrameTimes {
  std::vector<double> all{};
  std::size_t frames = 0;  ///< a round

  double median() const;

  friend FrameTimes operator+(const FrameTimes& a, const FrameTimes& b);
};

/// One of the paper's trackers on a history: its times, and counts of a mean frame.
struct MendingCost {
  FrameTimes detecting{};  ///< finding out which boxes changed
  FrameTimes mending{};    ///< the structure alone: mended, or built anew
  FrameTimes searching{};
  FrameTimes frame{};     ///< the whole update, the comparison with the pairs before in it
  double moved = 0;       ///< entries moved, a mover (Phases::moved)
  double visited = 0;     ///< likewise (Phases::visited)
  double references = 0;  ///< a box
  double movers = 0;      ///< boxes that change

  /// Nanoseconds of mending for each box that changes.
  double mover_ns() const;
};

/// The times of one tracker over those of another, frame by frame, as three cells: the median ratio, and the
/// bounds of its 95 % interval.
std::vector<Cell> ratio_cells(const FrameTimes& times, const FrameTimes& others);

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
