// Reads lists of cases, and measures them.
#include "lab/measure/case_list.hpp"

#include <algorithm>
#include <limits>
#include <new>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "broadside/error.hpp"
#include "broadside/executor.hpp"

#include "lab/formats/format.hpp"
#include "lab/formats/json/json_place.hpp"
#include "lab/measure/steadiness.hpp"
#include "lab/platform/machine.hpp"

namespace broadside::lab {
namespace {

/// Runs a step that reads a value. Prefixes errors of specs and files with the value's place.
template <typename Step>
auto at_place(const JsonPlace& place, const Step& step) {
  try {
    return step();
  } catch (const InvalidSpec& error) {
    throw FileError(place.name() + ": " + error.what());
  } catch (const FileError& error) {
    throw FileError(place.name() + ": " + error.what());
  }
}

std::size_t count_from(const JsonPlace& place, std::size_t min_count, std::size_t max_count = SIZE_MAX) {
  const std::uint64_t count = place.count();
  if (count < min_count || count > max_count) {
    place.refuse(max_count == SIZE_MAX ? fmt::format("a whole number of at least {}", min_count)
                                       : fmt::format("a whole number from {} to {}", min_count, max_count));
  }
  return count;
}

double fraction_from(const JsonPlace& place) {
  const double fraction = place.number();
  if (fraction > 1) place.refuse("a fraction from 0 to 1");
  return fraction;
}

/// Sets the fields of `effort` that the object at `place` has.
void read_effort(const JsonPlace& place, Effort& effort) {
  const std::pair<const char*, double Effort::*> times[] = {
      {"budget_seconds", &Effort::budget_seconds},
      {"history_seconds", &Effort::history_seconds},
      {"share_seconds", &Effort::share_seconds},
      {"slow_seconds", &Effort::slow_seconds},
      {"slow_history_seconds", &Effort::slow_history_seconds}};
  const std::pair<const char*, std::size_t Effort::*> counts[] = {
      {"min_rounds", &Effort::min_rounds},
      {"max_rounds", &Effort::max_rounds},
      {"slow_rounds", &Effort::slow_rounds},
      {"definition_boxes", &Effort::definition_boxes}};
  place.check_fields({"budget_seconds", "history_seconds", "share_seconds", "slow_seconds",
                      "slow_history_seconds", "min_rounds", "max_rounds", "slow_rounds", "definition_boxes"});
  for (const auto& [name, field] : times) {
    if (place.has(name)) effort.*field = place.at(name).number();
  }
  for (const auto& [name, field] : counts) {
    if (place.has(name)) effort.*field = count_from(place.at(name), 1);
  }
  if (effort.max_rounds < effort.min_rounds)
    place.refuse(fmt::format("no fewer max_rounds than min_rounds, {}", effort.min_rounds));
}

void read_measure_options(const JsonPlace& place, ListedCase& listed) {
  listed.measure_options.times = false;
  for (const JsonPlace& part : place.list()) {
    const std::string what = part.text();
    if (what == "time" || what == "phases")
      listed.measure_options.times = true;
    else if (what != "counts" && what != "memory")
      part.refuse("time, counts, memory or phases");
    listed.measure_options.phases = listed.measure_options.phases || what == "phases";
  }
}

/// A scene whose seeds select the boxes of these files, in order.
NamedScene scene_of_files(std::vector<NamedScene> files, std::uint64_t first_seed) {
  std::string names;
  for (const NamedScene& file : files) names += (names.empty() ? "" : " ") + file.spec.name;
  Scene scene = files[0].scene;
  const auto one_of = [files = std::move(files), first_seed](std::uint64_t seed) -> const Scene& {
    return files[(seed - first_seed) % files.size()].scene;
  };
  if (scene.boxes_2d) {
    scene.boxes_2d = [one_of](const Settings& settings, std::size_t boxes, std::uint64_t seed) {
      return one_of(seed).boxes_2d(settings, boxes, seed);
    };
  }
  if (scene.boxes_3d) {
    scene.boxes_3d = [one_of](const Settings& settings, std::size_t boxes, std::uint64_t seed) {
      return one_of(seed).boxes_3d(settings, boxes, seed);
    };
  }
  scene.fixed_seed = false;
  return {std::move(scene), Spec(names, {})};
}

NamedScene read_scene(const JsonPlace& place, std::size_t dimension, std::uint64_t first_seed,
                      const FindScene& find) {
  const auto found_at = [&](const JsonPlace& part) {
    const std::string text = part.text();
    NamedScene found = at_place(part, [&] { return find(text); });
    if (!found.scene.has_dimension(static_cast<int>(dimension)))
      part.refuse(fmt::format("a scene that exists in {}D", dimension));
    return found;
  };
  if (!place.json().is_array()) return found_at(place);
  std::vector<NamedScene> files;
  for (const JsonPlace& part : place.list()) {
    files.push_back(found_at(part));
    if (files.back().scene.kind != SceneKind::file ||
        moves_by_itself(files.back().scene, static_cast<int>(dimension)))
      part.refuse("a file of boxes at rest, as each of several scenes");
  }
  if (files.empty()) place.refuse("at least one file");
  return scene_of_files(std::move(files), first_seed);
}

/// The number of boxes and their motion, which depend on the scene.
void read_boxes(const JsonPlace& place, ListedCase& listed) {
  const Scene& scene = listed.scene.scene;
  CaseRequest& request = listed.request;
  if (scene.fixed_count && place.has("boxes"))
    place.at("boxes").refuse(fmt::format("none: scene '{}' has a count of its own", scene.name));
  constexpr std::size_t max_boxes = std::numeric_limits<std::uint32_t>::max();
  if (!scene.fixed_count) request.boxes = count_from(place.at("boxes"), 1, max_boxes);

  const bool moves = moves_by_itself(scene, request.dimension);
  if (place.has("frames")) request.frames = count_from(place.at("frames"), 1);
  if (place.has("moving")) request.moving = fraction_from(place.at("moving"));
  if (place.has("drift")) request.drift = place.at("drift").number();
  if (place.has("teleport")) request.teleport = fraction_from(place.at("teleport"));
  for (const char* const name : {"moving", "drift", "teleport"}) {
    if (!place.has(name)) continue;
    if (moves) place.at(name).refuse(fmt::format("none: scene '{}' moves by itself", scene.name));
    if (request.frames == 0) place.at(name).refuse("frames as well");
  }
  if (!moves && request.frames > 0 && !(request.moving > 0))
    place.at("frames").refuse("the fraction that is moving as well, above 0");
  if (listed.measure_options.made_anew && request.frames > 0)
    place.at("made_anew").refuse("false where boxes move: a tracker keeps its structure");
  if (place.has("left")) request.left = fraction_from(place.at("left"));
  if (place.has("filtered")) request.filtered = place.at("filtered").truth();
  for (const char* const name : {"left", "filtered"}) {
    if (place.has(name) && (moves || request.frames > 0)) place.at(name).refuse("none where boxes move");
  }
  if (request.left > 0 && request.filtered) place.at("filtered").refuse("false where two sets are joined");

  const JsonPlace files = place.at("scene");
  if (files.json().is_array()) listed.seeds = files.json().size();
  if (place.has("seeds")) {
    if (listed.seeds > 0) place.at("seeds").refuse("none: each file is an input");
    listed.seeds = count_from(place.at("seeds"), 1, 10'000);
  }
  if (scene.fixed_seed && listed.seeds > 1)
    place.at("seeds").refuse(fmt::format("1: scene '{}' is the same for every seed", scene.name));
}

/// Whether any of these entries records phases on such a case.
bool any_phases(const std::vector<Entry>& entries, const CaseRequest& request) {
  return std::ranges::any_of(entries, [&](const Entry& entry) {
    const Algorithm& algorithm = *entry.algorithm;
    const bool follows =
        request.dimension == 2 ? !algorithm.in_2d.followers.empty() : !algorithm.in_3d.followers.empty();
    return algorithm.kind == AlgorithmKind::paper && (request.frames == 0 || follows);
  });
}

void read_algorithms(const JsonPlace& place, const Catalogue& catalogue, ListedCase& listed) {
  bool has_phases = false;
  for (const JsonPlace& part : place.list()) {
    const std::string text = part.text();
    const std::vector<Entry> entries = at_place(part, [&] { return catalogue.select(text); });
    for (const Entry& entry : entries) {
      const bool is_group = entries.size() > 1;
      const std::string reason = is_group ? "" : unfit(entry, listed.request.dimension, {});
      if (!reason.empty())
        part.refuse(fmt::format("an algorithm for {}D: it {}", listed.request.dimension, reason));
    }
    has_phases = has_phases || any_phases(entries, listed.request);
    listed.algorithms += (listed.algorithms.empty() ? "" : ",") + text;
  }
  if (listed.algorithms.empty()) place.refuse("at least one spec");
  if (listed.measure_options.phases && !has_phases)
    place.refuse(
        "a listing of the paper that has phases here, such as paper_grid, since they are to be taken");
}

std::string read_instruction_set(const JsonPlace& place) {
  std::string name = place.text();
  const std::vector<std::string> known = instruction_sets();
  if (std::ranges::find(known, name) == known.end())
    place.refuse(fmt::format("one of this machine's instruction sets: {}", fmt::join(known, ", ")));
  return name;
}

/// During its lifetime, restricts the library to an instruction set, if one is given.
class HeldToInstructionSet {
 public:
  explicit HeldToInstructionSet(const std::string& name) { limit_instruction_set(name); }
  ~HeldToInstructionSet() { limit_instruction_set(""); }
  HeldToInstructionSet(const HeldToInstructionSet&) = delete;
  HeldToInstructionSet& operator=(const HeldToInstructionSet&) = delete;
};

ListedCase read_listed_case(const JsonPlace& place, const Effort& effort, const Catalogue& catalogue,
                            const FindScene& find) {
  place.check_fields({"name", "scene", "dimension", "boxes", "left", "filtered", "seed", "seeds", "moving",
                      "frames", "drift", "teleport", "specs", "take", "made_anew", "instruction_set",
                      "effort"});
  ListedCase listed;
  listed.name = place.at("name").text();
  if (listed.name.empty()) place.at("name").refuse("a name");
  listed.effort = effort;
  if (place.has("effort")) read_effort(place.at("effort"), listed.effort);
  if (place.has("take")) read_measure_options(place.at("take"), listed);
  if (place.has("made_anew")) listed.measure_options.made_anew = place.at("made_anew").truth();
  if (place.has("instruction_set"))
    listed.instruction_set = read_instruction_set(place.at("instruction_set"));
  const std::size_t dimension = place.has("dimension") ? count_from(place.at("dimension"), 2, 3) : 2;
  listed.request.dimension = static_cast<int>(dimension);
  if (place.has("seed")) listed.seed = place.at("seed").count();
  listed.scene = read_scene(place.at("scene"), dimension, listed.seed, find);
  listed.request.scene = listed.scene.spec.text();
  read_boxes(place, listed);
  read_algorithms(place.at("specs"), catalogue, listed);
  return listed;
}

}  // namespace

std::vector<ListedCase> read_case_list(std::string_view text, const std::string& name,
                                       const Catalogue& catalogue, const FindScene& find) {
  const nlohmann::ordered_json json = parse_json(text, name);
  const JsonPlace root(json, name);
  root.check_fields({"schema", "effort", "cases"});
  if (const JsonPlace schema = root.at("schema"); schema.text() != "broadside.cases/1")
    schema.refuse("\"broadside.cases/1\"");
  Effort effort;
  // All algorithms of a case take part in the same rounds, however slow they are.
  effort.far_ratio = std::numeric_limits<double>::infinity();
  if (root.has("effort")) read_effort(root.at("effort"), effort);
  std::vector<ListedCase> cases;
  for (const JsonPlace& place : root.at("cases").list()) {
    const std::string called = place.has("name") ? fmt::format(" '{}'", place.at("name").text()) : "";
    const JsonPlace named(place.json(), place.name() + called);
    cases.push_back(read_listed_case(named, effort, catalogue, find));
    const auto first = std::ranges::find(cases, cases.back().name, &ListedCase::name);
    if (first != cases.end() - 1) named.at("name").refuse("a name that no other case has");
  }
  if (cases.empty()) root.at("cases").refuse("at least one case");
  return cases;
}

Comparison measure_cases(const Catalogue& catalogue, const std::vector<ListedCase>& cases, const Watch& watch,
                         const std::function<void(const CaseResult&)>& finished) {
  Comparison all;
  all.load_before = platform::load();
  const ProcessorShare share;
  for (const ListedCase& listed : cases) {
    CompareOptions options;
    options.algorithms = listed.algorithms;
    options.plan = {listed.request};
    options.seed = listed.seed;
    options.seeds = listed.seeds;
    options.find = [&listed](std::string_view) { return listed.scene; };
    options.effort = listed.effort;
    options.measure_options = listed.measure_options;
    options.watch = {watch.stop, [&](std::string_view what) {
                       if (watch.progress) watch.progress(fmt::format("{}: {}", listed.name, what));
                     }};
    Comparison one;
    const HeldToInstructionSet held(listed.instruction_set);
    try {
      one = compare(catalogue, options);
    } catch (const std::bad_alloc&) {
      throw std::runtime_error(
          fmt::format("case '{}': out of memory; expected fewer boxes, frames or pairs", listed.name));
    } catch (const std::exception& error) {
      throw std::runtime_error(fmt::format("case '{}': {}", listed.name, error.what()));
    }
    if ((all.stopped = one.stopped)) break;
    CaseResult& result = one.cases.at(0);
    result.of.name = listed.name;
    if (finished) finished(result);
    all.cases.push_back(std::move(result));
  }
  all.processor_share = share.value();
  all.load_after = platform::load();
  return all;
}

}  // namespace broadside::lab
