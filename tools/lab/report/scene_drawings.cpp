// Draws the scenes of a report.
#include "lab/report/scene_drawings.hpp"

#include <algorithm>
#include <exception>
#include <iterator>

#include <nlohmann/json.hpp>

#include "lab/report/drawing.hpp"
#include "lab/report/machine.hpp"

namespace broadside::lab {
namespace {

constexpr std::size_t max_json_bytes = 1'200'000;

/// A scene in 3D has three views.
std::size_t boxes_drawn(int dimension) { return dimension == 2 ? max_drawn : max_drawn / 2; }

bool is_empty(const DrawingLayer& layer) {
  return layer.active.empty() && std::ranges::all_of(layer.levels, &std::string::empty);
}

}  // namespace

std::vector<SceneToDraw> scenes_of(const Comparison& comparison) {
  std::vector<SceneToDraw> scenes;
  for (const CaseResult& result : comparison.cases) {
    const Case& of = result.of;
    const auto known = std::ranges::find_if(scenes, [&of](const SceneToDraw& scene) {
      return scene.scene == of.scene && scene.dimension == of.dimension;
    });
    if (known == scenes.end())
      scenes.push_back({of.scene, of.dimension, of.boxes});
    else
      known->boxes = std::max(known->boxes, of.boxes);
  }
  return scenes;
}

std::string drawings_of(std::span<const SceneToDraw> scenes, const FindScene& find,
                        std::span<const Entry> entries) {
  std::vector<Entry> shown;
  std::ranges::copy_if(entries, std::back_inserter(shown), [](const Entry& entry) {
    return entry.algorithm->kind != AlgorithmKind::peer && entry.algorithm->name != "auto";
  });
  std::string text;
  for (const SceneToDraw& scene : scenes) {
    if (text.size() > max_json_bytes) break;
    try {
      Drawing drawing =
          draw_scene(find(scene.scene), scene.dimension, scene.boxes, shown, boxes_drawn(scene.dimension));
      for (DrawingView& view : drawing.views) std::erase_if(view.layers, is_empty);
      text += (text.empty() ? "[" : ",\n") + json_text(json_of(drawing));
    } catch (const std::exception&) {
      // A picture that fails must not lose the measurements.
      continue;
    }
  }
  return text.empty() ? "[]" : text + "]";
}

}  // namespace broadside::lab
