// The paper's quadtree as an algorithm: its searcher, its outline, and its description.
#include <string>
#include <utility>
#include <vector>

#include "broadside/debug/outline.hpp"
#include "broadside/searcher.hpp"

#include "paper/listings/coherent_follower.hpp"
#include "paper/listings/followers.hpp"
#include "paper/listings/listing_searcher.hpp"
#include "paper/listings/quadtree_listing.hpp"
#include "paper/listings/registry.hpp"
#include "paper/listings/world.hpp"

namespace broadside::paper {
namespace {

class Quadtree final : public ListingSearcher<2> {
 public:
  explicit Quadtree(const Settings& settings)
      : world_settings_(settings), capacity_(static_cast<std::size_t>(settings.integer("capacity"))) {}

  /// Calls use(tree, root) with the tree over the boxes.
  template <typename Use>
  void fill(std::span<const Box2> boxes, Checkpoint& checkpoint, Use use) {
    const World world = world_settings_.around(boxes);
    QuadTree tree{.boxes = boxes,
                  .count_max = capacity_,
                  .depth_max = choose_depth(boxes, world),
                  .checkpoint = &checkpoint};
    QuadTreeNode root(tree, world);
    end_phase(&Phases::initializing_ms);
    for (std::size_t i = 0; i < boxes.size(); ++i) root.algorithm_7_add_element(BoxId(i));
    end_phase(&Phases::adding_ms);
    use(tree, root);
  }

 private:
  Statistics search_listed(std::span<const Box2> boxes, PairSink& pairs, Checkpoint& checkpoint) override {
    Statistics statistics;
    fill(boxes, checkpoint, [&](const QuadTree& tree, const QuadTreeNode& root) {
      statistics = search_tree(tree, root, pairs);
    });
    return statistics;
  }

  WorldSettings world_settings_;
  std::size_t capacity_;
};

Outline<2> quadtree_outline(std::span<const Box2> boxes, const Workers& workers, const Settings& settings) {
  Outline<2> outline;
  outline.kind = "nodes";
  std::size_t leaves = 0;
  Checkpoint checkpoint(workers.checkpoint);
  Quadtree(settings).fill(boxes, checkpoint, [&](const QuadTree&, const QuadTreeNode& root) {
    leaves = root.lay_out(outline.levels);
  });
  std::size_t nodes = 0;
  for (const std::vector<Box2>& level : outline.levels) nodes += level.size();
  const auto counted = [](std::size_t count, const std::string& one) {
    return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
  };
  outline.caption = counted(nodes, "node") + " on " + counted(outline.levels.size(), "level") + ", " +
                    (leaves == 1 ? "1 of them a leaf" : std::to_string(leaves) + " of them leaves");
  return outline;
}

}  // namespace

Algorithm quadtree() {
  std::vector<Tunable> tunables = {{
      .name = "capacity",
      .summary = "boxes that a leaf holds before it splits; more where all share a point, or where the "
                 "leaves would come to hold 16 references a box",
      .default_value = "8",
      .type = Tunable::Type::integer,
      .min = 1,
      .max = 1'000'000,
  }};
  for (Tunable& tunable : world_tunables()) tunables.push_back(std::move(tunable));
  tunables.push_back(
      {.name = "update",
       .summary = "how a tracker mends its tree before it traverses it: built anew; all nodes "
                  "searched for each mover, which is then inserted from the root; leaves known, and "
                  "movers inserted from the root, or from the least node above their leaf that holds "
                  "them; or references carried across sides of leaves to siblings, and also to "
                  "cousins",
       .default_value = "rebuild",
       .type = Tunable::Type::choice,
       .choices = {"rebuild", "search_delete_reinsert", "root", "relative", "siblings", "cousins"}});
  tunables.push_back(detect_tunable());
  return {
      .name = "paper_quadtree",
      .summary = "a quadtree with brute force in each leaf, as the paper lists it, mended; 2D only",
      .source = "paper.md, sections V (Algorithms 7 to 10) and VI-D",
      .kind = AlgorithmKind::paper,
      .tunables = std::move(tunables),
      .in_2d = {.searcher = make_strategy<Quadtree>,
                .followers = {{.name = "paper_quadtree", .make = make_quadtree_follower}},
                .outline = quadtree_outline},
  };
}

}  // namespace broadside::paper
