// The lab's functions: advice, files, drawings, and scenes for the tests.
#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "bindings/python/input.hpp"
#include "bindings/python/running.hpp"
#include "lab/advise/advise.hpp"
#include "lab/catalogue.hpp"
#include "lab/formats/columns.hpp"
#include "lab/formats/format.hpp"
#include "lab/report/drawing.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::python {
namespace {

/// Made when the module is imported, before algorithms are looked up: it registers the paper's listings.
const lab::Catalogue& catalogue() {
  static const lab::Catalogue all;
  return all;
}

nb::list algorithms() {
  nb::list list;
  for (const Algorithm& algorithm : broadside::algorithms()) {
    nb::list tunables;
    for (const Tunable& tunable : algorithm.tunables)
      tunables.append(nb::make_tuple(tunable.name, tunable.summary, tunable.default_value));
    nb::list dimensions;
    for (const int dimension : {2, 3}) {
      if (algorithm.has_dimension(dimension)) dimensions.append(dimension);
    }
    list.append(nb::make_tuple(algorithm.name, algorithm.summary, algorithm.source,
                               std::string(name(algorithm.kind)), nb::tuple(dimensions), tunables));
  }
  return list;
}

nb::object advise(nb::handle boxes, const std::string& algorithms, std::vector<std::size_t> threads,
                  double budget) {
  const Rows rows = Rows::of_boxes(boxes, "boxes");
  return with_kind(rows.kind(), [&]<int D, typename Real>() -> nb::object {
    lab::History<D, Real> history;
    std::vector<Box<D, Real>> memory;
    const std::span<const Box<D, Real>> all = rows.array(memory);
    history.boxes.assign(all.begin(), all.end());
    const lab::Advice advice = without_gil([&](WithoutGil& released) {
      lab::AdviseOptions options{.algorithms = algorithms, .threads = threads, .budget_seconds = budget};
      // The lab checks for signals only between measurements, so as not to disturb them.
      options.watch.stop = [&released] {
        released.check_signals();
        return false;
      };
      return lab::advise(catalogue(), "boxes", history, options);
    });
    nb::list ranking;
    for (const lab::RankedAlgorithm& ranked : advice.ranking)
      ranking.append(nb::make_tuple(ranked.measurement.algorithm, ranked.milliseconds));
    return nb::make_tuple(advice.spec, advice.milliseconds, advice.reasons, advice.changes, ranking,
                          advice.all_verified(), lab::text_of(advice));
  });
}

/// The boxes of one frame of a file, and a warning about what could not be read. `content` has the file's
/// bytes if they are in memory, and is None otherwise.
nb::object read(const nb::bytes& name, nb::handle content, const std::string& format,
                const std::string& boxes, const std::string& columns, bool selects_columns, int dimension,
                std::size_t frame, bool skips_invalid) {
  std::optional<PythonBuffer> bytes;
  if (!content.is_none()) bytes.emplace(content, PyBUF_SIMPLE);
  const std::string path(name.c_str(), name.size());
  lab::ReadOptions options;
  options.format = format;
  options.boxes = boxes;
  options.columns = columns;
  options.selects_columns = selects_columns;
  options.dimension = dimension;
  std::string invalid;
  if (skips_invalid) options.say_invalid = [&](std::string_view why) { invalid = why; };
  std::string warning;
  const auto read_frame = [&]<int D, typename Real>(lab::FrameReader<D, Real>& frames,
                                                    WithoutGil& released) -> std::vector<Box<D, Real>> {
    std::vector<Box<D, Real>> now = frames.first();
    for (std::size_t at = 0; at < frame; ++at) {
      released.check_signals();
      lab::Step<D, Real> step;
      if (!frames.next(step))
        throw std::invalid_argument("frame is " + std::to_string(frame) + "; expected at most " +
                                    std::to_string(at) + ", the last one of '" + path + "'");
      lab::apply(step, now);
    }
    warning = frames.warning();
    return now;
  };
  using AnyBoxes =
      std::variant<std::vector<Box2>, std::vector<Box3>, std::vector<DoubleBox2>, std::vector<DoubleBox3>>;
  AnyBoxes found = without_gil([&](WithoutGil& released) {
    options.progress = [&released](std::uint64_t, std::uint64_t) { released.check_signals(); };
    lab::BoxFile file =
        bytes ? lab::open_input(lab::Input::in_memory(path, bytes->text(), options.progress), options)
              : lab::open_file(path, options);
    return std::visit([&](const auto& frames) -> AnyBoxes { return read_frame(*frames, released); },
                      file.frames);
  });
  if (!invalid.empty()) warning += (warning.empty() ? "" : "\n") + invalid;
  const nb::object array = std::visit(
      []<int D, typename Real>(std::vector<Box<D, Real>>& all) { return array_of<Real>(std::move(all)); },
      found);
  return nb::make_tuple(array, text_of(warning));
}

std::string_view name_of(lab::readers::BoundsForm form) {
  using lab::readers::BoundsForm;
  switch (form) {
    case BoundsForm::min_max:
      return "min_max";
    case BoundsForm::min_size:
      return "min_size";
    case BoundsForm::centre_size:
      return "centre_size";
    case BoundsForm::centre_half_size:
    case BoundsForm::centre_radius:
      return "centre_half_size";
    case BoundsForm::point:
      return "point";
    case BoundsForm::flat:
      return "flat";
    case BoundsForm::bottom_top:
      return "bottom_top";
  }
  throw std::logic_error("a form of bounds without a name");
}

/// The meaning of a table's columns by their names: (problem, dimension, [(form, first, second) for each
/// axis], geometry). `first`, `second` and `geometry` are indexes into `names`, or -1 for none.
nb::tuple resolve_columns(const std::vector<std::string>& names, bool are_chosen) {
  using lab::readers::BoxColumns;
  BoxColumns columns;
  const std::string problem =
      lab::readers::resolve(std::vector<std::string_view>(names.begin(), names.end()), columns, are_chosen);
  const auto column_of = [&](int place) {
    const auto found = std::ranges::find(columns.places, place);
    return found == columns.places.end() ? -1 : static_cast<int>(found - columns.places.begin());
  };
  nb::list axes;
  for (int axis = 0; axis < columns.dimension && problem.empty() && !columns.has_geometry; ++axis) {
    const lab::readers::BoundsForm form = columns.forms[static_cast<std::size_t>(axis)];
    const int second =
        form == lab::readers::BoundsForm::centre_radius ? int{BoxColumns::radius} : BoxColumns::second + axis;
    axes.append(nb::make_tuple(nb::str(name_of(form).data()), column_of(BoxColumns::first + axis),
                               column_of(second)));
  }
  return nb::make_tuple(problem, columns.dimension, axes, column_of(BoxColumns::geometry));
}

/// The axis that a column's name speaks of, from 0; -1 if it has no meaning.
int axis_of(const std::string& name) {
  const std::optional<lab::readers::Meaning> meaning = lab::readers::meaning_of(name);
  return meaning ? meaning->axis : -1;
}

nb::object formats() {
  nb::list list;
  for (const lab::Format& format : lab::formats())
    list.append(nb::make_tuple(format.name, format.summary, format.extensions, format.missing));
  return list;
}

std::string draw(nb::handle boxes, const std::string& algorithms, std::size_t most,
                 const std::string& title) {
  // Drawings are of floats.
  const Rows rows = Rows::of_boxes(boxes, "boxes");
  return with_kind(rows.kind(), [&]<int D, typename Real>() -> std::string {
    std::vector<Box<D, Real>> memory;
    const std::span<const Box<D, Real>> all = rows.array(memory);
    return without_gil([&](WithoutGil&) {
      std::vector<Box<D>> rounded(all.size());
      for (std::size_t i = 0; i < all.size(); ++i) {
        for (std::size_t axis = 0; axis < D; ++axis) {
          rounded[i].min[axis] = static_cast<float>(all[i].min[axis]);
          rounded[i].max[axis] = static_cast<float>(all[i].max[axis]);
        }
      }
      const lab::Thinned<D> thin = lab::thinned<D>(rounded, most);
      const auto entries = algorithms.empty() ? std::vector<lab::Entry>() : catalogue().select(algorithms);
      lab::Drawing drawing = lab::draw<D>(title, thin.boxes, all.size(), entries);
      drawing.largest = thin.largest;
      return lab::svg_of(drawing);
    });
  });
}

/// For the tests: the boxes of a scene of the lab.
nb::object scene(const std::string& spec, std::size_t boxes, int dimension, std::uint64_t seed) {
  const lab::NamedScene named = lab::find_scene(spec);
  const lab::SceneRequest request{.boxes = boxes, .seed = seed};
  if (dimension == 2) return array_of<float>(lab::make_history<2>(named.scene, named.spec, request).boxes);
  return array_of<float>(lab::make_history<3>(named.scene, named.spec, request).boxes);
}

nb::object scenes() {
  nb::list list;
  for (const lab::Scene& scene : lab::scenes())
    list.append(nb::make_tuple(scene.name, scene.has_dimension(2), scene.has_dimension(3)));
  return list;
}

}  // namespace

void add_lab(nb::module_& module) {
  static_cast<void>(catalogue());
  module.def("algorithms", &algorithms);
  module.def("advise", &advise, nb::arg("boxes").none(), nb::arg("algorithms"), nb::arg("threads"),
             nb::arg("budget"));
  module.def("read", &read, nb::arg("path"), nb::arg("content").none(), nb::arg("format"), nb::arg("boxes"),
             nb::arg("columns"), nb::arg("selects_columns"), nb::arg("dimension"), nb::arg("frame"),
             nb::arg("skips_invalid"));
  module.def("axis_of", &axis_of, nb::arg("name"));
  module.def("formats", &formats);
  module.def("resolve_columns", &resolve_columns, nb::arg("names"), nb::arg("are_chosen"));
  module.def("draw", &draw, nb::arg("boxes"), nb::arg("algorithms"), nb::arg("most"), nb::arg("title"));
  module.def("scene", &scene, nb::arg("spec"), nb::arg("boxes"), nb::arg("dimension"), nb::arg("seed"));
  module.def("scenes", &scenes);
}

}  // namespace broadside::python
