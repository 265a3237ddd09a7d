// Building blocks of the families of hard inputs: small functions on boxes of doubles.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "lab/scenes/scatter.hpp"
#include "lab/worst/family.hpp"

namespace broadside::lab {

template <int D>
using Point = std::array<double, D>;

/// The box with lower corner `min`.
template <int D>
Box<D, double> box_at(const Point<D>& min, const Size<D>& size) {
  Box<D, double> box;
  for (int axis = 0; axis < D; ++axis) {
    box.min[axis] = min[axis];
    box.max[axis] = min[axis] + size[axis];
  }
  return box;
}

/// A cube of this side.
template <int D>
Size<D> cube(double side) {
  Size<D> size;
  size.fill(side);
  return size;
}

/// A random point of the unit cube.
template <int D>
Point<D> anywhere(Random& random) {
  Point<D> point;
  for (double& coordinate : point) coordinate = random.fraction();
  return point;
}

/// The side of cubes that touch `neighbours` others on average if `count` are scattered over the unit cube.
template <int D>
double side_for(double neighbours, std::size_t count) {
  return power(neighbours / static_cast<double>(std::max<std::size_t>(count, 1)), 1.0 / D) / 2;
}

/// Cubes of about the same size, scattered over the unit cube.
template <int D>
DoubleBoxes<D> even_boxes(std::size_t count, double neighbours, Random& random) {
  DoubleBoxes<D> boxes;
  const double side = side_for<D>(neighbours, count);
  for (std::size_t i = 0; i < count; ++i) {
    const Point<D> min = anywhere<D>(random);
    Size<D> size = modest_size<D>(random);
    for (double& extent : size) extent *= side;
    boxes.push_back(box_at<D>(min, size));
  }
  return boxes;
}

/// A family whose boxes `Maker::make<D>` makes.
template <typename Maker>
InputFamily family_of(std::string name, std::string summary, std::vector<DrawnTunable> tunables) {
  InputFamily family;
  family.name = std::move(name);
  family.summary = std::move(summary);
  family.tunables = std::move(tunables);
  family.boxes_2d = Maker::template make<2>;
  family.boxes_3d = Maker::template make<3>;
  return family;
}

inline DrawnTunable number(std::string name, std::string summary, std::string default_value, double min,
                           double max) {
  return {{.name = std::move(name),
           .summary = std::move(summary),
           .default_value = std::move(default_value),
           .min = min,
           .max = max}};
}

/// A number from `min` to `max`, drawn with all orders of magnitude equally likely.
inline DrawnTunable magnitude(std::string name, std::string summary, std::string default_value, double min,
                              double max) {
  DrawnTunable drawn = number(std::move(name), std::move(summary), std::move(default_value), min, max);
  drawn.logarithmic = true;
  return drawn;
}

inline DrawnTunable count(std::string name, std::string summary, std::string default_value, double min,
                          double max) {
  DrawnTunable drawn = magnitude(std::move(name), std::move(summary), std::move(default_value), min, max);
  drawn.tunable.type = Tunable::Type::integer;
  return drawn;
}

/// The first choice is the default.
inline DrawnTunable choice(std::string name, std::string summary, std::vector<std::string> choices) {
  return {{.name = std::move(name),
           .summary = std::move(summary),
           .default_value = choices.front(),
           .type = Tunable::Type::choice,
           .choices = choices}};
}

inline DrawnTunable neighbours() {
  return magnitude("neighbours", "how many others a box touches on average, roughly", "1", 1e-3, 6);
}

}  // namespace broadside::lab
