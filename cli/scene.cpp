// broadside scene: makes a scene's boxes and writes them to a file.
#include "lab/scenes/scene.hpp"

#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "cli/interruption.hpp"
#include "cli/unusable.hpp"
#include "cli/values.hpp"
#include "cli/verbs.hpp"
#include "lab/readers/format.hpp"

namespace broadside::cli {
namespace {

struct SceneArguments {
  std::string scene;
  std::string output;
  std::string boxes = "10000";
  int dimension = 0;
  double moving = 0;
  std::string frames;
  std::uint64_t seed = 1;
};

template <int D>
void write(const SceneArguments& arguments, const lab::NamedScene& named) {
  const bool moves =
      (D == 2 ? bool(named.scene.history_2d) : bool(named.scene.history_3d)) || arguments.moving > 0;
  lab::SceneRequest request;
  request.boxes = read_count("-n", arguments.boxes);
  request.seed = arguments.seed;
  request.moving = arguments.moving;
  if (!arguments.frames.empty())
    request.frames = read_count("--frames", arguments.frames);
  else if (moves)
    request.frames = 20;
  if (!moves && request.frames > 0) request.moving = 0.1;
  const lab::History<D> history = lab::make_history<D>(named.scene, named.spec, request);
  on_signal(OnSignal::note);
  lab::write_scene(history, arguments.output);
}

Exit run(const SceneArguments& arguments) {
  on_signal(OnSignal::end);
  check_fraction("--moving", arguments.moving);
  check_writable("-o", arguments.output);
  const lab::NamedScene named = lab::find_scene(arguments.scene);
  const int dimension = arguments.dimension != 0 ? arguments.dimension : named.scene.has_dimension(2) ? 2 : 3;
  check_dimension(dimension);
  dimension == 2 ? write<2>(arguments, named) : write<3>(arguments, named);
  return interrupted() ? Exit::interrupted : Exit::fine;
}

}  // namespace

Verb add_scene(CLI::App& program) {
  const auto arguments = std::make_shared<SceneArguments>();
  CLI::App* const verb = program.add_subcommand(
      "scene",
      "Makes the boxes of a scene and writes them to a file; `broadside list` tells scenes and formats.");
  verb->add_option("scene", arguments->scene, "Name, spec such as power_law:exponent=2, or file")->required();
  verb->add_option("-o,--output", arguments->output, "The file, in the format that its extension says")
      ->required();
  verb->add_option("-n,--boxes", arguments->boxes, "Number of boxes, such as 1000, 100k or 1e6")
      ->capture_default_str();
  verb->add_option("--dimension", arguments->dimension, "2 or 3 (standard: 2 where the scene has it)");
  verb->add_option("--moving", arguments->moving, "Fraction of the boxes that move, from 0 to 1")
      ->capture_default_str();
  verb->add_option(
      "--frames", arguments->frames,
      "Frames after the first (standard: 20 where something moves); alone, a tenth of the boxes moves");
  verb->add_option("--seed", arguments->seed, "The same seed gives the same boxes")
      ->check(is_seed)
      ->capture_default_str();
  return [arguments] { return run(*arguments); };
}

}  // namespace broadside::cli
