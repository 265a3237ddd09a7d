// The library's interface for the playground: functions of numbers, texts and arrays, exported from a
// WebAssembly module.
//
// A call takes its boxes from the module's input, which the page fills first, and leaves its results in the
// module's answers, which are valid until the next call. A call that fails returns 1 and leaves its message
// as the text.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <initializer_list>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "broadside/algorithm.hpp"
#include "broadside/debug/outline.hpp"
#include "broadside/error.hpp"
#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"
#include "broadside/tracker.hpp"

#include "algorithms/grid/hierarchical_cells.hpp"
#include "algorithms/outline_text.hpp"
#include "core/cell_axis.hpp"
#include "core/number_text.hpp"
#include "kernels/find_changes.hpp"
#include "kernels/observed_tests.hpp"
#ifndef BROADSIDE_OBSERVE
#include "lab/formats/csv/csv_rows.hpp"
#include "lab/formats/mesh/indexed_mesh.hpp"
#include "lab/formats/registry.hpp"
#include "lab/formats/unread_formats.hpp"
#endif
#include "lab/scenes/registry.hpp"
#include "paper/listings/registry.hpp"

namespace broadside::playground {
namespace {

/// Input of a call, filled by the page.
struct CallInput {
  std::vector<float> boxes;  // minima, then maxima
  std::string text;
};

/// Results of the last call.
struct LastAnswers {
  std::string text;
  std::vector<Pair> pairs;       // of a search; for an update, the begun pairs
  std::vector<Pair> more_pairs;  // the tests of an observed search; for an update, the ended pairs
  std::vector<float> boxes;      // of an outline or a scene
  std::vector<double>
      numbers;  // statistics and bytes; for an outline, the swept axis and the sizes of its levels
};

CallInput input;
LastAnswers answers;

template <int D>
std::vector<Box<D>> boxes_of(std::size_t count) {
  std::vector<Box<D>> boxes(count);
  const float* from = input.boxes.data();
  for (Box<D>& box : boxes) {
    for (int axis = 0; axis < D; ++axis) box.min[axis] = *from++;
    for (int axis = 0; axis < D; ++axis) box.max[axis] = *from++;
  }
  return boxes;
}

template <int D>
void answer_boxes(std::span<const Box<D>> boxes) {
  for (const Box<D>& box : boxes) {
    answers.boxes.insert(answers.boxes.end(), box.min.begin(), box.min.end());
    answers.boxes.insert(answers.boxes.end(), box.max.begin(), box.max.end());
  }
}

void answer_statistics(const std::optional<Statistics>& counted) {
  const Statistics statistics = counted.value_or(Statistics{});
  for (const std::uint64_t number :
       {statistics.tests, statistics.references, statistics.cells, statistics.hits})
    answers.numbers.push_back(static_cast<double>(number));
}

std::string in_quotes(std::string_view text) {
  std::string json = "\"";
  for (const char character : text) {
    if (character == '"' || character == '\\') json += '\\';
    json += character == '\n' ? ' ' : character;
  }
  return json + '"';
}

/// A JSON object of names and values; the values are JSON.
std::string object(std::initializer_list<std::pair<const char*, std::string>> fields) {
  std::string json;
  for (const auto& [name, value] : fields) {
    if (!value.empty()) json += (json.empty() ? "{" : ",") + in_quotes(name) + ":" + value;
  }
  return json + "}";
}

template <typename Items, typename ToJson>
std::string array_of(const Items& items, ToJson to_json) {
  std::string json = "[";
  for (const auto& item : items) json += (json.size() == 1 ? "" : ",") + to_json(item);
  return json + "]";
}

std::string to_json(const Tunable& tunable) {
  const bool is_choice = tunable.type == Tunable::Type::choice;
  constexpr std::array<const char*, 3> types = {"number", "integer", "choice"};
  return object({{"name", in_quotes(tunable.name)},
                 {"summary", in_quotes(tunable.summary)},
                 {"default", in_quotes(tunable.default_value)},
                 {"type", in_quotes(types[static_cast<std::size_t>(tunable.type)])},
                 {"min", is_choice ? "" : core::text_of(tunable.min)},
                 {"max", is_choice ? "" : core::text_of(tunable.max)},
                 {"choices", is_choice ? array_of(tunable.choices, in_quotes) : ""}});
}

template <typename Described>
std::string dimensions_of(const Described& described) {
  std::vector<int> dimensions;
  for (const int dimension : {2, 3}) {
    if (described.has_dimension(dimension)) dimensions.push_back(dimension);
  }
  return array_of(dimensions, [](int dimension) { return std::to_string(dimension); });
}

std::string to_json(const Algorithm& algorithm) {
  return object(
      {{"name", in_quotes(algorithm.name)},
       {"summary", in_quotes(algorithm.summary)},
       {"source", in_quotes(algorithm.source)},
       {"kind", in_quotes(name(algorithm.kind))},
       {"dimensions", dimensions_of(algorithm)},
       {"tracks", algorithm.in_2d.followers.empty() && algorithm.in_3d.followers.empty() ? "false" : "true"},
       {"tunables", array_of(algorithm.tunables, [](const Tunable& each) { return to_json(each); })}});
}

/// The finders requested so far. They keep their memory between calls, as a program's finders would.
template <int D>
Finder<D>& finder_of(const std::string& spec) {
  constexpr std::size_t max_kept = 32;
  static std::map<std::string, Finder<D>> finders;
  auto found = finders.find(spec);
  if (found == finders.end()) {
    Finder<D> made(spec);
    if (finders.size() == max_kept) finders.clear();
    found = finders.emplace(spec, std::move(made)).first;
  }
  return found->second;
}

template <int D>
void find(std::size_t count) {
  Finder<D>& finder = finder_of<D>(input.text);
  const std::vector<Box<D>> boxes = boxes_of<D>(count);
  kernels::observed_tests().clear();
  PairCollector pairs(answers.pairs);
  Statistics statistics = finder.find(boxes, pairs).value_or(Statistics{});
  if constexpr (kernels::is_observing) {
    answers.more_pairs.swap(kernels::observed_tests());
    statistics.hits = 0;
    for (const Pair test : answers.more_pairs)
      statistics.hits += overlap(boxes[index(test.first)], boxes[index(test.second)]) ? 1 : 0;
  }
  answer_statistics(statistics);
}

/// The cells that a tracker with `grid` keeps for these boxes, from the largest to the smallest.
template <int D>
Outline<D> kept_cells(std::optional<double> cell, std::span<const Box<D>> boxes) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  algorithm::HierarchicalCells<D> cells(cell);
  cells.build(boxes, boxes);
  Outline<D> kept;
  kept.kind = "cells";
  for (const kernels::CellLevel<D>& level : cells.view(1).levels) {
    if (level.boxes == 0) continue;
    Box<D> whole;
    whole.min.fill(-infinity);
    whole.max.fill(infinity);
    std::vector<Box<D>> parts = {whole};
    std::string size;
    for (int axis = 0; axis < D; ++axis) {
      const core::CellAxis& along = level.axes[axis];
      size += (axis == 0 ? "" : " x ") + algorithm::three_digits(1 / along.per_unit);
      for (Box<D> part : std::exchange(parts, {})) {
        for (std::uint32_t i = 0; i < along.count(); ++i) {
          part.max[axis] = i + 1 < along.count() ? core::border_before(along, i + 1) : infinity;
          parts.push_back(part);
          part.min[axis] = part.max[axis];
        }
      }
    }
    kept.caption += (kept.caption.empty() ? "kept: " : ", ") + algorithm::counted(parts.size(), "cell") +
                    (parts.size() > 1 ? " of " + size : "") + " with " + std::to_string(level.boxes) +
                    (level.boxes == 1 ? " box" : " boxes");
    kept.levels.insert(kept.levels.begin(), std::move(parts));
  }
  return kept;
}

/// What a search lays over the boxes; if `follows`, what a tracker keeps, where that is cells.
template <int D>
void outline_of(std::size_t count, bool follows) {
  const std::vector<Box<D>> boxes = boxes_of<D>(count);
  const Spec spec(input.text);
  const bool keeps_cells = follows && spec.name == "grid";
  const Outline<D> laid_out =
      keeps_cells
          ? kept_cells<D>(Settings(spec, find_algorithm("grid")->tunables).optional_number("cell"), boxes)
          : outline<D, float>(spec, boxes);
  answers.text = laid_out.kind + "\n" + laid_out.caption;
  answers.numbers.push_back(laid_out.swept_axis);
  for (const auto& level : laid_out.levels) {
    answers.numbers.push_back(static_cast<double>(level.size()));
    answer_boxes<D>(level);
  }
}

/// A tracker, and the last frame that it took.
class FollowedScene {
 public:
  FollowedScene() = default;
  FollowedScene(const FollowedScene&) = delete;
  FollowedScene& operator=(const FollowedScene&) = delete;
  virtual ~FollowedScene() = default;

