// GEOS's STRtree, which GIS programs use, with one query per box.
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include <geos/geom/Envelope.h>
#include <geos/index/strtree/TemplateSTRtree.h>
#include <geos/version.h>

#include "lab/peers/indexed_set.hpp"
#include "lab/peers/peers.hpp"
#include "lab/peers/tear_down.hpp"

namespace broadside::lab::peers {
namespace {

class GeosStrtree final : public Searcher<2>, public TearDown {
 public:
  std::optional<Statistics> search(const SearchInput<2>& input, PairSink& pairs) override {
    const std::span<const Box2> boxes = input.boxes;
    constexpr std::size_t standard_capacity = 10;
    // A built tree takes no more items, and a new one cannot reuse its memory.
    const IndexedSet indexed(input);
    auto& tree = tree_.emplace(standard_capacity, indexed.end - indexed.begin);
    for (std::size_t i = indexed.begin; i < indexed.end; ++i)
      tree.insert(envelope(boxes[i]), static_cast<std::uint32_t>(i));
    if (input.left_count > 0) {
      for (std::size_t i = indexed.other_begin; i < indexed.other_end; ++i)
        tree.query(envelope(boxes[i]),
                   [&pairs, i](const std::uint32_t& j) { pairs.add(BoxId(i), BoxId{j}); });
      return std::nullopt;
    }
    // In the order of the tree's leaves, so that a query finds the nodes of the previous one in the cache.
    for (const std::uint32_t i : tree.items()) {
      tree.query(envelope(boxes[i]), [&pairs, i](const std::uint32_t& j) {
        if (j > i) pairs.add(BoxId{i}, BoxId{j});
      });
    }
    return std::nullopt;
  }

  void tear_down() override { tree_.reset(); }

 private:
  static geos::geom::Envelope envelope(const Box2& box) {
    return {box.min[0], box.max[0], box.min[1], box.max[1]};
  }

  std::optional<geos::index::strtree::TemplateSTRtree<std::uint32_t>> tree_;  // of the last search
};

}  // namespace

Algorithm geos_strtree() {
  return {
      .name = "geos_strtree",
      .summary = "GEOS's packed R-tree (sort, tile, recurse), and a query for each box",
      .source = "GEOS, TemplateSTRtree, after Leutenegger et al. 1997",
      .version = std::string("GEOS ") + GEOS_VERSION,
      .in_2d = {.searcher = make_strategy<GeosStrtree>},
      // It compares the boxes' centres.
      .limits = {.infinite_boxes = false, .max_coordinate = std::numeric_limits<float>::max()},
  };
}

}  // namespace broadside::lab::peers
