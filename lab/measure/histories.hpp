// The inputs of a case, and small ones made of them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "broadside/history.hpp"

#include "lab/measure/reference.hpp"

namespace broadside::lab {

/// Inputs for a function that is told their dimension and precision.
template <int D, typename Real>
using Histories = std::type_identity_t<std::span<const History<D, Real>>>;

/// Some of the boxes of a history and its first steps, as a history of their own.
template <int D, typename Real>
History<D, Real> thinned(const History<D, Real>& history, std::size_t count, std::size_t most_steps) {
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
  for (std::size_t s = 0; s < std::min(most_steps, history.steps.size()); ++s) {
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

}  // namespace broadside::lab
