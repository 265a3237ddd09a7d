// The box of a geometry in one field: well-known text (OGC 06-103r4), or the bounds themselves.
#pragma once

#include <string>
#include <string_view>

#include "broadside/box.hpp"

#include "lab/formats/columns.hpp"

namespace broadside::lab::readers {

/// The fault of a text; `found` is empty if there is none.
struct GeometryFault {
  std::string found{};  ///< continues "column wkt is '...'"
  std::string expected{};
};

/// The bounds of a text's points, each coordinate rounded once; absent if it has none. Well-known text is in
/// 2D, whatever else its points have. Bounds are minima and then maxima, with commas or blanks between, with
/// or without brackets; or PostGIS's "BOX(0 0,1 1)" and "BOX3D(0 0 0,1 1 1)".
/// `form` gives the meaning of the numbers if they are not minima and maxima. Bounds are then computed in
/// double.
template <int D, typename Real>
GeometryFault read_geometry_text(std::string_view text, Box<D, Real>& box,
                                 BoundsForm form = BoundsForm::min_max);

/// The dimension of the box of a text that is right.
int dimension_of_geometry_text(std::string_view text);

}  // namespace broadside::lab::readers
