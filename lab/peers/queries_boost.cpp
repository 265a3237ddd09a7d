// Box queries to Boost.Geometry's R-tree, packed.
#include <cstdint>
#include <utility>

#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/iterator/function_output_iterator.hpp>

#include "lab/peers/queries.hpp"

namespace broadside::lab::peers {
namespace {

namespace geometry = boost::geometry;

template <int D>
class BoostQueries final : public QueryPeer<D> {
 public:
  explicit BoostQueries(std::span<const Box<D>> boxes) {
    std::vector<Value> values;
    for (std::size_t i = 0; i < boxes.size(); ++i)
      values.emplace_back(converted(boxes[i]), static_cast<std::uint32_t>(i));
    tree_ = Tree(values);
  }

  std::string name() const override { return "boost_rtree"; }
  bool has_boxes() const override { return true; }

  Answers overlapping(std::span<const Box<D>> queries) override {
    Answers answers;
    for (std::size_t i = 0; i < queries.size(); ++i) {
      const auto report = [&answers, i](const Value& value) { answers.add(i, BoxId{value.second}); };
      tree_.query(geometry::index::intersects(converted(queries[i])),
                  boost::make_function_output_iterator(report));
    }
    return answers;
  }

 private:
  using Point = geometry::model::point<float, D, geometry::cs::cartesian>;
  using BoostBox = geometry::model::box<Point>;
  using Value = std::pair<BoostBox, std::uint32_t>;
  using Tree = geometry::index::rtree<Value, geometry::index::rstar<16>>;

  static Point point(const std::array<float, D>& corner) {
    if constexpr (D == 2)
      return {corner[0], corner[1]};
    else
      return {corner[0], corner[1], corner[2]};
  }

  static BoostBox converted(const Box<D>& box) { return {point(box.min), point(box.max)}; }

  Tree tree_;
};

}  // namespace

template <int D>
std::unique_ptr<QueryPeer<D>> boost_queries(std::span<const Box<D>> boxes) {
  return std::make_unique<BoostQueries<D>>(boxes);
}

template std::unique_ptr<QueryPeer<2>> boost_queries(std::span<const Box<2>>);
template std::unique_ptr<QueryPeer<3>> boost_queries(std::span<const Box<3>>);

}  // namespace broadside::lab::peers
