// History: boxes that change from frame to frame, stored so that they can be replayed.
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
  detail::Vector<BoxId> changed;       ///< the ids of boxes that change, each once
  detail::Vector<Box<D, Real>> boxes;  ///< their new boxes, in the same order; absent if a box is removed

  detail::Vector<Filter> filters{};  ///< their new filters, in the same order; empty if no filter changes
  detail::Vector<Pair> toggled{};    ///< pairs that become ignored, or cease to be ignored
};

/// The boxes of a first frame, and the steps to the frames that follow.
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

/// The number of boxes in the largest frame.
template <int D, typename Real>
[[nodiscard]] std::size_t places_of(const History<D, Real>& history) {
  std::size_t places = history.boxes.size();
  for (const Step<D, Real>& step : history.steps) places = std::max(places, step.size);
  return places;
}

/// Replays a history, frame by frame.
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

  /// The current frame. Valid until next() is called.
  [[nodiscard]] Frame<D, Real> frame() const noexcept {
    return {boxes_, changed_, filters_, &ignored_, ignored_changed_};
  }

  /// Applies the step, which is copied, and returns the new frame.
  Frame<D, Real> next(const Step<D, Real>& step);

 private:
  detail::Vector<Box<D, Real>> boxes_;
  detail::Vector<Filter> filters_;
  IgnoredPairs ignored_;
  detail::Vector<BoxId> changed_;
  detail::Vector<Pair> ignored_changed_;
};

/// The history that begins with this frame and continues with these steps.
template <int D, typename Real>
[[nodiscard]] History<D, Real> history_of(const Frame<D, Real>& frame,
                                          std::vector<Step<D, Real>> steps = {}) {
  History<D, Real> history{{frame.boxes.begin(), frame.boxes.end()},
                           std::move(steps),
                           {frame.filters.begin(), frame.filters.end()},
                           {}};
  if (frame.ignored != nullptr) frame.ignored->for_each([&](Pair pair) { history.ignored.push_back(pair); });
  std::sort(history.ignored.begin(), history.ignored.end());
  return history;
}

/// The history as text, one line per box. It shows at most `max_items` frames, and as many boxes per frame,
/// and counts what it leaves out.
template <int D, typename Real>
[[nodiscard]] BROADSIDE_PUBLIC std::string text_of(const History<D, Real>& history,
                                                   std::size_t max_items = 20);

}  // namespace broadside
