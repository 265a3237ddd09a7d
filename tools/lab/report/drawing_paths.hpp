// Boxes and the lines between them as the paths of an SVG, short.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace broadside::lab {

/// A rectangle in the world, seen along one axis; perhaps infinite.
struct Rectangle {
  std::array<double, 2> min;
  std::array<double, 2> max;
};

/// A window on the world, and its size in a picture.
struct Window {
  std::array<double, 2> low;
  std::array<double, 2> high;
  int width;
  int height;

  /// Where a point is in the picture, in units, y from the top; clipped to the window.
  double x(double world) const;
  double y(double world) const;
};

/// Whether any of the rectangle lies in the window.
bool is_seen(const Rectangle& rectangle, const Window& window);

/// The window that shows these rectangles but for far outliers, 1000 units wide, and neither higher than that
/// nor less than a quarter of it.
Window window_on(std::span<const Rectangle> rectangles);

/// Appends a rectangle, in tenths of a unit, unless none of it is seen.
void append_rectangle(std::string& path, const Rectangle& rectangle, const Window& window);

/// Appends a straight line along an axis (0: to the right) from `from` to `to`, at `at` on the other axis.
void append_line(std::string& path, int axis, double at, double from, double to, const Window& window);

/// The edges of rectangles, level by level, in whole units: where several lie on each other, one line.
class Edges {
 public:
  explicit Edges(const Window& window) : window_(window) {}

  /// The lines of these rectangles that no earlier call has returned.
  std::string next_level(std::span<const Rectangle> rectangles);

 private:
  using Interval = std::pair<int, int>;
  using Lines = std::map<int, std::vector<Interval>>;

  Window window_;
  std::array<Lines, 2> drawn_;  // by the axis that they go along
};

}  // namespace broadside::lab
