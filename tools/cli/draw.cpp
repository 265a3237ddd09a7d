// broadside draw: a picture of a scene's boxes and of an algorithm's structures over them.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
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
#include "lab/catalogue.hpp"
#include "lab/formats/write_file.hpp"
#include "lab/numbers.hpp"
#include "lab/report/drawing.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::cli {
namespace {

constexpr std::size_t drawn_boxes = 300;

/// With more boxes, a picture is a black square and too large a file.
constexpr std::size_t max_boxes = 20'000;

/// For generated scenes; a file has as many as it has.
constexpr std::size_t max_frames = 10'000;

struct DrawArguments {
  std::vector<std::string> scenes;
  std::string scene;  ///< exactly one
  std::string algorithms;
  InputOptions input;
  std::string output;
  std::string boxes;
  int dimension = 0;
  std::optional<std::uint64_t> seed;
  std::string frame;
};

/// The algorithms requested by name; of a group, only those that draw something over the boxes.
std::vector<lab::Entry> entries(const lab::Catalogue& catalogue, const std::string& list, int dimension) {
  std::vector<lab::Entry> chosen;
  if (list.empty()) return chosen;
  const auto choose = [&](const lab::Entry& entry) {
    const auto same = [&](const lab::Entry& c) { return c.spec.text() == entry.spec.text(); };
    if (std::ranges::none_of(chosen, same)) chosen.push_back(entry);
  };
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    const std::string part = list.substr(begin, end - begin);
    begin = end + 1;
    for (const lab::Entry& entry : catalogue.select(part)) {
      const bool is_group = Spec(part).name != entry.algorithm->name;
      if (is_group) {
        if (lab::has_outline(entry, dimension)) choose(entry);
        continue;
      }
      if (!entry.algorithm->has_dimension(dimension))
        throw Unusable(
            fmt::format("--algorithms is '{}', which does not support {}D; expected --dimension {}",
                        entry.algorithm->name, dimension, 5 - dimension));
      choose(entry);
    }
  }
  if (chosen.empty()) {
    std::vector<std::string> known;
    for (const lab::Entry& entry : entries(catalogue, "all", dimension))
      known.push_back(entry.algorithm->name);
    throw Unusable(fmt::format(
        "--algorithms is '{}', but none of them lays anything over boxes in {}D; expected some of: {}", list,
        dimension, fmt::join(known, ", ")));
  }
  return chosen;
}

/// The requested frame, counted from 0.
std::size_t frame_of(const DrawArguments& arguments, const lab::Scene& scene) {
  if (arguments.frame.empty()) return 0;
  const std::size_t frame = read_index("--frame", arguments.frame);
  if (scene.kind != lab::SceneKind::file && frame > max_frames)
    throw Unusable(fmt::format("--frame is {}; expected at most {}, as all frames before it are made", frame,
                               max_frames));
  return frame;
}

/// Refuses names of other kinds, because pictures are always SVG.
void check_is_svg(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  if (extension.empty() || CLI::detail::to_lower(extension) == ".svg") return;
  const std::string converted = extension == ".png" || extension == ".pdf" ? extension.substr(1) : "png";
  throw Unusable(
      fmt::format("-o is '{}', but what is written is SVG; expected a file's name with .svg, or -, and then "
                  "for example `rsvg-convert -f {} -o picture.{} picture.svg`",
                  path, converted, converted));
}

Exit run(DrawArguments& arguments, const CLI::App& verb, const lab::Catalogue& catalogue) {
  arguments.scene = only_one_of(arguments.scenes);
  check_writable("-o", arguments.output);
  check_is_other_file("-o", arguments.output, arguments.scene);
  check_is_svg(arguments.output);
  const lab::NamedScene named =
      lab::find_scene(arguments.scene, read_options(arguments.input, arguments.scene));
  check_options(verb, {&named, 1}, {"-n"});
  say_lines(named.scene.warning);
  const int dimension = arguments.dimension != 0 ? arguments.dimension : named.scene.has_dimension(2) ? 2 : 3;
  check_dimension(dimension);
  const std::size_t boxes = arguments.boxes.empty() ? drawn_boxes : read_count("-n", arguments.boxes);
  if (boxes > max_boxes)
    throw Unusable(fmt::format("-n is {}; expected at most {}, which is more than an eye tells apart", boxes,
                               max_boxes));
  const lab::Drawing drawing =
      lab::draw_scene(named, dimension, 0, entries(catalogue, arguments.algorithms, dimension), boxes,
                      arguments.seed.value_or(lab::SceneRequest{}.seed), frame_of(arguments, named.scene));
  const std::string picture = lab::svg_of(drawing);
  lab::write_file(arguments.output, [&picture](std::ostream& file) { file << picture; });
  say(fmt::format("{}: {} of {} boxes in {}D, {}",
                  arguments.output == "-" ? "standard output" : arguments.output, lab::grouped(drawing.boxes),
                  lab::grouped(drawing.of), drawing.dimension, lab::bytes(picture.size())));
  return Exit::success;
}

}  // namespace

Verb add_draw(CLI::App& program, const lab::Catalogue& catalogue) {
  const auto arguments = std::make_shared<DrawArguments>();
  CLI::App* const verb = program.add_subcommand(
      "draw",
      "Draws a scene's boxes and the cells, nodes or sweep that algorithms lay over them, as SVG; 3D from "
      "three sides.");
  add_scenes(*verb, "scene", arguments->scenes, "Name, spec such as power_law:exponent=2, or file")
      ->required();
  verb->add_option("-o,--output", arguments->output, "The .svg file; - is standard output")
      ->type_name("FILE")
      ->required();
  add_algorithms(*verb, arguments->algorithms,
                 "What to lay over the boxes: a spec such as quadtree:capacity=16, or several with commas, "
                 "side by side; own, paper or all: the ones that lay something over boxes "
                 "(default: only the boxes)");
  verb->add_option(
      "-n", arguments->boxes,
      fmt::format("Number of boxes (default: {}); of a file of more, this many are taken, and made "
                  "larger, as dense as all, except for those far larger than most",
                  drawn_boxes));
  verb->add_option("--dimension", arguments->dimension, "2 or 3 (default: 2 where the scene has it)")
      ->check(is_dimension);
  verb->add_option("--seed", arguments->seed, "The same seed gives the same boxes (default: 1)")
      ->check(is_seed);
  verb->add_option("--frame", arguments->frame,
                   "The frame of a scene or file whose boxes move, counted from 0 (default: the first)");
  add_file_options(*verb, arguments->input);
  add_examples(*verb, {{"draw clustered --algorithms quadtree:capacity=16,bvh -o trees.svg",
                        "300 boxes of a scene and the nodes of two trees, side by side"},
                       {"draw rain.csv --frame 50 --algorithms all -o rain.svg",
                        "a frame of a file, with what each algorithm lays over it"}});
  return [arguments, verb, &catalogue] { return run(*arguments, *verb, catalogue); };
}

}  // namespace broadside::cli
