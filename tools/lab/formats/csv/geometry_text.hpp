// The box of a geometry in one field: well-known text (OGC 06-103r4), or the bounds themselves.
#pragma once

#include <string>
#include <string_view>

#include "broadside/box.hpp"

#include "lab/formats/columns.hpp"

namespace broadside::lab::readers {

/// The bounds of a text's points; absent for a text without points.
struct TextGeometry {
  int dimension = 2;
  DoubleBox3 box = absent_box<3, double>();  ///< for a 2D geometry, without z
  std::string found{};  ///< the fault, which continues "column wkt is '...'"; empty if there is none
  std::string expected{};
};

/// Well-known text counts as 2D, whatever dimension its points have. Bounds are minima, then maxima,
/// separated by commas or blanks, with or without brackets; or PostGIS's "BOX(0 0,1 1)" and "BOX3D(0 0 0,1 1
/// 1)". `form` gives the meaning of the numbers if they are not minima and maxima.
TextGeometry read_geometry_text(std::string_view text, BoundsForm form = BoundsForm::min_max);

}  // namespace broadside::lab::readers
