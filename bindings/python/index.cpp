// Index: boxes that do not change, for queries in bulk.
#include <memory>
#include <numeric>

#include "bindings/python/queries.hpp"

namespace broadside::python {
namespace {

/// An index of any kind of boxes.
class Index {
 public:
  virtual ~Index() = default;
  virtual std::size_t size() const noexcept = 0;
  virtual int dimension() const noexcept = 0;
  virtual bool has_doubles() const noexcept = 0;
  virtual std::size_t bytes() const noexcept = 0;
  virtual nb::object overlapping(nb::handle queries, const QueryChoice& choice) const = 0;
  virtual nb::object containing(nb::handle points, const QueryChoice& choice) const = 0;
  virtual nb::object hits(nb::handle origins, nb::handle directions, double t_max,
                          const QueryChoice& choice) const = 0;
  virtual nb::object first_hit(nb::handle origins, nb::handle directions, double t_max,
                               const QueryChoice& choice) const = 0;
  virtual nb::object nearest(nb::handle points, std::size_t k, double max_distance,
                             const QueryChoice& choice) const = 0;
};

template <int Dimension, typename Coordinate>
class IndexOf final : public Index {
 public:
  static constexpr int dimension_of = Dimension;

  IndexOf(const Rows& rows, std::span<const Filter> filters) : size_(rows.size()) {
    std::vector<Box<Dimension, Coordinate>> memory;
    const auto boxes = rows.array(memory);
    without_gil([&](WithoutGil&) { index_.update({.boxes = boxes, .filters = filters}); });
  }

  std::size_t size() const noexcept override { return size_; }
  int dimension() const noexcept override { return Dimension; }
  bool has_doubles() const noexcept override { return std::is_same_v<Coordinate, double>; }
  std::size_t bytes() const noexcept override { return index_.bytes(); }

  nb::object overlapping(nb::handle queries, const QueryChoice& choice) const override {
    return Queries(asked_).overlapping(queries, choice);
  }
  nb::object containing(nb::handle points, const QueryChoice& choice) const override {
    return Queries(asked_).containing(points, choice);
  }
  nb::object hits(nb::handle origins, nb::handle directions, double t_max,
                  const QueryChoice& choice) const override {
    return Queries(asked_).hits(origins, directions, t_max, choice);
  }
  nb::object first_hit(nb::handle origins, nb::handle directions, double t_max,
                       const QueryChoice& choice) const override {
    return Queries(asked_).first_hit(origins, directions, t_max, choice);
  }
  nb::object nearest(nb::handle points, std::size_t k, double max_distance,
                     const QueryChoice& choice) const override {
    return Queries(asked_).nearest(points, k, max_distance, choice);
  }

 private:
  /// For Queries. Several threads may ask at once.
  struct Asked {
    static constexpr int dimension = Dimension;
    using Real = Coordinate;
    using Number = std::uint32_t;

    template <typename Body>
    void ask(const Body& body) const {
      body(
          index, [](BoxId id) { return broadside::index(id); },
          [](Number row) { return std::optional(BoxId{row}); });
    }

    const BoxIndex<Dimension, Coordinate>& index;
  };

  std::size_t size_;
  BoxIndex<Dimension, Coordinate> index_;
  const Asked asked_{index_};
};

std::unique_ptr<Index> make_index(nb::handle boxes, nb::handle filters) {
  const Rows rows = Rows::of_boxes(boxes, "boxes");
  const std::vector<Filter> kinds = python::filters(filters, rows.size(), "filters");
  return with_kind(rows.dimension(), rows.are_doubles(),
                   [&]<int D, typename Real>() -> std::unique_ptr<Index> {
                     return std::make_unique<IndexOf<D, Real>>(rows, kinds);
                   });
}

}  // namespace

void add_index(nb::module_& module) {
  nb::class_<Index> type(module, "Index");
  type.def("__len__", &Index::size)
      .def("dimension", &Index::dimension)
      .def("has_doubles", &Index::has_doubles)
      .def("bytes", &Index::bytes);
  add_queries(type);
  module.def("make_index", &make_index, nb::arg("boxes"), nb::arg("filters").none());
}

}  // namespace broadside::python
