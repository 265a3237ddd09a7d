// Draws a scene's boxes and the structures of algorithms as paths.
#include "lab/report/drawing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "broadside/algorithm.hpp"
#include "broadside/debug/outline.hpp"
#include "broadside/error.hpp"
#include "broadside/find_pairs.hpp"
#include "broadside/sinks.hpp"

#include "lab/numbers.hpp"
#include "lab/report/drawing_paths.hpp"

namespace broadside::lab {
namespace {

/// The axes of the world that a view shows.
using Axes = std::array<int, 2>;

template <int D>
std::vector<Axes> views_of() {
  if (D == 2) return {{0, 1}};
  return {{0, 1}, {0, 2}, {1, 2}};
}

template <int D>
Rectangle seen(const Box<D>& box, const Axes& axes) {
  return {{box.min[axes[0]], box.min[axes[1]]}, {box.max[axes[0]], box.max[axes[1]]}};
}

template <int D>
std::vector<Rectangle> seen(std::span<const Box<D>> boxes, const Axes& axes) {
  std::vector<Rectangle> rectangles;
  for (const Box<D>& box : boxes) rectangles.push_back(seen(box, axes));
  return rectangles;
}

/// A sweep at its middle box: the position of its line, the part that it sweeps, and the boxes that it
/// crosses.
template <int D>
struct Sweep {
  int axis;
  float at;
  Box<D> part;
  std::vector<Box<D>> active;
};

template <int D>
std::optional<Sweep<D>> sweep_of(const Outline<D>& outline, std::span<const Box<D>> boxes) {
  if (outline.kind != "sweep" && outline.kind != "stripes") return std::nullopt;
  const int axis = outline.swept_axis;
  Sweep<D> sweep{axis, 0, outline.levels[0][outline.levels[0].size() / 2], {}};
  std::vector<float> begins;
  for (const Box<D>& box : boxes) {
    if (overlap(box, sweep.part) && std::isfinite(box.min[axis])) begins.push_back(box.min[axis]);
  }
  if (begins.empty()) return std::nullopt;
  std::ranges::sort(begins);
  sweep.at = begins[begins.size() / 2];
  sweep.part.min[axis] = sweep.part.max[axis] = sweep.at;
  for (const Box<D>& box : boxes) {
    if (overlap(box, sweep.part)) sweep.active.push_back(box);
  }
  return sweep;
}

/// The sweep's line and the boxes that it crosses, if its axis is one of the view's.
template <int D>
std::string path_of(const Sweep<D>& sweep, const Axes& axes, const Window& window) {
  std::string path;
  if (sweep.axis != axes[0] && sweep.axis != axes[1]) return path;
  const int along = sweep.axis == axes[0] ? 1 : 0;
  append_line(path, along, sweep.at, sweep.part.min[axes[along]], sweep.part.max[axes[along]], window);
  for (const Box<D>& box : sweep.active) append_rectangle(path, seen(box, axes), window);
  return path;
}

/// For each box, whether it overlaps another one.
template <int D>
std::vector<bool> touching(std::span<const Box<D>> boxes) {
  std::vector<Pair> pairs;
  PairCollector collector(pairs);
  find_pairs(boxes, collector);
  std::vector<bool> touches(boxes.size());
  for (const Pair pair : pairs) touches[index(pair.first)] = touches[index(pair.second)] = true;
  return touches;
}

/// The boxes that are far larger than most, such as a level's floor; at most `max_count`, the largest, the
/// first of those that are equal.
template <int D>
std::vector<bool> far_larger(std::span<const Box<D>> boxes, std::size_t max_count) {
  constexpr double far = 8;  // times the median of the longest sides
  std::vector<double> sides;
  for (const Box<D>& box : boxes) {
    double longest = 0;
    for (int axis = 0; axis < D; ++axis) longest = std::max(longest, double{box.max[axis]} - box.min[axis]);
    sides.push_back(longest);
  }
  std::vector<std::size_t> by_side(boxes.size());
  std::iota(by_side.begin(), by_side.end(), 0);
  std::ranges::stable_sort(by_side, std::greater(), [&sides](std::size_t i) { return sides[i]; });
  const double least = far * sides[by_side[by_side.size() / 2]];
  std::vector<bool> larger(boxes.size());
  for (std::size_t rank = 0; rank < max_count && sides[by_side[rank]] > least; ++rank)
    larger[by_side[rank]] = true;
  return larger;
}

/// A scene's boxes in a frame, which must exist.
template <int D>
std::vector<Box<D>> boxes_at(std::size_t frame, const NamedScene& named, SceneRequest request) {
  const bool moves = D == 2 ? bool(named.scene.history_2d) : bool(named.scene.history_3d);
  // Boxes at rest could be set moving, but the frames would not be the scene's own.
  request.frames = moves ? frame : 0;
  History<D> history = make_history<D>(named.scene, named.spec, request);
  const std::size_t last = history.steps.size();
  if (frame > last)
    throw InvalidSpec(fmt::format("{}: --frame is {}; expected 0{}, as the scene has {}", named.spec.text(),
                                  frame, last == 0 ? "" : fmt::format(" to {}", last),
                                  counted(last + 1, "frame", "frames")));
  for (const Step<D>& step : history.steps) apply(step, history.boxes);
  return std::move(history.boxes);
}

}  // namespace

template <int D>
Thinned<D> thinned(std::span<const Box<D>> boxes, std::size_t max_boxes) {
  std::vector<Box<D>> present;
  std::ranges::copy_if(boxes, std::back_inserter(present), is_present<D, float>);
  if (present.size() <= max_boxes) return {std::move(present)};
  const std::vector<bool> is_far_larger = far_larger<D>(present, max_boxes / 4);
  const auto kept = static_cast<std::size_t>(std::ranges::count(is_far_larger, true));
  const std::size_t others = present.size() - kept;
  const std::size_t room = max_boxes - kept;
  const double ratio = static_cast<double>(others) / static_cast<double>(room);
  const double factor = D == 2 ? std::sqrt(ratio) : std::cbrt(ratio);
  std::vector<Box<D>> chosen;
  std::size_t other = 0;
  std::size_t next = 0;
  for (std::size_t i = 0; i < present.size(); ++i) {
    Box<D> box = present[i];
    if (is_far_larger[i]) {
      chosen.push_back(box);
      continue;
    }
    if (other++ != (2 * next + 1) * others / (2 * room)) continue;
    ++next;
    for (int axis = 0; axis < D; ++axis) {
      const double more = (double{box.max[axis]} - box.min[axis]) * (factor - 1) / 2;
      if (!std::isfinite(more)) continue;
      box.min[axis] = static_cast<float>(box.min[axis] - more);
      box.max[axis] = static_cast<float>(box.max[axis] + more);
    }
    chosen.push_back(box);
  }
  return {std::move(chosen), kept};
}

template <int D>
Drawing draw(const std::string& scene, std::span<const Box<D>> boxes, std::size_t of,
             std::span<const Entry> entries) {
  std::vector<Box<D>> present;
  std::ranges::copy_if(boxes, std::back_inserter(present), is_present<D, float>);
  const std::span<const Box<D>> drawn = present;
  Drawing drawing{scene, D, drawn.size(), of, 0, {}};
  std::vector<std::pair<const Entry*, Outline<D>>> outlines;
  for (const Entry& entry : entries) {
    outlines.emplace_back(&entry, outline(*entry.algorithm, entry.spec, drawn));
  }
  const std::vector<bool> touches = touching(drawn);
  for (const Axes& axes : views_of<D>()) {
    const std::vector<Rectangle> rectangles = seen(drawn, axes);
    const Window window = window_on(rectangles);
    DrawingView& view = drawing.views.emplace_back();
    view.axes = {"xyz"[axes[0]], "xyz"[axes[1]]};
    view.width = window.width;
    view.height = window.height;
    for (std::size_t i = 0; i < rectangles.size(); ++i)
      append_rectangle(touches[i] ? view.touching : view.alone, rectangles[i], window);
    for (const auto& [entry, outline] : outlines) {
      DrawingLayer& layer = view.layers.emplace_back();
      layer.algorithm = entry->spec.text();
      layer.caption = outline.caption;
      Edges edges(window);
      for (const auto& level : outline.levels) layer.levels.push_back(edges.next_level(seen<D>(level, axes)));
      if (const std::optional<Sweep<D>> sweep = sweep_of<D>(outline, drawn))
        layer.active = path_of(*sweep, axes, window);
    }
  }
  return drawing;
}

bool has_outline(const Entry& entry, int dimension) {
  return dimension == 2 ? bool(entry.algorithm->in_2d.outline) : bool(entry.algorithm->in_3d.outline);
}

Drawing draw_scene(const NamedScene& named, int dimension, std::size_t of, std::span<const Entry> entries,
                   std::size_t max_boxes, std::uint64_t seed, std::size_t frame) {
  std::vector<Entry> able;
  for (const Entry& entry : entries) {
    if (entry.algorithm->has_dimension(dimension)) able.push_back(entry);
  }
  const auto in_dimension = [&]<int D>() {
    SceneRequest request;
    request.boxes = max_boxes;
    request.seed = seed;
    const std::vector<Box<D>> all = boxes_at<D>(frame, named, request);
    const Thinned<D> thin = thinned<D>(all, max_boxes);
    const auto present = static_cast<std::size_t>(std::ranges::count_if(all, is_present<D, float>));
    const bool is_own = named.scene.fixed_count || thin.boxes.size() < present;
    const std::string title = named.spec.text() + (frame > 0 ? fmt::format(", frame {}", frame) : "");
    Drawing drawing = draw<D>(title, thin.boxes, is_own ? present : std::max(of, present), able);
    drawing.largest = thin.largest;
    return drawing;
  };
  return dimension == 2 ? in_dimension.operator()<2>() : in_dimension.operator()<3>();
}

nlohmann::json json_of(const Drawing& drawing) {
  nlohmann::json views = nlohmann::json::array();
  for (const DrawingView& view : drawing.views) {
    nlohmann::json layers = nlohmann::json::array();
    for (const DrawingLayer& layer : view.layers) {
      std::vector<std::string> levels = layer.levels;
      if (!layer.active.empty()) levels.push_back(layer.active);
      layers.push_back({{"algorithm", layer.algorithm}, {"caption", layer.caption}, {"levels", levels}});
    }
    views.push_back({{"axes", view.axes},
                     {"width", view.width},
                     {"height", view.height},
                     {"boxes", view.alone + view.touching},
                     {"layers", layers}});
  }
  return {{"scene", drawing.scene},
          {"dimension", drawing.dimension},
          {"boxes", drawing.boxes},
          {"of", drawing.of},
          {"views", views}};
}

template Thinned<2> thinned(std::span<const Box<2>>, std::size_t);
template Thinned<3> thinned(std::span<const Box<3>>, std::size_t);
template Drawing draw(const std::string&, std::span<const Box<2>>, std::size_t, std::span<const Entry>);
template Drawing draw(const std::string&, std::span<const Box<3>>, std::size_t, std::span<const Entry>);

}  // namespace broadside::lab
