// Reduces failing inputs by delta debugging.
#include "broadside/debug/minimise.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace broadside {
namespace {

/// Drops items while still_fails() remains true.
template <typename Items>
void drop_what_can_go(Items& items, const std::function<bool()>& still_fails,
                      const std::function<bool()>& stop) {
  for (std::size_t part = items.size(); part > 0; part /= 2) {
    for (std::size_t begin = 0; begin < items.size();) {
      if (stop && stop()) return;
      Items all = items;
      const std::size_t end = std::min(begin + part, items.size());
      items.erase(items.begin() + static_cast<std::ptrdiff_t>(begin),
                  items.begin() + static_cast<std::ptrdiff_t>(end));
      if (still_fails()) continue;
      items = std::move(all);
      begin += part;
    }
  }
}

/// Whether each changed box is in the frame of its step or in the frame before.
template <int D, typename Real>
bool is_valid(const History<D, Real>& history) {
  std::size_t known = history.boxes.size();
  for (const Step<D, Real>& step : history.steps) {
    const std::size_t size = std::max(known, step.size);
    if (std::any_of(step.changed.begin(), step.changed.end(), [size](BoxId id) { return index(id) >= size; }))
      return false;
    known = step.size;
  }
  return true;
}

/// Drops the boxes that the failure does not need.
template <int D, typename Real>
void drop_places(History<D, Real>& history, const HistoryFails<D, Real>& fails,
                 const std::function<bool()>& stop) {
  const History<D, Real> whole = std::move(history);
  std::vector<std::size_t> kept(places_of(whole));
  std::iota(kept.begin(), kept.end(), std::size_t{0});
  drop_what_can_go(
      kept, [&] { return fails(only<D, Real>(kept, whole)); }, stop);
  history = only<D, Real>(kept, whole);
}

/// Drops the changes of a step that the failure does not need.
template <int D, typename Real>
void drop_changes(Step<D, Real>& step, const std::function<bool()>& still_fails,
                  const std::function<bool()>& stop) {
  const Step<D, Real> whole = step;
  std::vector<std::size_t> kept(whole.changed.size());
  std::iota(kept.begin(), kept.end(), std::size_t{0});
  const auto take_kept = [&] {
    step.changed.clear();
    step.boxes.clear();
    step.filters.clear();
    for (const std::size_t i : kept) {
      step.changed.push_back(whole.changed[i]);
      step.boxes.push_back(whole.boxes[i]);
      if (!whole.filters.empty()) step.filters.push_back(whole.filters[i]);
    }
  };
  drop_what_can_go(
      kept,
      [&] {
        take_kept();
        return still_fails();
      },
      stop);
  take_kept();
}

}  // namespace

template <int D, typename Real>
History<D, Real> only(std::span<const std::size_t> kept, const History<D, Real>& history) {
  const auto below = [kept](std::size_t place) {
    return static_cast<std::size_t>(std::lower_bound(kept.begin(), kept.end(), place) - kept.begin());
  };
  const auto has = [&](BoxId id) {
    return std::binary_search(kept.begin(), kept.end(), std::size_t{index(id)});
  };
  const auto place_of = [&](BoxId id) { return BoxId(below(index(id))); };
  const auto only_pairs = [&](std::span<const Pair> pairs) {
    detail::Vector<Pair> left;
    for (const Pair pair : pairs) {
      if (has(pair.first) && has(pair.second)) left.push_back({place_of(pair.first), place_of(pair.second)});
    }
    return left;
  };
  History<D, Real> rest;
  for (const std::size_t place : kept) {
    if (place < history.boxes.size()) rest.boxes.push_back(history.boxes[place]);
    if (place < history.filters.size()) rest.filters.push_back(history.filters[place]);
  }
  rest.ignored = only_pairs(history.ignored);
  for (const Step<D, Real>& step : history.steps) {
    Step<D, Real> less{below(step.size), {}, {}, {}, only_pairs(step.toggled)};
    for (std::size_t i = 0; i < step.changed.size(); ++i) {
      if (!has(step.changed[i])) continue;
      less.changed.push_back(place_of(step.changed[i]));
      less.boxes.push_back(step.boxes[i]);
      if (!step.filters.empty()) less.filters.push_back(step.filters[i]);
    }
    rest.steps.push_back(std::move(less));
  }
  return rest;
}

template <int D, typename Real>
std::size_t detail::minimise(std::span<Box<D, Real>> boxes, const BoxesFail<D, Real>& fails,
                             const std::function<bool()>& stop) {
  std::vector<Box<D, Real>> kept(boxes.begin(), boxes.end());
  drop_what_can_go(
      kept, [&] { return fails(kept); }, stop);
  std::copy(kept.begin(), kept.end(), boxes.begin());
  return kept.size();
}

template <int D, typename Real>
void minimise(History<D, Real>& history, const HistoryFails<D, Real>& fails,
              const std::function<bool()>& stop) {
  const std::function<bool()> still_fails = [&] { return is_valid(history) && fails(history); };
  drop_what_can_go(history.steps, still_fails, stop);
  drop_places(history, fails, stop);
  // With fewer boxes, more frames may be dropped.
  drop_what_can_go(history.steps, still_fails, stop);
  for (Step<D, Real>& step : history.steps) drop_changes(step, still_fails, stop);
  drop_what_can_go(history.ignored, still_fails, stop);
  for (Step<D, Real>& step : history.steps) drop_what_can_go(step.toggled, still_fails, stop);
}

template History<2> only(std::span<const std::size_t>, const History<2>&);
template History<3> only(std::span<const std::size_t>, const History<3>&);
template History<2, double> only(std::span<const std::size_t>, const History<2, double>&);
template History<3, double> only(std::span<const std::size_t>, const History<3, double>&);
template std::size_t detail::minimise<2, float>(std::span<Box2>, const BoxesFail<2, float>&,
                                                const std::function<bool()>&);
template std::size_t detail::minimise<3, float>(std::span<Box3>, const BoxesFail<3, float>&,
                                                const std::function<bool()>&);
template std::size_t detail::minimise<2, double>(std::span<DoubleBox2>, const BoxesFail<2, double>&,
                                                 const std::function<bool()>&);
template std::size_t detail::minimise<3, double>(std::span<DoubleBox3>, const BoxesFail<3, double>&,
                                                 const std::function<bool()>&);
template void minimise(History<2>&, const HistoryFails<2, float>&, const std::function<bool()>&);
template void minimise(History<3>&, const HistoryFails<3, float>&, const std::function<bool()>&);
template void minimise(History<2, double>&, const HistoryFails<2, double>&, const std::function<bool()>&);
template void minimise(History<3, double>&, const HistoryFails<3, double>&, const std::function<bool()>&);

}  // namespace broadside
