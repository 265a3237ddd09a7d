// broadside scene: generates a scene's boxes and writes them to a file.
#include "lab/scenes/scene.hpp"

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/applicability.hpp"
#include "cli/help.hpp"
#include "cli/message.hpp"
#include "cli/options.hpp"
#include "cli/scene_arguments.hpp"
#include "cli/values.hpp"
#include "cli/verbs.hpp"
#include "lab/convert.hpp"
#include "lab/formats/format.hpp"

namespace broadside::cli {
namespace {

struct SceneArguments {
  std::vector<std::string> scenes;
  std::string scene;  ///< exactly one
  InputOptions input;
  std::string output;
  std::string to;
  std::string boxes;
  int dimension = 0;
  std::optional<double> moving;
  std::string frames;
  MotionOptions motion;
  std::optional<std::uint64_t> seed;
};

/// Refuses options that do not apply to the scene.
void check(const SceneArguments& arguments, const CLI::App& verb, const lab::NamedScene& named) {
  check_options(verb, {&named, 1});
  check_moves(verb, {&named, 1});
  if (arguments.motion.any() && !arguments.moving && arguments.frames.empty())
    throw Unusable(fmt::format(
        "--drift or --teleport for scene '{}', where nothing moves; expected --moving or --frames as well",
        arguments.scene));
}

template <int D>
void write(const SceneArguments& arguments, const lab::NamedScene& named, const lab::Format& format) {
  const bool moves = (D == 2 ? bool(named.scene.history_2d) : bool(named.scene.history_3d)) ||
                     arguments.moving.value_or(0) > 0;
  lab::SceneRequest request;
  request.boxes = arguments.boxes.empty() ? default_boxes : read_count("-n", arguments.boxes);
  request.seed = arguments.seed.value_or(request.seed);
  request.moving = arguments.moving.value_or(0);
  request.drift = arguments.motion.drift_or_standard();
  request.teleport = arguments.motion.teleport_or_standard();
  if (!arguments.frames.empty())
    request.frames = read_count("--frames", arguments.frames);
  else if (moves)
    request.frames = 20;
  if (!moves && request.frames > 0) request.moving = 0.1;
  auto frames =
      std::make_unique<lab::HistoryReader<D, float>>(lab::make_history<D>(named.scene, named.spec, request));
  const lab::Converted written =
      lab::convert({arguments.scene, &format, std::move(frames)}, arguments.output, format, std::nullopt);
  say(lab::text_of(written, arguments.output, format));
}

Exit run(SceneArguments& arguments, const CLI::App& verb) {
  arguments.scene = only_one_of(arguments.scenes);
  if (arguments.moving) check_fraction("--moving", *arguments.moving);
  check(arguments.motion);
  check_writable("-o", arguments.output);
  check_is_other_file("-o", arguments.output, arguments.scene);
  const lab::Format& format = lab::writable_format(arguments.output, arguments.to);
  const lab::NamedScene named =
      lab::find_scene(arguments.scene, read_options(arguments.input, arguments.scene));
  check(arguments, verb, named);
  say_lines(named.scene.warning);
  const int dimension = arguments.dimension != 0 ? arguments.dimension : named.scene.has_dimension(2) ? 2 : 3;
  check_dimension(dimension);
  dimension == 2 ? write<2>(arguments, named, format) : write<3>(arguments, named, format);
  return Exit::success;
}

}  // namespace

Verb add_scene(CLI::App& program) {
  const auto arguments = std::make_shared<SceneArguments>();
  CLI::App* const verb = program.add_subcommand(
      "scene",
      "Makes the boxes of a scene and writes them to a file; `broadside list` shows scenes and formats.");
  add_scenes(*verb, "scene", arguments->scenes, "Name, spec such as power_law:exponent=2, or file")
      ->required();
  verb->add_option("-o,--output", arguments->output,
                   "The file, in the format that its extension says; - is standard output")
      ->required();
  verb->add_option("--to", arguments->to, "The format to write, by its name or an extension")
      ->type_name("NAME");
  verb->add_option("-n", arguments->boxes,
                   fmt::format("Number of boxes, such as 1000, 100k or 1e6 (default: {})", default_boxes));
  verb->add_option("--dimension", arguments->dimension, "2 or 3 (default: 2 where the scene has it)")
      ->check(is_dimension);
  verb->add_option("--moving", arguments->moving, "Fraction of the boxes that move, from 0 to 1");
  verb->add_option(
      "--frames", arguments->frames,
      "Frames after the first (default: 20 where something moves); alone, a tenth of the boxes moves");
  add_motion_options(*verb, arguments->motion);
  verb->add_option("--seed", arguments->seed, "The same seed gives the same boxes (default: 1)")
      ->check(is_seed);
  add_file_options(*verb, arguments->input);
  add_examples(*verb, {{"scene clustered -n 100k -o boxes.csv", "100,000 boxes in clusters, as a table"},
                       {"scene box2d_rain -n 500 --frames 100 -o rain.btrace",
                        "an engine's boxes over 100 frames, recorded"}});
  return [arguments, verb] { return run(*arguments, *verb); };
}

}  // namespace broadside::cli
