// Boxes and the lines between them as compact SVG paths.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace broadside::lab {

/// A rectangle in the world, projected along one axis; may be infinite.
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

  /// The position of a point in the picture, in units, with y from the top; clipped to the window.
  double x(double world) const;
  double y(double world) const;
};

/// Whether any part of the rectangle is in the window.
bool is_seen(const Rectangle& rectangle, const Window& window);

/// The window that shows these rectangles except far outliers. It is 1000 units wide, and from a quarter of
/// that to as much high.
Window window_on(std::span<const Rectangle> rectangles);

/// Appends a rectangle, in tenths of a unit, unless no part of it is visible.
void append_rectangle(std::string& path, const Rectangle& rectangle, const Window& window);

/// Appends a straight line along an axis (0: to the right) from `from` to `to`, at `at` on the other axis.
void append_line(std::string& path, int axis, double at, double from, double to, const Window& window);

/// The edges of rectangles, level by level, in whole units; coinciding edges become one line.
class Edges {
 public:
  explicit Edges(const Window& window) : window_(window) {}

  /// The lines of these rectangles that no earlier call has returned.
  std::string next_level(std::span<const Rectangle> rectangles);

 private:
  using Interval = std::pair<int, int>;
  using Lines = std::map<int, std::vector<Interval>>;

  Window window_;
  std::array<Lines, 2> drawn_;  // by the axis of their direction
};

}  // namespace broadside::lab
