// broadside draw: a scene's boxes and what algorithms lay over them, as a picture.
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/input_options.hpp"
#include "cli/interruption.hpp"
#include "cli/message.hpp"
#include "cli/unusable.hpp"
#include "cli/values.hpp"
#include "cli/verbs.hpp"
#include "lab/catalogue.hpp"
#include "lab/readers/write_file.hpp"
#include "lab/report/drawing.hpp"
#include "lab/report/drawing_svg.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::cli {
namespace {

constexpr std::size_t standard_boxes = 300;

/// Of more boxes a picture is a black square, and too large a file.
constexpr std::size_t most_boxes = 20'000;

struct DrawArguments {
  std::string scene;
  std::string algorithms;
  InputOptions input;
  std::string output;
  std::string boxes;
  int dimension = 0;
  std::optional<std::uint64_t> seed;
};

std::vector<lab::Contender> contenders(const lab::Catalogue& catalogue, const DrawArguments& arguments,
                                       int dimension) {
  std::vector<lab::Contender> chosen;
  if (!arguments.algorithms.empty()) chosen = catalogue.select(arguments.algorithms);
  for (const lab::Contender& contender : chosen) {
    if (!contender.algorithm->has_dimension(dimension))
      throw Unusable(fmt::format("--algorithm is '{}', which does not do {}D; expected --dimension {}",
                                 contender.algorithm->name, dimension, 5 - dimension));
  }
  return chosen;
}

Exit run(const DrawArguments& arguments) {
  on_signal(OnSignal::end);
  check_writable("-o", arguments.output);
  check_is_other_file("-o", arguments.output, arguments.scene);
  const lab::Catalogue catalogue;
  const lab::NamedScene named =
      lab::find_scene(arguments.scene, read_options(arguments.input, arguments.scene));
  if (!named.scene.warning.empty()) say(named.scene.warning);
  if (arguments.seed && named.scene.fixed_seed)
    throw Unusable(fmt::format("--seed for scene '{}', which is the same for every seed; expected none",
                               arguments.scene));
  const int dimension = arguments.dimension != 0 ? arguments.dimension : named.scene.has_dimension(2) ? 2 : 3;
  check_dimension(dimension);
  const std::size_t boxes = arguments.boxes.empty() ? standard_boxes : read_count("-n", arguments.boxes);
  if (boxes > most_boxes)
    throw Unusable(fmt::format("-n is {}; expected at most {}, which is more than an eye tells apart", boxes,
                               most_boxes));
  const lab::Drawing drawing =
      lab::draw_scene(named, dimension, 0, contenders(catalogue, arguments, dimension), boxes,
                      arguments.seed.value_or(lab::SceneRequest{}.seed));
  const std::string picture = lab::svg_of(drawing);
  lab::write_file(arguments.output, [&picture](std::ostream& file) { file << picture; });
  return Exit::fine;
}

}  // namespace

Verb add_draw(CLI::App& program) {
  const auto arguments = std::make_shared<DrawArguments>();
  CLI::App* const verb = program.add_subcommand(
      "draw",
      "Draws a scene's boxes and the cells, nodes or sweep that algorithms lay over them, as SVG; 3D from "
      "three sides.");
  verb->add_option("scene", arguments->scene, "Name, spec such as power_law:exponent=2, or file")->required();
  verb->add_option("-o,--output", arguments->output, "The file; - is standard output")->required();
  verb->add_option("--algorithm", arguments->algorithms,
                   "What to lay over the boxes: a spec such as quadtree:capacity=16, or several with commas, "
                   "side by side (standard: only the boxes)");
  verb->add_option(
      "-n", arguments->boxes,
      fmt::format("Number of boxes (standard: {}); of a scene or file of more, so many are taken "
                  "and made larger, as dense as all",
                  standard_boxes));
  verb->add_option("--dimension", arguments->dimension, "2 or 3 (standard: 2 where the scene has it)")
      ->check(is_dimension);
  verb->add_option("--seed", arguments->seed, "The same seed gives the same boxes (standard: 1)")
      ->check(is_seed);
  add_file_options(*verb, arguments->input);
  return [arguments] { return run(*arguments); };
}

}  // namespace broadside::cli
