// Failing inputs made small: whatever can go goes, as long as the failure remains.
#include "smallest_failure.hpp"

#include <algorithm>
#include <exception>
#include <functional>
#include <numeric>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "lab/verify.hpp"

namespace broadside::laws {
namespace {

/// A failure's text; empty if there is none.
using Failure = std::string;

template <typename Check>
Failure failure_of(Check check) {
  try {
    const auto divergence = check();
    return divergence ? divergence->text : "";
  } catch (const std::exception& error) {
    return std::string("throws: ") + error.what();
  }
}

/// Drops from `items` what `still_fails` does without: halves first, then ever smaller parts, down to single
/// items.
template <typename Item>
void drop_what_can_go(std::vector<Item>& items, const std::function<bool()>& still_fails) {
  for (std::size_t part = items.size(); part > 0; part /= 2) {
    for (std::size_t begin = 0; begin < items.size();) {
      std::vector<Item> all = items;
      const std::size_t end = std::min(begin + part, items.size());
      items.erase(items.begin() + static_cast<std::ptrdiff_t>(begin),
                  items.begin() + static_cast<std::ptrdiff_t>(end));
      if (still_fails()) continue;
      items = std::move(all);
      begin += part;
    }
  }
}

/// Whether no step changes a box beyond both its own frame and the one before.
template <int D>
bool is_valid(const lab::History<D>& history) {
  std::size_t known = history.boxes.size();
  for (const lab::Step<D>& step : history.steps) {
    const std::size_t size = std::max(known, step.size);
    if (std::ranges::any_of(step.changed, [size](BoxId id) { return index(id) >= size; })) return false;
    known = step.size;
  }
  return true;
}

template <int D>
std::string text_of(std::span<const Box<D>> boxes) {
  std::string text;
  for (const Box<D>& box : boxes.first(std::min<std::size_t>(boxes.size(), 20)))
    text += fmt::format("\n  {{{{{}}}, {{{}}}}}", fmt::join(box.min, ", "), fmt::join(box.max, ", "));
  if (boxes.size() > 20) text += fmt::format("\n  ... {} in all", boxes.size());
  return text;
}

}  // namespace

template <int D>
testing::AssertionResult finds_the_pairs(const Algorithm& algorithm, const Spec& spec,
                                         std::vector<Box<D>> boxes) {
  Failure failure;
  const auto fails = [&] {
    const Failure found = failure_of(
        [&] { return lab::check_finder<D>(*make_finder<D>(algorithm, spec), boxes, spec.text()); });
    if (!found.empty()) failure = found;
    return !found.empty();
  };
  if (!fails()) return testing::AssertionSuccess();
  drop_what_can_go(boxes, fails);
  return testing::AssertionFailure() << failure << "\nboxes:" << text_of<D>(boxes);
}

template <int D>
testing::AssertionResult tracks_the_pairs(const Algorithm& algorithm, const Spec& spec,
                                          lab::History<D> history) {
  Failure failure;
  const auto fails = [&] {
    if (!is_valid(history)) return false;
    const Failure found = failure_of(
        [&] { return lab::check_tracker<D>(*make_tracker<D>(algorithm, spec), history, spec.text()); });
    if (!found.empty()) failure = found;
    return !found.empty();
  };
  if (!fails()) return testing::AssertionSuccess();
  drop_what_can_go(history.steps, fails);
  for (lab::Step<D>& step : history.steps) {
    std::vector<std::size_t> kept(step.changed.size());
    std::iota(kept.begin(), kept.end(), std::size_t{0});
    const lab::Step<D> whole = step;
    const auto take_kept = [&] {
      step.changed.clear();
      step.boxes.clear();
      for (const std::size_t i : kept) {
        step.changed.push_back(whole.changed[i]);
        step.boxes.push_back(whole.boxes[i]);
      }
    };
    drop_what_can_go(kept, [&] {
      take_kept();
      return fails();
    });
    take_kept();
  }
  drop_what_can_go(history.boxes, fails);
  std::string text = failure + "\nfirst frame:" + text_of<D>(history.boxes);
  for (const lab::Step<D>& step : history.steps) {
    text += fmt::format("\nthen {} boxes, changed:", step.size);
    for (const BoxId id : step.changed) text += fmt::format(" {}", index(id));
    text += ", to:" + text_of<D>(step.boxes);
  }
  return testing::AssertionFailure() << text;
}

template testing::AssertionResult finds_the_pairs(const Algorithm&, const Spec&, std::vector<Box<2>>);
template testing::AssertionResult finds_the_pairs(const Algorithm&, const Spec&, std::vector<Box<3>>);
template testing::AssertionResult tracks_the_pairs(const Algorithm&, const Spec&, lab::History<2>);
template testing::AssertionResult tracks_the_pairs(const Algorithm&, const Spec&, lab::History<3>);

}  // namespace broadside::laws
