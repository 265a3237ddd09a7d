// The list of scenes, and how a scene found by name becomes a history.
#include "lab/scenes/scene.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "broadside/error.hpp"

#include "lab/formats/format.hpp"
#include "lab/recordings/recordings.hpp"
#include "lab/scenes/motion.hpp"
#include "lab/scenes/registry.hpp"
#include "src/core/suggestion.hpp"

namespace broadside::lab {
namespace {

/// Every scene that the lab knows; those missing from this build come last.
struct SceneList {
  std::vector<Scene> scenes = {
      generated::uniform(),   generated::power_law(),  generated::mixed(),   generated::clustered(),
      generated::one_point(), generated::one_line(),   generated::lattice(), generated::integers(),
      generated::thin(),      generated::terdiman(),   generated::churn(),   generated::jumps(),
      generated::pile(),      generated::join_table(), generated::walls(),
  };
  std::size_t there = 0;  // number of scenes that are not missing

  SceneList() {
    for (const std::vector<Scene>& more : {generated::hard(), recordings::box2d(), recordings::bullet()})
      scenes.insert(scenes.end(), more.begin(), more.end());
    scenes.insert(scenes.end(), {generated::bunny(), generated::counties(), generated::coastlines()});
    // Not the std::ranges version: clang 14 cannot compile its result type.
    const auto missing = std::stable_partition(scenes.begin(), scenes.end(),
                                               [](const Scene& scene) { return scene.missing.empty(); });
    there = static_cast<std::size_t>(missing - scenes.begin());
  }
};

const SceneList& scene_list() {
  static const SceneList list;
  return list;
}

template <int D>
History<D> make(const MakeBoxes<D>& boxes, const MakeHistory<D>& history, const Scene& scene,
                const Spec& spec, const SceneRequest& request) {
  const Settings settings(spec, scene.tunables);
  constexpr std::size_t max_boxes = std::numeric_limits<std::uint32_t>::max();
  if (request.boxes > max_boxes)
    throw InvalidSpec(scene.name + ": " + std::to_string(request.boxes) + " boxes; expected at most " +
                      std::to_string(max_boxes));
  if (history) return history(settings, request);
  if (!boxes) {
    throw InvalidSpec("scene '" + scene.name + "' does not exist in " + std::to_string(D) +
                      "D; expected dimension " + std::to_string(5 - D));
  }
  std::vector<Box<D>> still = boxes(settings, request.boxes, request.seed);
  if (request.frames == 0) return {std::move(still), {}};
  return set_moving<D>(std::move(still), request, scene.integers);
}

}  // namespace

std::string_view name(SceneKind kind) noexcept {
  constexpr std::array<std::string_view, 3> names = {"generated", "recorded", "file"};
  return names[static_cast<std::size_t>(kind)];
}

std::span<const Scene> scenes() { return std::span(scene_list().scenes).first(scene_list().there); }

std::span<const Scene> missing_scenes() { return std::span(scene_list().scenes).subspan(scene_list().there); }

NamedScene find_scene(std::string_view text) { return find_scene(text, {}); }

NamedScene find_scene(std::string_view text, const ReadOptions& files) {
  // A file's name may contain a colon.
  std::error_code ignored;
  const bool is_file = std::filesystem::is_regular_file(text, ignored);
  Spec spec = is_file ? Spec{std::string(text), {}} : Spec(text);
  const std::vector<Scene>& list = scene_list().scenes;
  const auto found = std::ranges::find(list, spec.name, &Scene::name);
  if (found == list.end() && is_path(spec.name)) {
    Scene scene = file_scene(spec.name, files);
    const Settings checked(spec, scene.tunables);
    return {std::move(scene), std::move(spec)};
  }
  if (found == list.end()) {
    std::vector<std::string> known;
    for (const Scene& scene : scenes()) known.push_back(scene.name);
    throw InvalidSpec(fmt::format("unknown scene '{}'{}; expected a file or one of: {}", spec.name,
                                  core::did_you_mean(spec.name, known), fmt::join(known, ", ")));
  }
  if (!found->missing.empty())
    throw InvalidSpec("scene '" + spec.name + "' cannot be made: " + found->missing);
  const Settings checked(spec, found->tunables);
  return {*found, std::move(spec)};
}

FindScene scene_finder(const ReadOptions& files) {
  return [files, read = std::make_shared<std::map<std::string, NamedScene, std::less<>>>()](
             std::string_view text) -> NamedScene {
    if (const auto known = read->find(text); known != read->end()) return known->second;
    NamedScene found = find_scene(text, files);
    if (found.scene.kind == SceneKind::file) read->emplace(text, found);
    return found;
  };
}

template <>
History<2> make_history(const Scene& scene, const Spec& spec, const SceneRequest& request) {
  return make<2>(scene.boxes_2d, scene.history_2d, scene, spec, request);
}

template <>
History<3> make_history(const Scene& scene, const Spec& spec, const SceneRequest& request) {
  return make<3>(scene.boxes_3d, scene.history_3d, scene, spec, request);
}

}  // namespace broadside::lab
