// Inputs on which a broad phase goes wrong.
#include "hard_inputs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "law_case.hpp"
#include "tests/support/rng.hpp"

namespace broadside::laws {
namespace {

constexpr float float_infinity = std::numeric_limits<float>::infinity();
constexpr float largest_float = std::numeric_limits<float>::max();
constexpr float smallest_float = std::numeric_limits<float>::denorm_min();

/// The box whose axis a spans `span(a)` = {min, max}.
template <int D, typename Span>
Box<D> box_of(Span span) {
  Box<D> box;
  for (int axis = 0; axis < D; ++axis) {
    const auto [a, b] = span(axis);
    box.min[axis] = std::min<float>(a, b);
    box.max[axis] = std::max<float>(a, b);
  }
  return box;
}

using Span = std::pair<float, float>;

/// `count` boxes, each of which `span(i, axis)` gives.
template <int D, typename SpanOf>
std::vector<Box<D>> boxes_of(std::size_t count, SpanOf span) {
  std::vector<Box<D>> boxes;
  for (std::size_t i = 0; i < count; ++i)
    boxes.push_back(box_of<D>([&](int axis) -> Span { return span(i, axis); }));
  return boxes;
}

/// Boxes whose coordinates are drawn from `values`, each in either order.
template <int D>
std::vector<Box<D>> drawn_from(std::vector<float> values, std::size_t count) {
  Rng rng(7);
  const std::span<const float> all = values;
  return boxes_of<D>(count, [&](std::size_t, int) { return Span{rng.one_of(all), rng.one_of(all)}; });
}

template <int D>
std::vector<Box<D>> uniform(std::size_t count, float world, float size, std::uint64_t seed = 1) {
  Rng rng(seed);
  return boxes_of<D>(count, [&](std::size_t, int) {
    const float min = rng.between(0, world);
    return Span{min, min + rng.between(0, size)};
  });
}

template <int D>
void add_few(std::vector<Input<D>>& inputs) {
  const Box<D> unit = box_of<D>([](int) { return Span{0, 1}; });
  const Box<D> corner = box_of<D>([](int) { return Span{1, 2}; });
  const Box<D> beyond = box_of<D>([](int) { return Span{std::nextafter(1.0f, 2.0f), 2}; });
  const Box<D> point = box_of<D>([](int) { return Span{1, 1}; });
  inputs.push_back({"none", {}});
  inputs.push_back({"one", {unit}});
  inputs.push_back({"two that touch at a corner", {unit, corner}});
  inputs.push_back({"two an ulp apart", {unit, beyond}});
  inputs.push_back({"two equal", {unit, unit}});
  inputs.push_back({"a point on a corner", {point, unit}});
  inputs.push_back({"two equal points", {point, point}});
  inputs.push_back({"one absent", {absent_box<D>()}});
  inputs.push_back({"all absent", std::vector<Box<D>>(20, absent_box<D>())});
  for (const std::size_t count : {2, 3, 17, 200, 1000})
    inputs.push_back({"uniform " + std::to_string(count), uniform<D>(count, 10, D == 2 ? 1 : 2)});
}

template <int D>
void add_ties(std::vector<Input<D>>& inputs, std::size_t crowd) {
  const auto lattice_point = [](std::size_t i, int axis) {
    constexpr std::size_t side = D == 2 ? 18 : 7;
    for (int a = 0; a < axis; ++a) i /= side;
    return static_cast<float>(i % side);
  };
  inputs.push_back({"touching lattice", boxes_of<D>(D == 2 ? 324 : 343, [&](std::size_t i, int axis) {
                      return Span{lattice_point(i, axis), lattice_point(i, axis) + 1};
                    })});
  inputs.push_back(
      {"points on a lattice, twice", boxes_of<D>(2 * (D == 2 ? 324 : 343), [&](std::size_t i, int axis) {
         return Span{lattice_point(i / 2, axis), lattice_point(i / 2, axis)};
       })});
  inputs.push_back({"small whole numbers", drawn_from<D>({0, 1, 2, 3, 4, 5, 6, 7, 8}, 200)});
  inputs.push_back({"powers of two", drawn_from<D>({-4, -2, -1, -.5f, -.25f, 0, .25f, .5f, 1, 2, 4}, 200)});
  inputs.push_back({"coincident boxes", boxes_of<D>(crowd, [](std::size_t, int) { return Span{3, 4}; })});
  inputs.push_back({"coincident points", boxes_of<D>(reduced(500), [](std::size_t, int) {
                      return Span{3, 3};
                    })});
  inputs.push_back({"coincident at the origin", boxes_of<D>(100, [](std::size_t, int) {
                      return Span{0, 0};
                    })});
  inputs.push_back({"both zeros", drawn_from<D>({-1, -0.0f, 0.0f, 1}, 200)});
  inputs.push_back({"nothing but zeros", drawn_from<D>({-0.0f, 0.0f}, 30)});
  inputs.push_back({"a stair of touching boxes", boxes_of<D>(300, [](std::size_t i, int) {
                      return Span{static_cast<float>(i), static_cast<float>(i + 1)};
                    })});
  inputs.push_back({"the same stair downwards", boxes_of<D>(300, [](std::size_t i, int) {
                      return Span{static_cast<float>(300 - i), static_cast<float>(301 - i)};
                    })});
  inputs.push_back({"nested boxes", boxes_of<D>(100, [](std::size_t i, int) {
                      return Span{-static_cast<float>(i), static_cast<float>(i)};
                    })});
}

template <int D>
void add_flat(std::vector<Input<D>>& inputs) {
  for (int flat = 0; flat < D; ++flat) {
    const std::string axis = std::to_string(flat);
    std::vector<Box<D>> plane = uniform<D>(200, 10, 2);
    std::vector<Box<D>> degenerate = plane;
    std::vector<Box<D>> same_projection = plane;
    std::vector<Box<D>> line = uniform<D>(200, 0, 1);
    for (std::size_t i = 0; i < plane.size(); ++i) {
      plane[i].min[flat] = plane[i].max[flat] = 5;
      degenerate[i].min[flat] = degenerate[i].max[flat] = std::floor(degenerate[i].min[flat]);
      same_projection[i].min[flat] = -1;
      same_projection[i].max[flat] = 1;
      line[i].min[flat] += static_cast<float>(i) / 4;
      line[i].max[flat] += static_cast<float>(i) / 4;
    }
    inputs.push_back({"all in one plane across axis " + axis, plane});
    inputs.push_back({"degenerate on axis " + axis, degenerate});
    inputs.push_back({"equal projections on axis " + axis, same_projection});
    inputs.push_back({"along axis " + axis, line});
  }
  Rng rng(3);
  inputs.push_back({"needles", boxes_of<D>(200, [&](std::size_t i, int axis) {
                      const float min = rng.between(0, 100);
                      return Span{min, min + (i % D == std::size_t(axis) ? 80.0f : 0.01f)};
                    })});
  inputs.push_back({"plates", boxes_of<D>(100, [&](std::size_t i, int axis) {
                      const float min = rng.between(0, 100);
                      return i % D == std::size_t(axis) ? Span{min, min} : Span{-1, 101};
                    })});
  inputs.push_back({"points", uniform<D>(200, 10, 0)});
}

template <int D>
void add_scales(std::vector<Input<D>>& inputs) {
  Rng rng(5);
  std::vector<Box<D>> one_huge = uniform<D>(100, 100, 1);
  one_huge[50] = box_of<D>([](int) { return Span{-1e6f, 1e6f}; });
  inputs.push_back({"one huge among a hundred", one_huge});
  std::vector<Box<D>> outliers = uniform<D>(100, 10, 1);
  for (int axis = 0; axis < D; ++axis) {
    for (const float where : {-1e30f, 1e30f}) {
      Box<D> outlier = box_of<D>([](int) { return Span{0, 1}; });
      outlier.min[axis] = outlier.max[axis] = where;
      outliers.insert(outliers.begin() + axis, 2, outlier);
    }
  }
  inputs.push_back({"outliers at 1e30", outliers});
  inputs.push_back({"sizes by a power law", boxes_of<D>(300, [&](std::size_t, int) {
                      const float min = rng.between(0, 100);
                      return Span{min, min + 0.01f / (0.0001f + rng.unit() * rng.unit())};
                    })});
  inputs.push_back({"tiny boxes in a vast world", uniform<D>(200, 1e12f, 1e-6f)});
  std::vector<Box<D>> clusters = uniform<D>(200, 3, 1);
  for (std::size_t i = 0; i < clusters.size(); i += 2) {
    for (int axis = 0; axis < D; ++axis) {
      clusters[i].min[axis] += 1e7f;  // where the spacing of floats is 1
      clusters[i].max[axis] += 1e7f;
    }
  }
  inputs.push_back({"two clusters far apart", clusters});
  inputs.push_back({"denormals", drawn_from<D>({-3 * smallest_float, -smallest_float, -0.0f, 0,
                                                smallest_float, 2 * smallest_float, 3 * smallest_float},
                                               150)});
  inputs.push_back(
      {"denormals beside ones", drawn_from<D>({-1, -smallest_float, 0, smallest_float, 1}, 150)});
  inputs.push_back({"all magnitudes", boxes_of<D>(300, [&](std::size_t, int) {
                      const auto value = [&] { return std::ldexp(rng.between(-1, 1), rng.whole(-126, 127)); };
                      return Span{value(), value()};
                    })});
}

template <int D>
void add_extremes(std::vector<Input<D>>& inputs) {
  inputs.push_back({"the largest floats", drawn_from<D>({-largest_float, largest_float}, 60)});
  inputs.push_back(
      {"the largest floats among ones", drawn_from<D>({-largest_float, -1, 0, 1, largest_float}, 150)});
  std::vector<Box<D>> ends = uniform<D>(60, 10, 1);
  for (std::size_t i = 0; i < 20; ++i) {
    const float where = i % 2 == 0 ? largest_float : -largest_float;
    ends.push_back(box_of<D>([&](int) { return Span{where, where}; }));
    ends.push_back(box_of<D>([&](int axis) { return axis == 0 ? Span{where, where} : Span{0, 5}; }));
  }
  inputs.push_back({"points at both ends of the floats", ends});

  inputs.push_back({"all infinite", boxes_of<D>(50, [](std::size_t, int) {
                      return Span{-float_infinity, float_infinity};
                    })});
  inputs.push_back({"infinities", drawn_from<D>({-float_infinity, float_infinity}, 60)});
  inputs.push_back(
      {"every special value", drawn_from<D>({-float_infinity, -largest_float, -1, -smallest_float, -0.0f, 0,
                                             smallest_float, 1, largest_float, float_infinity},
                                            300)});
  Rng rng(9);
  std::vector<Box<D>> half_spaces = uniform<D>(200, 10, 1);
  for (std::size_t i = 0; i < half_spaces.size(); i += 10) {
    const int axis = static_cast<int>(i / 10) % D;
    (i % 20 == 0 ? half_spaces[i].min : half_spaces[i].max)[axis] =
        i % 20 == 0 ? -float_infinity : float_infinity;
  }
  inputs.push_back({"half-infinite among small", half_spaces});
  std::vector<Box<D>> with_absent = half_spaces;
  with_absent[7] = box_of<D>([](int) { return Span{-float_infinity, float_infinity}; });
  for (Box<D>& box : with_absent) {
    if (rng.one_in(2)) box = absent_box<D>();
  }
  inputs.push_back({"infinite and absent", with_absent});
  std::vector<Box<D>> half_absent = uniform<D>(400, 10, 1);
  for (std::size_t i = 0; i < half_absent.size(); i += 2) half_absent[i] = absent_box<D>();
  inputs.push_back({"every other one absent", half_absent});
}

}  // namespace

template <int D, typename Real>
bool is_beyond(const Algorithm& algorithm, const Box<D, Real>& box) {
  if (is_absent(box)) return false;
  const auto beyond = [&](Real value) {
    return std::isinf(value) ? !algorithm.limits.infinite_boxes
                             : std::abs(value) > algorithm.limits.max_coordinate;
  };
  return std::ranges::any_of(box.min, beyond) || std::ranges::any_of(box.max, beyond);
}

bool takes_any_floats(const Algorithm& algorithm) {
  return algorithm.limits.infinite_boxes && algorithm.limits.max_coordinate >= largest_float;
}

template <int D>
std::vector<Input<D>> hard_inputs(const Algorithm& algorithm, std::size_t crowd) {
  std::vector<Input<D>> inputs;
  add_few(inputs);
  add_ties(inputs, crowd);
  add_flat(inputs);
  add_scales(inputs);
  add_extremes(inputs);
  for (Input<D>& input : inputs)
    std::erase_if(input.boxes, [&](const Box<D>& box) { return is_beyond(algorithm, box); });
  return inputs;
}

template bool is_beyond(const Algorithm&, const Box<2>&);
template bool is_beyond(const Algorithm&, const Box<3>&);
template bool is_beyond(const Algorithm&, const Box<2, double>&);
template bool is_beyond(const Algorithm&, const Box<3, double>&);
template std::vector<Input<2>> hard_inputs(const Algorithm&, std::size_t);
template std::vector<Input<3>> hard_inputs(const Algorithm&, std::size_t);

}  // namespace broadside::laws
