// The scenes and files of a verb.
#include "cli/scene_arguments.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>

#include <CLI/StringTools.hpp>
#include <fmt/format.h>

#include "cli/applicability.hpp"
#include "cli/message.hpp"
#include "cli/values.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::cli {
namespace {

constexpr std::size_t default_frames = 20;  // for scenes that move by themselves

template <int D>
lab::AnyFrameReader make_frames(const lab::NamedScene& named, const lab::SceneRequest& request) {
  return std::make_unique<lab::HistoryReader<D, float>>(
      lab::make_history<D>(named.scene, named.spec, request));
}

}  // namespace

CLI::Option* add_scenes(CLI::App& verb, const std::string& name, std::vector<std::string>& scenes,
                        const std::string& help) {
  return verb.add_option(name + ",--scenes", scenes, help)->type_name("");
}

std::vector<std::string> each_of(const std::vector<std::string>& arguments) {
  std::vector<std::string> scenes;
  for (const std::string& argument : arguments) {
    std::error_code ignored;
    if (std::filesystem::exists(argument, ignored)) {
      scenes.push_back(argument);
      continue;
    }
    if (!argument.empty() && argument.find_first_not_of("0123456789.") == std::string::npos)
      throw Unusable(
          fmt::format("scene '{}' is a number; expected a scene's name, spec or file (several values of "
                      "an option have commas between, such as -n 1000,{})",
                      argument, argument));
    for (const std::string& part : CLI::detail::split(argument, ',')) scenes.push_back(part);
  }
  return scenes;
}

std::string only_one_of(const std::vector<std::string>& arguments) {
  const std::vector<std::string> scenes = each_of(arguments);
  if (scenes.size() != 1)
    throw Unusable(fmt::format("{} scenes: {}; expected one", scenes.size(), fmt::join(scenes, ", ")));
  return scenes[0];
}

bool is_file(const std::string& name) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(name, ignored) || lab::is_path(name)) return true;
  return std::filesystem::exists(name, ignored) &&
         std::ranges::find(lab::scenes(), name, &lab::Scene::name) == lab::scenes().end();
}

void add_boxes(CLI::App& verb, BoxArguments& arguments) {
  add_scenes(verb, "file", arguments.scenes, "The file, - for standard input; or the name or spec of a scene")
      ->required();
  add_input_options(verb, arguments.input);
  verb.add_option("-n", arguments.boxes,
                  fmt::format("Number of boxes of a scene, such as 1000, 100k (default: {})", default_boxes))
      ->type_name("NUMBER");
  verb.add_option("--seed", arguments.seed, "Seed of a scene (default: 1)")->check(is_seed);
}

lab::BoxFile open_boxes(const CLI::App& verb, const BoxArguments& arguments) {
  const std::string name = only_one_of(arguments.scenes);
  const bool reads = is_file(name);
  const lab::NamedScene named = reads ? unread_file(name) : lab::find_scene(name);
  check_options(verb, {&named, 1});
  if (reads) return open_input(arguments.input, name);
  const int dimension = arguments.input.dimension != 0 ? arguments.input.dimension
                        : named.scene.has_dimension(2) ? 2
                                                       : 3;
  check_dimension(dimension);
  lab::SceneRequest request;
  request.boxes = arguments.boxes.empty() ? default_boxes : read_count("-n", arguments.boxes);
  request.seed = arguments.seed.value_or(request.seed);
  if (named.scene.history_2d || named.scene.history_3d) request.frames = default_frames;
  return {named.spec.text(), nullptr,
          dimension == 2 ? make_frames<2>(named, request) : make_frames<3>(named, request)};
}

}  // namespace broadside::cli
