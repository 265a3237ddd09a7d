// A scene's boxes and what algorithms lay over them, as paths in the units of a view: for pages and pictures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "broadside/box.hpp"

#include "lab/catalogue.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::lab {

/// What one algorithm lays over the boxes.
struct DrawingLayer {
  std::string algorithm;  ///< its spec
  std::string caption;    ///< such as "24 x 18 cells of 3.1"
  std::vector<std::string>
      levels;          ///< lines, from the uppermost level down; what a level above has is left out
  std::string active;  ///< of a sweep, half way: its line; and the boxes that it crosses. Empty for others
};

/// The boxes as seen along one axis, or in 2D as they are. Paths are SVG's, in units of the view, which
/// is `width` wide; what is greater in the world is higher up.
struct DrawingView {
  std::string axes;  ///< "xy", "xz" or "yz": first what goes to the right
  int width = 1000;
  int height = 1000;
  std::string alone;     ///< the boxes that overlap no other one
  std::string touching;  ///< boxes that do
  std::vector<DrawingLayer> layers;
};

/// A scene, drawn.
struct Drawing {
  std::string scene;
  int dimension = 2;
  std::size_t boxes = 0;  ///< as many as are drawn
  std::size_t of = 0;     ///< as many as the scene has
  std::vector<DrawingView> views;
};

/// The number of boxes that an eye can tell apart in a picture.
inline constexpr std::size_t max_drawn = 600;

/// `most` of the boxes, evenly from the whole array, each made larger about its centre so that they are as
/// dense as all of them: such a picture looks like the scene. All of them if there are no more than that.
template <int D>
std::vector<Box<D>> thinned(std::span<const Box<D>> boxes, std::size_t max_boxes = max_drawn);

/// Draws these boxes and over them the layer of each entry with an outline in D dimensions. A view holds all
/// boxes but for far outliers; what reaches beyond it is clipped. Absent boxes are not there. `of` is what
/// Drawing::of is to be.
template <int D>
Drawing draw(const std::string& scene, std::span<const Box<D>> boxes, std::size_t of,
             std::span<const Entry> entries);

/// Whether the entry lays anything over boxes in this dimension.
bool has_outline(const Entry& entry, int dimension);

/// Draws a frame of a scene, counted from 0, in a dimension that it has: made with `most` boxes, which have
/// the density of more, or, where their number is the scene's own, thinned() to that. `of` is how many boxes
/// the scene is said to have; for a number of its own, that is told instead. Entries that do not do the
/// dimension are left out. Throws InvalidSpec if there are fewer frames; boxes that do not move by
/// themselves have one.
Drawing draw_scene(const NamedScene& scene, int dimension, std::size_t of, std::span<const Entry> entries,
                   std::size_t max_boxes = max_drawn, std::uint64_t seed = 1, std::size_t frame = 0);

/// {"scene", "dimension", "boxes", "of", "views": [{"axes", "width", "height", "boxes", "layers":
/// [{"algorithm", "caption", "levels": [...]}]}]}: all boxes in one path, a sweep's line a level of its own.
nlohmann::json json_of(const Drawing& drawing);

/// One SVG: a panel for each view and layer, side by side and in rows; only the boxes where there is no
/// layer. A title and a caption over each panel, a title and a description for screen readers. Light, on a
/// background of its own, so that it can be read on dark pages too.
std::string svg_of(const Drawing& drawing);

}  // namespace broadside::lab
