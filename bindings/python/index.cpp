// Index: boxes that do not change, for queries in bulk.
#include <memory>

#include "bindings/python/queries.hpp"

namespace broadside::python {
namespace {

/// Several threads may ask at once.
template <int D, typename Real>
struct PyIndex {
  using Number = std::uint32_t;

  PyIndex(const Rows& rows, std::span<const Filter> filters) : size(rows.size()) {
    std::vector<Box<D, Real>> memory;
    const auto boxes = rows.array(memory);
    without_gil([&](WithoutGil&) { index.update({.boxes = boxes, .filters = filters}); });
  }

  /// For Queries.
  template <typename Body>
  void ask(const Body& body) const {
    body(
        index, [](BoxId id) { return broadside::index(id); },
        [](Number row) { return std::optional(BoxId{row}); });
  }

  static Box<D, Real> as_kept(const Box<D, Real>& box) { return box; }

  std::size_t size;
  BoxIndex<D, Real> index;
};

using AnyIndex = AnyKind<PyIndex>;

std::unique_ptr<AnyIndex> make_index(nb::handle boxes, nb::handle filters) {
  const Rows rows = Rows::of_boxes(boxes, "boxes");
  return std::make_unique<AnyIndex>(rows.kind(), rows, python::filters(filters, rows.size(), "filters"));
}

/// The k other boxes nearest to each. A row is a box or, if it has one column for each dimension, a point.
nb::tuple nearest_pairs_of(nb::handle boxes, std::size_t columns, bool are_doubles, std::size_t k,
                           double max_distance, nb::handle max_threads, nb::handle given_filters) {
  const Rows rows = Rows::of(boxes, "boxes", columns, are_doubles);
  const std::size_t count = rows.size();
  check_answers(k, count);
  const std::vector<Filter> filters = python::filters(given_filters, count, "filters");
  NearestOfEachOptions options{.max_distance = max_distance, .filters = filters};
  options.workers.threads = threads_of(max_threads, "");
  const bool are_points = columns < 4;
  std::vector<BoxId> found = large_vector<BoxId>(k * count);
  std::vector<double> distances = large_vector<double>(k * count);
  with_kind(bindings::kind_with(static_cast<int>(are_points ? columns : columns / 2), are_doubles),
            [&]<int D, typename Real>() {
              return without_gil([&](WithoutGil& released) {
                options.workers.checkpoint = [&released] { released.check_signals(); };
                std::vector<Box<D, Real>> memory;
                std::vector<Point<D, Real>> scratch;
                std::span<const Box<D, Real>> all;
                if (are_points) {
                  const std::span<const Point<D, Real>> points = rows.array(scratch);
                  memory = large_vector<Box<D, Real>>(count);
                  for (std::size_t i = 0; i < count; ++i) memory[i] = {points[i], points[i]};
                  all = memory;
                } else {
                  all = rows.array(memory);
                }
                BoxIndex<D, Real> index;
                index.update({.boxes = all, .filters = filters});
                std::vector<BoxId> itself = large_vector<BoxId>(count);
                for (std::size_t i = 0; i < count; ++i) itself[i] = BoxId(i);
                options.except = itself;
                index.nearest_of_each(all, k, found, distances, options);
                return 0;
              });
            });
  return nb::make_tuple(array_of<std::uint32_t>(std::move(found), {count, k}),
                        array_of<double>(std::move(distances), {count, k}));
}

}  // namespace

void add_index(nb::module_& module) {
  nb::class_<AnyIndex> type(module, "Index");
  type.def("__len__", [](const AnyIndex& any) { return any.visit([](auto& self) { return self.size; }); })
      .def("dimension", [](const AnyIndex& any) { return bindings::dimension_of(any.kind()); })
      .def("bytes",
           [](const AnyIndex& any) { return any.visit([](auto& self) { return self.index.bytes(); }); });
  add_queries(type);
  module.def("nearest_pairs", &nearest_pairs_of, nb::arg("boxes"), nb::arg("columns"), nb::arg("are_doubles"),
             nb::arg("k"), nb::arg("max_distance"), nb::arg("threads").none(), nb::arg("filters").none());
  module.def("make_index", &make_index, nb::arg("boxes"), nb::arg("filters").none());
}

}  // namespace broadside::python
