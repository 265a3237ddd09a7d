// Boost.Geometry's R-tree as a searcher, and its queries.
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/geometry/strategies/strategies.hpp>
#include <boost/iterator/function_output_iterator.hpp>
#include <boost/version.hpp>

#include "lab/peers/indexed_set.hpp"
#include "lab/peers/peers.hpp"
#include "lab/peers/queries.hpp"
#include "lab/peers/tear_down.hpp"

namespace broadside::lab::peers {
namespace {

namespace geometry = boost::geometry;

template <int D>
using BoostPoint = geometry::model::point<float, D, geometry::cs::cartesian>;
template <int D>
using BoostBox = geometry::model::box<BoostPoint<D>>;
// The only parameter that matters to a packed tree is the number of values per node: the same as in Boost's
// own benchmark.
template <int D>
using BoostTree = geometry::index::rtree<std::pair<BoostBox<D>, std::uint32_t>, geometry::index::rstar<16>>;

template <std::size_t D>
BoostPoint<int{D}> boost_point(const std::array<float, D>& corner) {
  if constexpr (D == 2)
    return {corner[0], corner[1]};
  else
    return {corner[0], corner[1], corner[2]};
}

template <int D>
BoostBox<D> boost_box(const Box<D>& box) {
  return {boost_point(box.min), boost_point(box.max)};
}

template <int D>
class BoostRtree final : public Searcher<D>, public TearDown {
 public:
  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) override {
    const std::span<const Box<D>> boxes = input.boxes;
    const IndexedSet indexed(input);
    tear_down();
    values_.clear();
    values_.reserve(indexed.end - indexed.begin);
    for (std::size_t i = indexed.begin; i < indexed.end; ++i)
      values_.push_back({boost_box<D>(boxes[i]), static_cast<std::uint32_t>(i)});
    tree_.emplace(values_);  // constructed from a range, the tree is packed
    if (input.left_count > 0) {
      for (std::size_t i = indexed.other_begin; i < indexed.other_end; ++i) {
        const auto report = [&pairs, i](const Value& value) { pairs.add(BoxId(i), BoxId{value.second}); };
        tree_->query(geometry::index::intersects(boost_box<D>(boxes[i])),
                     boost::make_function_output_iterator(report));
      }
      return std::nullopt;
    }
    // In the order of the tree's leaves, so that a query finds the nodes of the previous one in the cache.
    for (const Value& value : *tree_) {
      const auto report = [&pairs, i = value.second](const Value& other) {
        if (other.second > i) pairs.add(BoxId{i}, BoxId{other.second});
      };
      tree_->query(geometry::index::intersects(value.first), boost::make_function_output_iterator(report));
    }
    return std::nullopt;
  }

  void tear_down() override { tree_.reset(); }

 private:
  using Value = typename BoostTree<D>::value_type;

  std::vector<Value> values_;
  std::optional<BoostTree<D>> tree_;  // of the last search
};

namespace geometry = boost::geometry;

template <int D>
class BoostQueries final : public QueryPeer<D> {
 public:
  using Value = typename BoostTree<D>::value_type;

  explicit BoostQueries(std::span<const Box<D>> boxes) {
    std::vector<Value> values;
    for (std::size_t i = 0; i < boxes.size(); ++i)
      values.emplace_back(boost_box<D>(boxes[i]), static_cast<std::uint32_t>(i));
    tree_ = BoostTree<D>(values);
  }

  std::string name() const override { return "boost_rtree"; }
  bool has_boxes() const override { return true; }

  Answers overlapping(std::span<const Box<D>> queries) override {
    Answers answers;
    for (std::size_t i = 0; i < queries.size(); ++i) {
      const auto report = [&answers, i](const Value& value) { answers.add(i, BoxId{value.second}); };
      tree_.query(geometry::index::intersects(boost_box<D>(queries[i])),
                  boost::make_function_output_iterator(report));
    }
    return answers;
  }

  bool has_nearest() const override { return true; }

  void nearest(std::span<const broadside::Point<D, float>> points, std::size_t count,
               std::vector<Pair>& found) override {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto report = [&found, i](const Value& value) {
        found.push_back({BoxId(i), BoxId{value.second}});
      };
      tree_.query(geometry::index::nearest(boost_point(points[i]), static_cast<unsigned>(count)),
                  boost::make_function_output_iterator(report));
    }
  }

 private:
  BoostTree<D> tree_;
};

}  // namespace

Algorithm boost_rtree() {
  constexpr int version = BOOST_VERSION;
  return {
      .name = "boost_rtree",
      .summary = "Boost.Geometry's R-tree, packed, and a query for each box",
      .source = "Boost.Geometry.Index, after Leutenegger et al. 1997 and Garcia et al. 1998",
      .version = "Boost " + std::to_string(version / 100'000) + "." + std::to_string(version / 100 % 1000),
      .in_2d = {.searcher = make_strategy<BoostRtree<2>>},
      .in_3d = {.searcher = make_strategy<BoostRtree<3>>},
      // It compares the boxes' centres.
      .limits = {.infinite_boxes = false, .max_coordinate = std::numeric_limits<float>::max()},
  };
}

template <int D>
std::unique_ptr<QueryPeer<D>> boost_queries(std::span<const Box<D>> boxes) {
  return std::make_unique<BoostQueries<D>>(boxes);
}

template std::unique_ptr<QueryPeer<2>> boost_queries(std::span<const Box<2>>);
template std::unique_ptr<QueryPeer<3>> boost_queries(std::span<const Box<3>>);

}  // namespace broadside::lab::peers
