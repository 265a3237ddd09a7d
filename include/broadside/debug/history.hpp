// History: boxes that change from frame to frame, kept so that they can be played again.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/export.hpp"
#include "broadside/filter.hpp"
#include "broadside/pair.hpp"
#include "broadside/tracker.hpp"

namespace broadside {

/// What changes from one frame to the next.
template <int D, typename Real = float>
struct Step {
  std::size_t size;                    ///< the number of boxes from this frame on
  detail::Vector<BoxId> changed;       ///< places whose boxes change, each once
  detail::Vector<Box<D, Real>> boxes;  ///< their new boxes, in the same order; absent where one is removed

  detail::Vector<Filter> filters{};  ///< their new filters, likewise; empty if all keep their filters
  detail::Vector<Pair> toggled{};    ///< pairs that become ignored if they were not, and the other way round
};

/// The boxes of a first frame and the steps to the following ones; no steps where nothing moves.
template <int D, typename Real = float>
struct History {
  detail::Vector<Box<D, Real>> boxes;
  detail::Vector<Step<D, Real>> steps;

  detail::Vector<Filter> filters{};  ///< one for each box; empty if all have the default filter
  detail::Vector<Pair> ignored{};    ///< the pairs that do not count in the first frame
};

/// Applies a step: turns the boxes of one frame into the boxes of the next. `boxes` is a std::vector or
/// History::boxes.
template <int D, typename Real, typename Boxes>
void apply(const Step<D, Real>& step, Boxes& boxes) {
  boxes.resize(step.size, absent_box<D, Real>());
  for (std::size_t i = 0; i < step.changed.size(); ++i) {
    if (index(step.changed[i]) < step.size) boxes[index(step.changed[i])] = step.boxes[i];
  }
}

/// How many places there are in the frame that has the most.
template <int D, typename Real>
std::size_t places_of(const History<D, Real>& history) {
  std::size_t places = history.boxes.size();
  for (const Step<D, Real>& step : history.steps) places = std::max(places, step.size);
  return places;
}

/// A frame of a history, and then the next one.
///
///     Replay replay(history);
///     tracker.update(replay.frame(), begun, ended);
///     for (const Step<2>& step : history.steps) tracker.update(replay.next(step), begun, ended);
template <int D, typename Real = float>
class BROADSIDE_PUBLIC Replay {
 public:
  Replay() = default;
  explicit Replay(const History<D, Real>& history)
      : boxes_(history.boxes), filters_(history.filters), ignored_changed_(history.ignored) {
    for (const Pair pair : history.ignored) ignored_.insert(pair);
  }

  /// The frame as a tracker takes it. Valid until the next call of next().
  Frame<D, Real> frame() const noexcept { return {boxes_, changed_, filters_, &ignored_, ignored_changed_}; }

  /// The frame after the step, which is copied.
  Frame<D, Real> next(const Step<D, Real>& step);

 private:
  detail::Vector<Box<D, Real>> boxes_;
  detail::Vector<Filter> filters_;
  IgnoredPairs ignored_;
  detail::Vector<BoxId> changed_;
  detail::Vector<Pair> ignored_changed_;
};

/// A history that begins with this frame and goes on with these steps.
template <int D, typename Real>
History<D, Real> history_of(const Frame<D, Real>& frame, std::vector<Step<D, Real>> steps = {}) {
  History<D, Real> history{{frame.boxes.begin(), frame.boxes.end()},
                           std::move(steps),
                           {frame.filters.begin(), frame.filters.end()},
                           {}};
  if (frame.ignored != nullptr) frame.ignored->for_each([&](Pair pair) { history.ignored.push_back(pair); });
  std::sort(history.ignored.begin(), history.ignored.end());
  return history;
}

/// The history for people to read, a line a box, with as many boxes of a frame and as many frames as `most`
/// says; what is left out is counted.
template <int D, typename Real>
BROADSIDE_PUBLIC std::string text_of(const History<D, Real>& history, std::size_t most = 20);

}  // namespace broadside