  /// Takes the first `count` input boxes as the next frame.
  virtual void update(std::size_t count) = 0;
};

template <int D>
class FollowingIn final : public FollowedScene {
 public:
  explicit FollowingIn(const std::string& spec) : tracker_(spec) {}

 private:
  void update(std::size_t count) override {
    std::vector<Box<D>> boxes = boxes_of<D>(count);
    std::vector<BoxId> changed;
    for (std::size_t i = 0; i < std::max(count, before_.size()); ++i) {
      const bool is_in_both = i < count && i < before_.size();
      if (!is_in_both || !(boxes[i] == before_[i])) changed.push_back(BoxId(i));
    }
    PairCollector begun(answers.pairs);
    PairCollector ended(answers.more_pairs);
    answer_statistics(tracker_.update({boxes, changed}, begun, ended));
    before_ = std::move(boxes);
    answers.numbers.push_back(static_cast<double>(tracker_.bytes()));
    answers.text = tracker_.explanation();
  }

  Tracker<D> tracker_;
  std::vector<Box<D>> before_;
};

std::map<std::uint32_t, std::unique_ptr<FollowedScene>> trackers;
std::uint32_t last_tracker = 0;

/// The lab's scenes that are generated by a formula and do not move.
const std::vector<lab::Scene>& scenes() {
  namespace generated = lab::generated;
  static const std::vector<lab::Scene> list = {
      generated::uniform(),   generated::power_law(), generated::mixed(),   generated::clustered(),
      generated::one_point(), generated::one_line(),  generated::lattice(), generated::integers(),
      generated::thin(),      generated::terdiman()};
  return list;
}

template <int D>
void make_scene(std::size_t count, std::uint32_t seed) {
  const Spec spec = Spec(input.text);
  std::string names;
  for (const lab::Scene& scene : scenes()) {
    names += (names.empty() ? "" : ", ") + scene.name;
    if (scene.name != spec.name) continue;
    const lab::MakeBoxes<D>* make = nullptr;
    if constexpr (D == 2)
      make = &scene.boxes_2d;
    else
      make = &scene.boxes_3d;
    if (!*make)
      throw InvalidSpec("scene '" + spec.name + "' does not exist in " + std::to_string(D) +
                        "D; expected dimension " + std::to_string(5 - D));
    return answer_boxes<D>((*make)(Settings(spec, scene.tunables), count, seed));
  }
  throw InvalidSpec("no scene '" + spec.name + "'; expected one of: " + names);
}

#ifndef BROADSIDE_OBSERVE  // only in one of the two modules

/// Why a file with these first bytes cannot be read here; empty if it may be readable.
std::string unread(std::string_view beginning, const std::string& name) {
  constexpr auto magics =
      std::to_array<std::pair<std::string_view, const char*>>({{"\x1F\x8B", "compressed by gzip"},
                                                               {"\x28\xB5\x2F\xFD", "compressed by zstd"},
                                                               {"PK\x03\x04", "a zip archive"},
                                                               {"\x93NUMPY", "a NumPy array"}});
  std::string found;
  for (const auto& [magic, what] : magics) {
    if (beginning.starts_with(magic)) found = what;
  }
  const std::string_view mesh = lab::mesh_content(beginning);
  if (!mesh.empty() && mesh != "ply" && mesh != "obj") found = "a mesh in " + std::string(mesh);
  if (found.empty()) return lab::unread_format(beginning, "", name);
  return "is " + found + "; expected CSV, a trace, PLY, OBJ or GeoJSON; the program reads more";
}

/// Opens a file by its content, as the program does, in the formats whose readers need no other library.
/// `options` has the columns of a table.
lab::AnyFrameReader open_file(std::unique_ptr<lab::Input> file, const lab::ReadOptions& options) {
  const std::string_view beginning = file->beginning();
  if (const std::string why = unread(beginning, file->name()); !why.empty())
    throw lab::FileError(file->name() + ": " + why);
  for (const lab::Format& format : {lab::readers::trace(), lab::readers::mesh(), lab::readers::map()}) {
    if (format.recognises(beginning, "")) return format.open(std::move(file), options);
  }
  // JSON that is no map is no table either; the reader of maps says what it lacks.
  const std::size_t first = beginning.find_first_not_of(" \t\r\n");
  if (first != std::string_view::npos && (beginning[first] == '[' || beginning[first] == '{') &&
      lab::readers::map().recognises(beginning, file->extension()))
    return lab::readers::map().open(std::move(file), options);
  return lab::readers::open_csv(std::move(file), options);
}

/// The boxes of all frames, as floats; the numbers are the dimension and the number of boxes of each frame.
void read_frames(lab::AnyFrameReader frames, const std::string& name) {
  constexpr std::size_t max_boxes = 500'000;
  constexpr std::size_t max_numbers = 60'000'000;
  frames = lab::with_precision(std::move(frames), lab::Precision::float32, name);
  const auto read = [&]<int D, typename Real>(lab::FrameReader<D, Real>& reader) {
    std::vector<Box<D, Real>> boxes = reader.first();
    answers.numbers.push_back(D);
    lab::Step<D, Real> step;
    do {
      if (boxes.size() > max_boxes || answers.boxes.size() > max_numbers)
        throw lab::FileError(name + ": " + std::to_string(boxes.size()) + " boxes in frame " +
                             std::to_string(answers.numbers.size() - 1) +
                             "; the playground takes up to 500,000, and 60 million numbers in all "
                             "frames. The program takes more.");
      answers.numbers.push_back(static_cast<double>(boxes.size()));
      for (const Box<D, Real>& box : boxes) {
        for (const Real number : box.min) answers.boxes.push_back(static_cast<float>(number));
        for (const Real number : box.max) answers.boxes.push_back(static_cast<float>(number));
      }
      if (!reader.next(step)) break;
      lab::apply(step, boxes);
    } while (true);
    answers.text = reader.warning();
  };
  std::visit([&](const auto& reader) { read(*reader); }, frames);
}

#endif

/// Runs the body of an exported function; an exception becomes the text of the answer.
template <typename Body>
int answer(Body body) {
  answers.text.clear();
  answers.pairs.clear();
  answers.more_pairs.clear();
  answers.boxes.clear();
  answers.numbers.clear();
  try {
    paper::register_listings();
    body();
    return 0;
  } catch (const std::exception& error) {
    answers.text = error.what();
    return 1;
  }
}

template <typename Body>
int answer_in(int dimension, Body body) {
  return answer([&] { dimension == 2 ? body.template operator()<2>() : body.template operator()<3>(); });
}

}  // namespace
}  // namespace broadside::playground

