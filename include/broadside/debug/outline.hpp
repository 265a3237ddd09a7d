// Outline: what an algorithm lays over boxes (cells, stripes, nodes), to be drawn.
#pragma once

#include <span>
#include <string>

#include "broadside/algorithm.hpp"
#include "broadside/box.hpp"
#include "broadside/executor.hpp"
#include "broadside/export.hpp"

namespace broadside {

/// What an algorithm lays over boxes.
template <int D, typename Real = float>
struct Outline {
  std::string kind;     ///< "cells", "stripes", "nodes" or "sweep"; empty if there is nothing to draw
  std::string caption;  ///< such as "24 x 18 cells of 3.1"
  int swept_axis = -1;  ///< the axis along which boxes are sorted; -1 for none

  /// The parts by level, the coarsest level first. All are finite: an unbounded part ends at the outermost
  /// finite coordinate of the boxes. On one level, cells, stripes and nodes of a quadtree share only borders;
  /// nodes of a tree of bounds may overlap.
  detail::Vector<detail::Vector<Box<D, Real>>> levels;
};

/// What Finder::find() with this algorithm would lay over the boxes. Empty for an algorithm without outlines,
/// or if no box is present. Cost: that of building the structure. Throws as Finder::find() does, and
/// InvalidSpec. Boxes of doubles are laid out as floats.
template <int D, typename Real>
[[nodiscard]] BROADSIDE_PUBLIC Outline<D, Real> outline(const Spec& spec, std::span<const Box<D, Real>> boxes,
                                                        const Workers& workers = default_workers);
template <int D, typename Real>
[[nodiscard]] BROADSIDE_PUBLIC Outline<D, Real> outline(const Algorithm& algorithm, const Spec& spec,
                                                        std::span<const Box<D, Real>> boxes,
                                                        const Workers& workers = default_workers);

}  // namespace broadside
