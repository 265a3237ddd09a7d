// Measures a case: searches of boxes or updates of moving ones, by all algorithms in turn.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "broadside/debug/history.hpp"

#include "lab/measure/benchmark.hpp"
#include "lab/measure/reference.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::lab {

/// Inputs of a function whose caller specifies D and Real: they are not deduced.
template <int D, typename Real>
using Histories = std::type_identity_t<std::span<const History<D, Real>>>;

/// A subset of the boxes of a history and its first steps, as a history.
template <int D, typename Real>
History<D, Real> thinned(const History<D, Real>& history, std::size_t count, std::size_t max_steps) {
  constexpr std::size_t left_out = static_cast<std::size_t>(-1);
  std::size_t size = history.boxes.size();
  for (const Step<D, Real>& step : history.steps) size = std::max(size, step.size);
  std::vector<std::size_t> place(size, left_out);
  History<D, Real> thin;
  std::size_t next = 0;
  for (const std::size_t i : sample_of(size, count)) {
    place[i] = next++;
    thin.boxes.push_back(i < history.boxes.size() ? history.boxes[i] : absent_box<D, Real>());
  }
  for (std::size_t s = 0; s < std::min(max_steps, history.steps.size()); ++s) {
    const Step<D, Real>& step = history.steps[s];
    Step<D, Real> few{thin.boxes.size(), {}, {}};
    for (std::size_t i = 0; i < step.changed.size(); ++i) {
      if (place[index(step.changed[i])] == left_out) continue;
      few.changed.push_back(BoxId(place[index(step.changed[i])]));
      few.boxes.push_back(step.boxes[i]);
    }
    thin.steps.push_back(std::move(few));
  }
  return thin;
}

/// Measures the case by measure_find() or measure_track(). If peers or several threads take part, this runs
/// in a child process if the system can copy a process. An algorithm fails if it ends the child or if a call
/// takes longer than the limit of the effort. The others are then measured again without it. `hung`
/// collects the algorithms that did not return; these are skipped.
///
/// Throws Stopped.
template <int D, typename Real = float>
CaseResult measure_case(const Case& measured, Histories<D, Real> inputs, const Benchmark& benchmark,
                        std::vector<std::string>& hung);

/// Times one whole find() per entry and round, into a vector with memory already allocated. A round uses the
/// boxes of one input (one per seed of the case); inputs take turns. Each entry takes part in the first
/// rounds, as many as the effort allows, and every result is checked. Returns one measurement per entry, in
/// their order. With float boxes, the lower bound (floor.hpp) is timed in every round.
///
/// Throws Stopped. An exception of an algorithm counts as its failure.
template <int D, typename Real = float>
CaseResult measure_find(const Case& measured, Histories<D, Real> inputs, const Benchmark& benchmark);

/// Times each update() of a history after the first, in which all is new and which is timed separately. A
/// round is a pass over one input (one per seed of the case); inputs take turns. Each entry takes part in the
/// first rounds, as many as the effort allows. In a round the entries take turns frame by frame, and all
/// events are checked. Returns one measurement per entry, in their order.
///
/// Throws Stopped. An exception of an algorithm counts as its failure.
template <int D, typename Real = float>
std::vector<Measurement> measure_track(const Case& measured, Histories<D, Real> inputs,
                                       const Benchmark& benchmark);

}  // namespace broadside::lab