#define BROADSIDE_EXPORT(name) extern "C" __attribute__((export_name(#name))) auto name

using namespace broadside::playground;

/// Allocates `count` numbers of boxes, and a text of `size` bytes.
BROADSIDE_EXPORT(input_boxes)(std::uint32_t count)->float* {
  input.boxes.resize(count);
  return input.boxes.data();
}
BROADSIDE_EXPORT(input_text)(std::uint32_t size)->char* {
  input.text.resize(size);
  return input.text.data();
}

BROADSIDE_EXPORT(answer_text)()->const char* { return answers.text.c_str(); }
BROADSIDE_EXPORT(answer_text_size)()->std::uint32_t { return answers.text.size(); }
BROADSIDE_EXPORT(answer_pairs)()->const void* { return answers.pairs.data(); }
BROADSIDE_EXPORT(answer_pair_count)()->std::uint32_t { return answers.pairs.size(); }
BROADSIDE_EXPORT(answer_more_pairs)()->const void* { return answers.more_pairs.data(); }
BROADSIDE_EXPORT(answer_more_pair_count)()->std::uint32_t { return answers.more_pairs.size(); }
BROADSIDE_EXPORT(answer_boxes_begin)()->const float* { return answers.boxes.data(); }
BROADSIDE_EXPORT(answer_boxes_size)()->std::uint32_t { return answers.boxes.size(); }
BROADSIDE_EXPORT(answer_numbers)()->const double* { return answers.numbers.data(); }
BROADSIDE_EXPORT(answer_number_count)()->std::uint32_t { return answers.numbers.size(); }

