// Boxes and the lines between them as compact SVG paths.
#include "lab/report/drawing_paths.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace broadside::lab {
namespace {

constexpr int view_width = 1000;

/// The view's minimum height over its width.
constexpr double flattest = 0.25;

/// The margin around the contents, as a fraction of the window's width.
constexpr double margin = 0.01;

/// The side of the square that shows a point, in tenths.
constexpr long dot = 40;

/// Boxes whose centres are beyond this quantile at either end may be outliers.
constexpr double outlying = 0.01;

/// The number of tenths as a decimal number.
std::string tenths(long number) {
  std::string text = std::to_string(std::labs(number) / 10);
  if (number % 10 != 0) text += "." + std::to_string(std::labs(number) % 10);
  return number < 0 ? "-" + text : text;
}

long in_tenths(double units) { return std::lround(10 * units); }

/// Two numbers, separated by a blank unless the second one has a sign.
std::string joined(const std::string& first, const std::string& second) {
  return second.starts_with('-') ? first + second : first + " " + second;
}

/// A straight line from a point: 'h' to the right, 'v' down.
std::string stroke(const std::string& x, const std::string& y, char command, const std::string& length) {
  return "M" + joined(x, y) + command + length;
}

double place(double world, double low, double high, int length) {
  if (world <= low) return 0;
  return world >= high ? length : (world - low) / (high - low) * length;
}

/// The finite range of an axis that shows most rectangles whole.
std::pair<double, double> range_of(std::span<const Rectangle> rectangles, int axis) {
  std::vector<double> middles;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Rectangle& rectangle : rectangles) {
    for (const double end : {rectangle.min[axis], rectangle.max[axis]}) {
      if (!std::isfinite(end)) continue;
      low = std::min(low, end);
      high = std::max(high, end);
    }
    const double middle = rectangle.min[axis] / 2 + rectangle.max[axis] / 2;
    if (std::isfinite(middle)) middles.push_back(middle);
  }
  if (!(low <= high)) return {0, 1};
  if (middles.empty()) return {low, high};
  std::ranges::sort(middles);
  const auto last = static_cast<double>(middles.size() - 1);
  const double first = middles[static_cast<std::size_t>(std::floor(outlying * last))];
  const double final = middles[static_cast<std::size_t>(std::ceil((1 - outlying) * last))];
  // A few boxes without extent at one place give no scale: then shows everything.
  const double beyond = (final - first) / 4;
  if (!(beyond > 0)) return {low, high};
  return {std::max(low, first - beyond), std::min(high, final + beyond)};
}

/// Sorts intervals and merges those that touch.
void join(std::vector<std::pair<int, int>>& intervals) {
  std::ranges::sort(intervals);
  std::size_t kept = 0;
  for (std::size_t i = 1; i < intervals.size(); ++i) {
    if (intervals[i].first <= intervals[kept].second)
      intervals[kept].second = std::max(intervals[kept].second, intervals[i].second);
    else
      intervals[++kept] = intervals[i];
  }
  if (!intervals.empty()) intervals.resize(kept + 1);
}

}  // namespace

double Window::x(double world) const { return place(world, low[0], high[0], width); }

double Window::y(double world) const { return height - place(world, low[1], high[1], height); }

bool is_seen(const Rectangle& rectangle, const Window& window) {
  bool seen = true;
  for (int axis = 0; axis < 2; ++axis)
    seen &= rectangle.min[axis] <= window.high[axis] && rectangle.max[axis] >= window.low[axis];
  return seen;
}

Window window_on(std::span<const Rectangle> rectangles) {
  Window window{{}, {}, view_width, view_width};
  std::array<double, 2> length;
  for (int axis = 0; axis < 2; ++axis) {
    std::tie(window.low[axis], window.high[axis]) = range_of(rectangles, axis);
    length[axis] = window.high[axis] - window.low[axis];
  }
  const double longest = std::max(length[0], length[1]);
  const double scale = longest > 0 ? longest : 1;
  const std::array<double, 2> shown = {scale, std::max(length[1], flattest * scale)};
  for (int axis = 0; axis < 2; ++axis) {
    const double middle = window.low[axis] + length[axis] / 2;
    window.low[axis] = middle - shown[axis] / 2 - margin * scale;
    window.high[axis] = middle + shown[axis] / 2 + margin * scale;
  }
  window.height = static_cast<int>(
      std::lround(view_width * (shown[1] + 2 * margin * scale) / (shown[0] + 2 * margin * scale)));
  return window;
}

void append_rectangle(std::string& path, const Rectangle& rectangle, const Window& window) {
  if (!is_seen(rectangle, window)) return;
  long left = in_tenths(window.x(rectangle.min[0]));
  long top = in_tenths(window.y(rectangle.max[1]));
  long right = in_tenths(window.x(rectangle.max[0]));
  long bottom = in_tenths(window.y(rectangle.min[1]));
  if (left == right && top == bottom) {
    // A path without length is not drawn at all.
    left -= dot / 2;
    right += dot / 2;
    top -= dot / 2;
    bottom += dot / 2;
  }
  const std::string width = tenths(right - left);
  const std::string height = tenths(bottom - top);
  path += stroke(tenths(left), tenths(top), 'h', width) + "v" + height + "h";
  path += (width == "0" ? "0" : "-" + width) + "z";
}

void append_line(std::string& path, int axis, double at, double from, double to, const Window& window) {
  const auto line = [&path](char command, double x, double y, double length) {
    path += stroke(tenths(in_tenths(x)), tenths(in_tenths(y)), command, tenths(in_tenths(length)));
  };
  if (axis == 0)
    line('h', window.x(from), window.y(at), window.x(to) - window.x(from));
  else
    line('v', window.x(at), window.y(to), window.y(from) - window.y(to));
}

std::string Edges::next_level(std::span<const Rectangle> rectangles) {
  std::array<Lines, 2> lines;
  for (const Rectangle& rectangle : rectangles) {
    if (!is_seen(rectangle, window_)) continue;
    const auto rounded = [](double unit) { return static_cast<int>(std::lround(unit)); };
    const int left = rounded(window_.x(rectangle.min[0]));
    const int right = rounded(window_.x(rectangle.max[0]));
    const int top = rounded(window_.y(rectangle.max[1]));
    const int bottom = rounded(window_.y(rectangle.min[1]));
    for (const int y : {top, bottom}) lines[0][y].emplace_back(left, right);
    for (const int x : {left, right}) lines[1][x].emplace_back(top, bottom);
  }
  std::string path;
  for (int axis = 0; axis < 2; ++axis) {
    for (auto& [at, intervals] : lines[axis]) {
      join(intervals);
      std::vector<Interval>& drawn = drawn_[axis][at];
      for (const auto& [begin, end] : intervals) {
        int from = begin;
        const auto draw_to = [&, across = at](int to) {
          if (to <= from) return;
          const int x = axis == 0 ? from : across;
          const int y = axis == 0 ? across : from;
          path +=
              stroke(std::to_string(x), std::to_string(y), axis == 0 ? 'h' : 'v', std::to_string(to - from));
        };
        for (const auto& [old_begin, old_end] : drawn) {
          if (old_end <= from || old_begin >= end) continue;
          draw_to(old_begin);
          from = std::max(from, old_end);
        }
        draw_to(end);
      }
      drawn.insert(drawn.end(), intervals.begin(), intervals.end());
      join(drawn);
    }
  }
  return path;
}

}  // namespace broadside::lab
