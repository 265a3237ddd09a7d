// broadside advise: recommends an algorithm for given boxes, and says why.
#include "lab/advise/advise.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/applicability.hpp"
#include "cli/help.hpp"
#include "cli/interruption.hpp"
#include "cli/message.hpp"
#include "cli/options.hpp"
#include "cli/scene_arguments.hpp"
#include "cli/values.hpp"
#include "cli/verbs.hpp"
#include "lab/formats/write_file.hpp"
#include "lab/measure/steadiness.hpp"
#include "lab/scenes/motion.hpp"

namespace broadside::cli {
namespace {

struct AdviseArguments {
  std::vector<std::string> inputs;
  std::string input;  ///< exactly one
  InputOptions read;
  std::string boxes;
  std::optional<double> moving;
  std::string frames;
  MotionOptions motion;
  std::optional<std::uint64_t> seed;
  EntryOptions entries{.algorithms = "own"};
  std::optional<double> budget;
  bool allows_busy = false;
  std::string json;
};

using AnyHistory =
    std::variant<lab::History<2>, lab::History<3>, lab::History<2, double>, lab::History<3, double>>;

/// The boxes and motion that advice is given on.
struct AdvisedHistory {
  std::string name;
  std::string warning;
  AnyHistory history;
};

bool asks_for_motion(const AdviseArguments& arguments) {
  return arguments.moving || !arguments.frames.empty() || arguments.motion.any();
}

lab::SceneRequest request_of(const AdviseArguments& arguments) {
  constexpr std::size_t default_frames = 20;
  lab::SceneRequest request;
  request.boxes = arguments.boxes.empty() ? default_boxes : read_count("-n", arguments.boxes);
  request.seed = arguments.seed.value_or(request.seed);
  if (asks_for_motion(arguments))
    request.frames = arguments.frames.empty() ? default_frames : read_count("--frames", arguments.frames);
  request.moving = arguments.moving.value_or(request.moving);
  request.drift = arguments.motion.drift_or_standard();
  request.teleport = arguments.motion.teleport_or_standard();
  return request;
}

template <int D, typename Real>
AnyHistory whole(lab::FrameReader<D, Real>& frames, std::string& warning) {
  lab::History<D, Real> history = lab::read_all(frames);
  warning = frames.warning();
  return history;
}

AdvisedHistory read_file(const AdviseArguments& arguments) {
  lab::ReadOptions options = read_options(arguments.read, arguments.input);
  // Generated motion is in floats.
  if (asks_for_motion(arguments)) {
    if (options.precision == lab::Precision::float64)
      throw Unusable("--precision is double for boxes that are set moving; expected float");
    options.precision = lab::Precision::float32;
  }
  lab::BoxFile file = lab::open_file(arguments.input, options);
  AdvisedHistory boxes{file.name, {}, {}};
  boxes.history = std::visit([&](const auto& frames) { return whole(*frames, boxes.warning); }, file.frames);
  if (!asks_for_motion(arguments)) return boxes;
  const lab::SceneRequest request = request_of(arguments);
  std::visit(
      [&]<int D, typename Real>(lab::History<D, Real>& history) {
        if (!history.steps.empty())
          throw Unusable(fmt::format(
              "--moving, --frames, --drift or --teleport with '{}'; expected none, its boxes move already",
              arguments.input));
        if constexpr (std::is_same_v<Real, float>)
          history = lab::set_moving<D>(std::move(history.boxes), request, false);
      },
      boxes.history);
  return boxes;
}

AdvisedHistory make_scene(const AdviseArguments& arguments, const lab::NamedScene& named) {
  lab::SceneRequest request = request_of(arguments);
  const int dimension = arguments.read.dimension != 0  ? arguments.read.dimension
                        : named.scene.has_dimension(2) ? 2
                                                       : 3;
  // Scenes that move by themselves show nothing in a single frame.
  constexpr std::size_t frames_of_motion = 30;
  const bool moves = dimension == 2 ? bool(named.scene.history_2d) : bool(named.scene.history_3d);
  if (moves && request.frames == 0) request.frames = frames_of_motion;
  if (dimension == 2)
    return {named.spec.text(), named.scene.warning, lab::make_history<2>(named.scene, named.spec, request)};
  return {named.spec.text(), named.scene.warning, lab::make_history<3>(named.scene, named.spec, request)};
}

void check(const AdviseArguments& arguments) {
  if (arguments.moving) check_fraction("--moving", *arguments.moving);
  check(arguments.motion);
  if (arguments.budget && !(*arguments.budget > 0 && *arguments.budget <= 3600))
    throw Unusable(
        fmt::format("--budget is {}; expected a number of seconds above 0, at most 3600", *arguments.budget));
  if (arguments.json.empty()) return;
  check_is_no_output("--json", arguments.json);
  check_writable("--json", arguments.json);
  check_is_other_file("--json", arguments.json, arguments.input);
  check_extension("--json", arguments.json, {".json"});
}

Exit run(AdviseArguments& arguments, const CLI::App& verb, const lab::Catalogue& catalogue,
         std::span<const std::string> command) {
  arguments.input = only_one_of(arguments.inputs);
  check(arguments);
  const bool reads = is_file(arguments.input);
  const lab::NamedScene named =
      reads ? unread_file(arguments.input) : lab::find_scene(arguments.input, read_options(arguments.read));
  check_options(verb, {&named, 1});
  check_moves(verb, {&named, 1});
  ProgressLine progress;
  lab::AdviseOptions options;
  options.algorithms = arguments.entries.algorithms;
  options.threads = threads_of(arguments.entries);
  options.budget_seconds = arguments.budget.value_or(options.budget_seconds);
  options.watch.stop = interrupted;
  options.watch.progress = [&, watch = lab::Stopwatch()](std::string_view what) {
    progress.show(what, watch.milliseconds() / 1e3 / options.budget_seconds);
  };
  check_threads(arguments.entries, catalogue.select(options.algorithms));
  // Refused before the file is read.
  const auto is_peer = [](const lab::Entry& entry) { return lab::is_foreign(entry.algorithm->kind); };
  if (std::ranges::all_of(catalogue.select(options.algorithms), is_peer))
    throw Unusable(
        fmt::format("--algorithms is '{}'; expected one of Broadside's own among them: other libraries, and "
                    "what is from the literature, are never advised",
                    options.algorithms));
  AdvisedHistory boxes = reads ? read_file(arguments) : make_scene(arguments, named);

  on_signal(OnSignal::note_then_end);
  lab::Advice advice;
  const lab::ProcessorShare share;
  try {
    advice =
        std::visit([&](const auto& history) { return lab::advise(catalogue, boxes.name, history, options); },
                   boxes.history);
  } catch (const lab::Stopped&) {
    throw Interruption();
  }
  advice.processor_share = share.value();
  advice.is_withheld = lab::is_busy(advice.processor_share) && !arguments.allows_busy;
  progress.clear();
  advice.warning = boxes.warning;
  say_lines(advice.warning);
  print(lab::text_of(advice, output_width()));
  flush_output();
  if (!arguments.json.empty()) {
    on_signal(OnSignal::end);
    const std::string text = lab::json_of(advice, command);
    lab::write_file(arguments.json, [&text](std::ostream& file) { file << text; });
  }
  return advice.all_verified() ? Exit::success : Exit::failed;
}

}  // namespace

Verb add_advise(CLI::App& program, const lab::Catalogue& catalogue, std::span<const std::string> command) {
  const auto arguments = std::make_shared<AdviseArguments>();
  CLI::App* const verb = program.add_subcommand(
      "advise",
      "Says which algorithm suits your boxes, and why: measures what the boxes are like and the "
      "algorithms on them, every result verified, and prints a ranking, the spec and the lines of C++ for "
      "it.");
  add_scenes(*verb, "scene", arguments->inputs,
             "A file of boxes, still or moving (a recording of your engine), - for standard input; or the "
             "name or spec of a scene")
      ->required();
  add_input_options(*verb, arguments->read);
  verb->add_option("-n", arguments->boxes, "Number of boxes of a scene, such as 1000, 100k (default: 10000)");
  verb->add_option("--moving", arguments->moving,
                   "Fraction of the boxes that move, from 0 to 1, where these are still (default: 0.1 if "
                   "--frames is given)");
  verb->add_option("--frames", arguments->frames, "Number of frames with motion (default: 20)");
  add_motion_options(*verb, arguments->motion);
  verb->add_option("--seed", arguments->seed, "Seed of a scene (default: 1)")->check(is_seed);
  add_algorithms(
      *verb, arguments->entries.algorithms,
      "Names, specs such as grid:cell=2.5, or the groups own, paper, literature, peers, all; a comma "
      "between. Peers and literature are shown, but never advised");
  add_threads(*verb, arguments->entries,
              "Numbers of threads to try besides one, such as "
              "2,4 (0: as many as the machine has); advised where they pay");
  verb->add_option("--budget", arguments->budget,
                   fmt::format("About how many seconds measuring may take (default: {})",
                               lab::AdviseOptions{}.budget_seconds));
  verb->add_flag("--allow-busy", arguments->allows_busy,
                 "Advise even if other programs had the processor for more than a tenth of the time");
  verb->add_option("--json", arguments->json, "Also write the advice and its measurements to this file")
      ->type_name("FILE");
  add_examples(*verb, {{"advise boxes.csv", "the algorithm for your boxes, from any file that is read"},
                       {"advise recording.btrace --threads 1,4 --json advice.json",
                        "for a recording of your engine, with one thread and with four"}});
  return [arguments, verb, &catalogue, command] { return run(*arguments, *verb, catalogue, command); };
}

}  // namespace broadside::cli
