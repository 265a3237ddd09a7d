// A drawing as a picture of its own: SVG.
#pragma once

#include <string>

#include "lab/report/drawing.hpp"

namespace broadside::lab {

/// One SVG: a panel for each view and layer, side by side and in rows; only the boxes where there is no
/// layer. A title and a caption over each panel, a title and a description for screen readers. Light, on a
/// background of its own, so that it can be read on dark pages too.
std::string svg_of(const Drawing& drawing);

}  // namespace broadside::lab