BROADSIDE_EXPORT(list_algorithms)()->int {
  return answer([] {
    answers.text =
        array_of(broadside::algorithms(), [](const broadside::Algorithm& each) { return to_json(each); });
  });
}

/// Finds the pairs of the input's `count` boxes, with the algorithm specified by the text.
BROADSIDE_EXPORT(find_pairs)(std::uint32_t count, int dimension)->int {
  return answer_in(dimension, [&]<int D>() { find<D>(count); });
}

/// Explains the last search by the algorithm that the text specifies: apart, since a search is timed and its
/// explanation is not part of it.
BROADSIDE_EXPORT(explain)(int dimension)->int {
  return answer_in(dimension, [&]<int D>() { answers.text = finder_of<D>(input.text).explanation(); });
}

BROADSIDE_EXPORT(lay_out)(std::uint32_t count, int dimension, int follows)->int {
  return answer_in(dimension, [&]<int D>() { outline_of<D>(count, follows != 0); });
}

/// Creates a tracker with the algorithm specified by the text; returns its number.
BROADSIDE_EXPORT(start_tracker)(int dimension)->int {
  return answer_in(dimension, [&]<int D>() {
    trackers[++last_tracker] = std::make_unique<FollowingIn<D>>(input.text);
    answers.numbers.push_back(last_tracker);
  });
}

