// The worst-case hunt: inputs on which a broad phase may be slow, and how slow ours are. `worst --help` lists
// the families of inputs.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include "bench/guarded.hpp"
#include "bench/worst/hunt.hpp"
#include "bench/worst/report.hpp"
#include "lab/measure/memory.hpp"
#include "lab/numbers.hpp"
#include "lab/report/machine.hpp"
#include "lab/worst/hard_input.hpp"

namespace broadside::bench {
namespace {

struct Arguments {
  std::vector<std::string> inputs;
  std::string algorithms = "own";
  std::string json;
  std::size_t draw = 0;
  std::uint64_t seed = 1;
  std::size_t worst = 10;
  bool judge = false;
  bool list = false;
  Hunt hunt{.algorithms = {}};
};

std::string families() {
  std::string text;
  for (const lab::InputFamily& family : lab::input_families()) {
    text += fmt::format("\n  {:<11} {}", family.name, family.summary);
    for (const lab::DrawnTunable& drawn : family.tunables)
      text += fmt::format("\n    {:<11} {} ({})", drawn.tunable.name, drawn.tunable.summary,
                          drawn.tunable.default_value);
  }
  return text;
}

CLI::App* describe(CLI::App& program, Arguments& arguments) {
  program.footer(
      "Families, and the values that an input may give:" + families() +
      "\n  all         dimension=2|3, real=float|double, call=find|between|track, left, moving, drift, "
      "teleport, exponent, offset, order=made|shuffled|reversed, seed");
  program.add_option("inputs", arguments.inputs,
                     "Inputs such as plates:regions=4:dimension=3:call=track, instead of the fixed list");
  program.add_option("--draw", arguments.draw, "Draw this many inputs instead of the fixed list");
  program.add_option("--seed", arguments.seed, "Of the drawn inputs")->capture_default_str();
  program.add_option("-n", arguments.hunt.effort.boxes, "Boxes of an input")
      ->check(CLI::Range(100, 100'000'000))
      ->capture_default_str();
  program.add_option("--algorithms", arguments.algorithms, "Algorithms; brute_force is not among `own`")
      ->capture_default_str();
  program.add_option("--rounds", arguments.hunt.effort.rounds, "Timed calls of each")->capture_default_str();
  program.add_option("--limit", arguments.hunt.limit_seconds, "Seconds for an algorithm and an input")
      ->capture_default_str();
  program.add_option("--worst", arguments.worst, "Inputs shown of each algorithm")->capture_default_str();
  program.add_option("--json", arguments.json, "Write all results to this file");
  program.add_flag("--judge", arguments.judge,
                   "Run others only while they may be the best, and end with 1 if auto is above its bounds");
  program.add_flag("--list", arguments.list, "Print the inputs and measure nothing");
  return &program;
}

/// Generates random inputs, and replaces an input that turns out to have too many pairs.
class Source {
 public:
  explicit Source(const Arguments& arguments) : arguments_(arguments), random_(arguments.seed) {
    for (const std::string& text : arguments.inputs) inputs_.push_back(lab::parse_input(text));
    if (inputs_.empty() && arguments.draw == 0) inputs_ = lab::fixed_inputs();
  }

  std::size_t size() const { return draws() ? arguments_.draw : inputs_.size(); }
  bool draws() const { return inputs_.empty(); }
  lab::HardInput next() {
    return draws() ? lab::draw_input(random_, arguments_.hunt.effort.boxes) : inputs_.at(next_++);
  }

 private:
  const Arguments& arguments_;
  lab::Random random_;
  std::vector<lab::HardInput> inputs_;
  std::size_t next_ = 0;
};

std::vector<lab::Entry> without_brute_force(std::vector<lab::Entry> entries) {
  std::erase_if(entries, [](const lab::Entry& entry) { return entry.spec.text() == "brute_force"; });
  return entries;
}

std::vector<InputResult> hunt(const Arguments& arguments) {
  Source source(arguments);
  Hunter hunter(arguments.hunt);
  std::vector<InputResult> results;
  const bool is_watched = isatty(STDERR_FILENO) == 1;
  while (results.size() < source.size()) {
    InputResult result = hunter.measure(source.next());
    // Fixed inputs must not be replaced.
    if (result.state == InputResult::State::too_many_pairs && source.draws()) continue;
    results.push_back(std::move(result));
    // Print at once: a hunt takes long, and its findings must survive if it is stopped.
    fmt::print("{}", above_text(results.back(), arguments.hunt.bounds));
    std::fflush(stdout);
    if (is_watched) fmt::print(stderr, "\r{} of {}", results.size(), source.size());
  }
  if (is_watched) fmt::print(stderr, "\n");
  return results;
}

void write_json(const std::string& file, const nlohmann::json& json) {
  std::ofstream stream(file);
  stream << json.dump(1) << "\n";
  if (!stream.flush()) throw std::runtime_error("'" + file + "' cannot be written; expected a file that can");
}

int run(int count, char** values) {
  CLI::App program("Hunts for inputs with few pairs on which our algorithms are slow.");
  Arguments arguments;
  describe(program, arguments);
  CLI11_PARSE(program, count, values);
  if (arguments.draw > 0 && !arguments.inputs.empty())
    throw std::runtime_error("--draw and inputs are both given; expected one of them");
  if (arguments.list) {
    Source source(arguments);
    for (std::size_t i = 0; i < source.size(); ++i) fmt::print("{}\n", source.next().text());
    return 0;
  }
  const lab::Catalogue catalogue;
  Hunt& hunted = arguments.hunt;
  hunted.algorithms = catalogue.select(arguments.algorithms);
  if (arguments.algorithms == "own") hunted.algorithms = without_brute_force(hunted.algorithms);
  // `auto` first, because its time limits the time of the others.
  std::stable_partition(hunted.algorithms.begin(), hunted.algorithms.end(),
                        [](const lab::Entry& entry) { return entry.spec.name == "auto"; });
  if (arguments.judge && hunted.algorithms.front().spec.name != "auto")
    throw std::runtime_error("--judge without auto among --algorithms; expected auto");
  hunted.references = catalogue.select("bvh,quadtree,sweep_and_prune,grid");
  hunted.judges_auto = arguments.judge;
  hunted.reference_seconds = 3 * hunted.limit_seconds;
  lab::keep_freed_memory();
  const lab::Machine machine = lab::this_machine();
  fmt::print("{} boxes, {} s at most; {}, {} cores; {}, {}\n\n", lab::grouped(hunted.effort.boxes),
             hunted.limit_seconds, machine.cpu, machine.cores, lab::this_build().compiler,
             lab::this_build().revision);
  const std::vector<InputResult> results = hunt(arguments);
  fmt::print("\n{}{}", table(results, hunted, arguments.worst), summary(results, hunted));
  if (!arguments.json.empty()) write_json(arguments.json, to_json(results, hunted));
  if (has_fault(results)) return 2;
  return arguments.judge && above_bounds(results, hunted.bounds) > 0 ? 1 : 0;
}

}  // namespace
}  // namespace broadside::bench

int main(int count, char** arguments) {
  using namespace broadside::bench;
  return guarded("worst", 2, [&] { return run(count, arguments); });
}
