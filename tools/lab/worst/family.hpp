// Families of inputs for the worst-case hunt, and the list of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "broadside/algorithm.hpp"
#include "broadside/box.hpp"

#include "lab/scenes/random.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::lab {

template <int D>
using DoubleBoxes = std::vector<Box<D, double>>;

template <int D>
using MakeDoubleBoxes = std::function<DoubleBoxes<D>(const Settings&, std::size_t boxes, Random&)>;

/// A tunable, and how the hunt draws a value for it.
struct DrawnTunable {
  Tunable tunable;
  bool logarithmic = false;  ///< all orders of magnitude are equally likely
};

/// A family of inputs. Its boxes are about the unit cube; make_input() applies scale and order.
struct InputFamily {
  std::string name;
  std::string summary;  ///< one line
  std::vector<DrawnTunable> tunables;
  MakeDoubleBoxes<2> boxes_2d;
  MakeDoubleBoxes<3> boxes_3d;
  bool fixed_order = false;  ///< the order of the boxes matters
  bool two_sets = false;     ///< few pairs between the two halves, about n^2 within each: for find_across()
                             ///< only
};

/// All families, in a fixed order. Thread-safe.
std::span<const InputFamily> input_families();

/// The family of this name. Throws InvalidSpec, which lists the families.
const InputFamily& find_family(std::string_view name);

/// Draws values for the family's own tunables.
Spec draw_family(const InputFamily& family, Random& random);

/// The family's boxes with the values in `spec`. Throws InvalidSpec if a value is invalid.
template <int D>
DoubleBoxes<D> make_family(const Spec& spec, std::size_t boxes, Random& random);

}  // namespace broadside::lab

namespace broadside::lab::worst {

InputFamily even();
InputFamily plates();
InputFamily shelves();
InputFamily lines();
InputFamily row();
InputFamily dolls();
InputFamily clusters();
InputFamily dust();
InputFamily magnitudes();
InputFamily heaps();
InputFamily giants();
InputFamily crowds();
InputFamily fooled();
InputFamily mixture();

}  // namespace broadside::lab::worst
