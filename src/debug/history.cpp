// Replays histories, and writes them as text.
#include "broadside/debug/history.hpp"

#include "core/input_check.hpp"
#include "debug/tracker_fault.hpp"

namespace broadside {
namespace {

/// Appends up to `max_items` lines, and the number of lines if some are left out.
template <typename Line>
void add_lines(std::string& text, std::size_t count, std::size_t max_items, const char* indent, Line line) {
  for (std::size_t i = 0; i < std::min(count, max_items); ++i) text += indent + line(i);
  if (count > max_items) text += indent + ("... " + std::to_string(count) + " in all");
}

std::string text_of(const Filter& filter) {
  return ", category " + std::to_string(filter.category) + ", mask " + std::to_string(filter.mask) +
         ", group " + std::to_string(filter.group) + (filter.is_static ? ", static" : "");
}

/// One box with its place, and its filter if there is one.
template <int D, typename Real>
std::string line_of(std::size_t place, const Box<D, Real>& box, std::span<const Filter> filters,
                    std::size_t i) {
  return std::to_string(place) + ": " + (is_absent(box) ? "absent" : core::text_of(box)) +
         (filters.empty() ? "" : text_of(filters[i]));
}

}  // namespace

template <int D, typename Real>
Frame<D, Real> Replay<D, Real>::next(const Step<D, Real>& step) {
  apply(step, boxes_);
  if (!filters_.empty() || !step.filters.empty()) filters_.resize(step.size);
  for (std::size_t i = 0; i < step.filters.size(); ++i) {
    if (index(step.changed[i]) < step.size) filters_[index(step.changed[i])] = step.filters[i];
  }
  for (const Pair pair : step.toggled) {
    if (!ignored_.insert(pair)) ignored_.erase(pair);
  }
  changed_ = step.changed;
  ignored_changed_ = step.toggled;
  return frame();
}

template <int D, typename Real>
std::string text_of(const History<D, Real>& history, std::size_t max_items) {
  std::string text = "frame 0: " + std::to_string(history.boxes.size()) + " boxes";
  add_lines(text, history.boxes.size(), max_items, "\n  ",
            [&](std::size_t i) { return line_of(i, history.boxes[i], history.filters, i); });
  const auto add_pairs = [&](const char* what, std::span<const Pair> pairs) {
    if (pairs.empty()) return;
    text += what;
    add_lines(text, pairs.size(), max_items, " ", [&](std::size_t i) { return debug::text_of(pairs[i]); });
  };
  add_pairs("\n  ignored:", history.ignored);
  for (std::size_t frame = 1; frame <= std::min(history.steps.size(), max_items); ++frame) {
    const Step<D, Real>& step = history.steps[frame - 1];
    text += "\nframe " + std::to_string(frame) + ": " + std::to_string(step.size) + " boxes, changed";
    add_lines(text, step.changed.size(), max_items, "\n  ",
              [&](std::size_t i) { return line_of(index(step.changed[i]), step.boxes[i], step.filters, i); });
    if (step.changed.empty()) text += " none";
    add_pairs("\n  ignored or no longer ignored:", step.toggled);
  }
  if (history.steps.size() > max_items)
    text += "\n... " + std::to_string(history.steps.size() + 1) + " frames in all";
  return text;
}

template class Replay<2, float>;
template class Replay<3, float>;
template class Replay<2, double>;
template class Replay<3, double>;
template std::string text_of(const History<2>&, std::size_t);
template std::string text_of(const History<3>&, std::size_t);
template std::string text_of(const History<2, double>&, std::size_t);
template std::string text_of(const History<3, double>&, std::size_t);

}  // namespace broadside
