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

}  // namespace

void add_index(nb::module_& module) {
  nb::class_<AnyIndex> type(module, "Index");
  type.def("__len__", [](const AnyIndex& any) { return any.visit([](auto& self) { return self.size; }); })
      .def("dimension", [](const AnyIndex& any) { return bindings::dimension_of(any.kind()); })
      .def("bytes",
           [](const AnyIndex& any) { return any.visit([](auto& self) { return self.index.bytes(); }); });
  add_queries(type);
  module.def("make_index", &make_index, nb::arg("boxes"), nb::arg("filters").none());
}

}  // namespace broadside::python
