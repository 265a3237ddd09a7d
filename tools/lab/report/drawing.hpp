// Draws a scene's boxes and the structures of algorithms as paths in the units of a view: for pages and
// pictures.
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

/// The structure of one algorithm, drawn over the boxes.
struct DrawingLayer {
  std::string algorithm;  ///< its spec
  std::string caption;    ///< such as "24 x 18 cells of 3.1"
  std::vector<std::string>
      levels;          ///< lines, from the top level down; each level without the lines of those above
  std::string active;  ///< of a sweep, half way: its line and the boxes that it crosses; otherwise empty
};

/// The boxes projected along one axis, or in 2D as they are. Paths are in SVG syntax, in units of the view,
/// which is `width` wide; larger coordinates of the world are higher up.
struct DrawingView {
  std::string axes;  ///< "xy", "xz" or "yz": the horizontal axis first
  int width = 1000;
  int height = 1000;
  std::string alone;     ///< the boxes that overlap no other box
  std::string touching;  ///< the boxes that overlap another box
  std::vector<DrawingLayer> layers;
};

/// A drawing of a scene.
struct Drawing {
  std::string scene;
  int dimension = 2;
  std::size_t boxes = 0;    ///< the number of boxes drawn
  std::size_t of = 0;       ///< the number of boxes in the scene
  std::size_t largest = 0;  ///< how many of the boxes drawn are the scene's largest, see Thinned
  std::vector<DrawingView> views;
};

/// The number of boxes that an eye can distinguish in a picture.
inline constexpr std::size_t max_drawn = 600;

template <int D>
struct Thinned {
  std::vector<Box<D>> boxes;
  std::size_t largest = 0;  ///< how many are far larger than most and were left as they are
};

/// `max_boxes` of the boxes, so that the picture looks like the scene: those far larger than most (up to a
/// quarter of `max_boxes`, the largest, if there are such) as they are, and others evenly chosen from the
/// array, each enlarged about its centre to keep the density of all. All of them if there are no more than
/// that.
template <int D>
Thinned<D> thinned(std::span<const Box<D>> boxes, std::size_t max_boxes = max_drawn);

/// Draws these boxes and, over them, a layer for each entry with an outline in D dimensions. A view contains
/// all boxes except far outliers, and clips whatever reaches beyond it. Ignores absent boxes. `of` is the
/// value for Drawing::of.
template <int D>
Drawing draw(const std::string& scene, std::span<const Box<D>> boxes, std::size_t of,
             std::span<const Entry> entries);

/// Whether the entry has an outline to draw in this dimension.
bool has_outline(const Entry& entry, int dimension);

/// Draws a frame of a scene, counted from 0, in a dimension that the scene has: with `max_boxes` boxes, which
/// have the density of more, or thinned() to that if the scene has its own number. `of` is the number of
/// boxes to state for the scene; a scene with its own number states that instead. Leaves out entries that do
/// not support the dimension. Throws InvalidSpec if there are fewer frames; boxes without their own motion
/// have one frame.
Drawing draw_scene(const NamedScene& scene, int dimension, std::size_t of, std::span<const Entry> entries,
                   std::size_t max_boxes = max_drawn, std::uint64_t seed = 1, std::size_t frame = 0);

/// {"scene", "dimension", "boxes", "of", "views": [{"axes", "width", "height", "boxes", "layers":
/// [{"algorithm", "caption", "levels": [...]}]}]}: all boxes in one path, a sweep's line as its own level.
nlohmann::json json_of(const Drawing& drawing);

/// An SVG with a panel for each view and layer, in rows; only the boxes if there are no layers. Each panel
/// has a title and a caption, and the SVG has a title and a description for screen readers. Light colours, on
/// its own background, so that it can be read on dark pages too.
std::string svg_of(const Drawing& drawing);

}  // namespace broadside::lab