BROADSIDE_EXPORT(update_tracker)(std::uint32_t tracker, std::uint32_t count)->int {
  return answer([&] {
    const auto found = trackers.find(tracker);
    if (found == trackers.end())
      throw broadside::InvalidHandle("tracker " + std::to_string(tracker) +
                                     " was freed; expected one that was not");
    found->second->update(count);
  });
}

BROADSIDE_EXPORT(free_tracker)(std::uint32_t tracker)->void { trackers.erase(tracker); }

BROADSIDE_EXPORT(list_scenes)()->int {
  return answer([] {
    answers.text = array_of(scenes(), [](const broadside::lab::Scene& scene) {
      return object({{"name", in_quotes(scene.name)},
                     {"summary", in_quotes(scene.summary)},
                     {"dimensions", dimensions_of(scene)}});
    });
  });
}

#ifndef BROADSIDE_OBSERVE
/// Reads a file: the text's first line is its name, the second one the columns of a table, as for --columns,
/// or empty; the bytes follow.
BROADSIDE_EXPORT(read_file)()->int {
  return answer([] {
    const std::size_t end = input.text.find('\n');
    const std::size_t next = input.text.find('\n', end + 1);
    const std::string name = input.text.substr(0, end);
    const std::string_view bytes = std::string_view(input.text).substr(next + 1);
    broadside::lab::ReadOptions options;
    options.columns = input.text.substr(end + 1, next - end - 1);
    read_frames(open_file(std::make_unique<broadside::lab::Input>(name, bytes), options), name);
  });
}
#endif

BROADSIDE_EXPORT(make_boxes)(std::uint32_t count, std::uint32_t seed, int dimension)->int {
  return answer_in(dimension, [&]<int D>() { make_scene<D>(count, seed); });
}
