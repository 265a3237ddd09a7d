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
  std::string kind;     ///< "cells", "stripes", "nodes" or "sweep"; empty where there is nothing to draw
  std::string caption;  ///< such as "24 x 18 cells of 3.1"
  int swept_axis = -1;  ///< the axis along which boxes are sorted; -1: none

  /// The parts, from the uppermost or coarsest ones down. Finite: a part that goes on without end does so as
  /// far as the boxes' finite coordinates. Those of one level of cells, stripes or nodes of a quadtree share
  /// borders at most; those of a tree of bounds may overlap.
  detail::Vector<detail::Vector<Box<D, Real>>> levels;
};

/// What a find() by the algorithm of `spec` would lay over these boxes; nothing for an algorithm without
/// outlines, or if no box is present. Takes what laying it out takes. Throws as Finder::find() does, and
/// InvalidSpec. Boxes of doubles are laid out as floats.
template <int D, typename Real>
BROADSIDE_PUBLIC Outline<D, Real> outline(const Spec& spec, std::span<const Box<D, Real>> boxes,
                                          const Workers& workers = default_workers);
template <int D, typename Real>
BROADSIDE_PUBLIC Outline<D, Real> outline(const Algorithm& algorithm, const Spec& spec,
                                          std::span<const Box<D, Real>> boxes,
                                          const Workers& workers = default_workers);

}  // namespace broadside
