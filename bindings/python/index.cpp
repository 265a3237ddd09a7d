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
  virtual nb::object overlapping(nb::handle queries) const = 0;
  virtual nb::object containing(nb::handle points) const = 0;
  virtual nb::object hits(nb::handle origins, nb::handle directions, double t_max) const = 0;
  virtual nb::object first_hit(nb::handle origins, nb::handle directions, double t_max) const = 0;
  virtual nb::object nearest(nb::handle points, std::size_t k) const = 0;
};

template <int Dimension, typename Coordinate>
class IndexOf final : public Index {
 public:
  static constexpr int dimension_of = Dimension;

  explicit IndexOf(const Rows& rows) : size_(rows.size()) {
    std::vector<Box<Dimension, Coordinate>> memory;
    const auto boxes = rows.array(memory);
    without_gil([&](WithoutGil&) { index_->update({.boxes = boxes}); });
  }

  std::size_t size() const noexcept override { return size_; }
  int dimension() const noexcept override { return Dimension; }
  bool has_doubles() const noexcept override { return std::is_same_v<Coordinate, double>; }
  std::size_t bytes() const noexcept override { return index_->bytes(); }

  nb::object overlapping(nb::handle queries) const override { return Queries(asked_).overlapping(queries); }
  nb::object containing(nb::handle points) const override { return Queries(asked_).containing(points); }
  nb::object hits(nb::handle origins, nb::handle directions, double t_max) const override {
    return Queries(asked_).hits(origins, directions, t_max);
  }
  nb::object first_hit(nb::handle origins, nb::handle directions, double t_max) const override {
    return Queries(asked_).first_hit(origins, directions, t_max);
  }
  nb::object nearest(nb::handle points, std::size_t k) const override {
    return Queries(asked_).nearest(points, k);
  }

 private:
  /// Several threads may ask at once.
  struct Asked {
    static constexpr int dimension = Dimension;
    using Real = Coordinate;
    using Number = std::uint32_t;

    template <typename Body>
    void ask(const Body& body) const {
      body(index, [](BoxId id) { return broadside::index(id); });
    }

    const BoxIndex<Dimension, Coordinate>& index;
  };

  std::size_t size_;
  std::unique_ptr<BoxIndex<Dimension, Coordinate>> index_ = make_box_index<Dimension, Coordinate>();
  const Asked asked_{*index_};
};

std::unique_ptr<Index> make_index(nb::handle boxes) {
  const Rows rows = Rows::of_boxes(boxes, "boxes");
  return with_kind(rows.dimension(), rows.are_doubles(),
                   [&]<int D, typename Real>() -> std::unique_ptr<Index> {
                     return std::make_unique<IndexOf<D, Real>>(rows);
                   });
}

}  // namespace

void add_index(nb::module_& module) {
  nb::class_<Index>(module, "Index")
      .def("__len__", &Index::size)
      .def("dimension", &Index::dimension)
      .def("has_doubles", &Index::has_doubles)
      .def("bytes", &Index::bytes)
      .def("overlapping", &Index::overlapping, nb::arg("queries").none())
      .def("containing", &Index::containing, nb::arg("points").none())
      .def("hits", &Index::hits, nb::arg("origins").none(), nb::arg("directions").none(), nb::arg("t_max"))
      .def("first_hit", &Index::first_hit, nb::arg("origins").none(), nb::arg("directions").none(),
           nb::arg("t_max"))
      .def("nearest", &Index::nearest, nb::arg("points").none(), nb::arg("k"));
  module.def("make_index", &make_index);
}

}  // namespace broadside::python
