// Outline: what an algorithm lays over boxes (cells, stripes, nodes), to be drawn.
#pragma once

#include <span>
#include <string>
#include <type_traits>

#include "broadside/box.hpp"
#include "broadside/export.hpp"
#include "broadside/finder.hpp"
#include "broadside/tracker.hpp"

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

/// A second face of a finder that lays something over boxes: its class derives from this one as well, and its
/// outlined() returns itself.
template <int D, typename Real>
class BROADSIDE_PUBLIC Outlined {
 public:
  Outlined() = default;
  Outlined(const Outlined&) = delete;
  Outlined& operator=(const Outlined&) = delete;
  virtual ~Outlined() = default;

  /// What a find() of these boxes would lay over them; not to be called but by outline(). The boxes are all
  /// present, and there is one at least. Parts may be infinite.
  virtual Outline<D, Real> lay_out(std::span<const Box<D, Real>> boxes) = 0;
};

/// What the finder's find() would lay over these boxes; nothing for a finder without an outlined(), or if no
/// box is present. Takes what laying it out takes, and no search pays for it. Throws as find() does.
template <int D, typename Real>
BROADSIDE_PUBLIC Outline<D, Real> outline(PairFinder<D, Real>& finder,
                                          std::type_identity_t<std::span<const Box<D, Real>>> boxes);

}  // namespace broadside
