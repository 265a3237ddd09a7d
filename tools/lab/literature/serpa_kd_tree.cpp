// Serpa and Rodrigues 2019, "Flexible Use of Temporal and Spatial Reasoning for Fast and Scalable CPU
// Broad-Phase Collision Detection Using KD-Trees" (Computer Graphics Forum), as in their framework Broadmark:
// a KD-tree whose nodes hold the boxes that touch their planes (kd_tree.hpp). Planes are at the mean of the
// boxes' centres, on the axis of maximum variance. The tree is kept from frame to frame: boxes move to the
// nodes where they now belong, leaves split, nodes that have become small are trimmed, and a measure of each
// node decides when to translate its plane and when to give it up. Each node's boxes are swept along their
// widest axis, against each other and against those from the nodes above, eight at a time. Pairs of two
// resting boxes are neither searched for nor tested again.
//
// Differences: a moving box goes directly from its node to the new one, where their code passes over all
// boxes in each frame. Nodes have their own lists instead of parts of one array. A plane that is given up is
// chosen anew with all below it, where their code keeps the larger child's planes. A node is not split if one
// side would be empty. Boxes are not enlarged by a margin, because all pairs must be exact.
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lab/literature/kd_tree.hpp"
#include "lab/literature/literature.hpp"
#include "lab/peers/peer_follower.hpp"

namespace broadside::lab::literature {
namespace {

template <int D>
void add_present(KdTree<D>& tree, std::span<const Box<D>> boxes) {
  tree.clear(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (is_present(boxes[i])) tree.add(static_cast<std::uint32_t>(i));
  }
  tree.refine(boxes);
}

std::size_t leaf_boxes(const Settings& settings) {
  return static_cast<std::size_t>(settings.integer("leaf"));
}

template <int D>
class SerpaKdTree final : public Searcher<D> {
 public:
  explicit SerpaKdTree(const Settings& settings) : tree_(leaf_boxes(settings)) {}

  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) override {
    add_present(tree_, input.boxes);
    // Flags the boxes of the left set.
    is_left_.assign(input.left_count, 1);
    if (!is_left_.empty()) is_left_.resize(input.boxes.size());
    Checkpoint checkpoint(input.workers.checkpoint);
    tree_.search(input.boxes, is_left_, !is_left_.empty(), checkpoint, pairs);
    return std::nullopt;
  }

 private:
  KdTree<D> tree_;
  std::vector<std::uint8_t> is_left_;
};

template <int D>
class SerpaKdFollower final : public peers::PeerFollower<D> {
 public:
  explicit SerpaKdFollower(const Settings& settings) : tree_(leaf_boxes(settings)) {}

 private:
  void build(std::span<const Box<D>> boxes, std::span<const Box<D>>) override { add_present(tree_, boxes); }

  void move(const Change<D>& change) override {
    tree_.resize(change.now.size());
    for (const BoxId id : change.changed) {
      const Box<D>& now = change.now[index(id)];
      const bool was = is_present(change.before[index(id)]);
      if (!is_present(now)) {
        if (was) tree_.remove(index(id));
      } else if (was) {
        tree_.move(index(id), now);
      } else {
        tree_.add(index(id));
      }
    }
    tree_.refine(change.now);
  }

  void collide(const Change<D>& change, PairSink& pairs) override {
    Checkpoint checkpoint(change.workers.checkpoint);
    tree_.search(change.now, change.flags, false, checkpoint, pairs);
  }

  KdTree<D> tree_;
};

}  // namespace

Algorithm serpa_kd_tree() {
  return {
      .name = "serpa_kd_tree",
      .summary = "a KD-tree with each box in the lowest node whose planes it does not touch; kept in motion",
      .source = "Serpa and Rodrigues 2019, Flexible Use of Temporal and Spatial Reasoning",
      .kind = AlgorithmKind::literature,
      .tunables = {{.name = "leaf",
                    .summary = "boxes, beyond which a leaf is split",
                    .default_value = "512",
                    .type = Tunable::Type::integer,
                    .min = 1,
                    .max = 1e9}},
      .in_2d = {.searcher = make_strategy<SerpaKdTree<2>>,
                .followers = {{.name = "KD-tree", .make = make_strategy<SerpaKdFollower<2>>}}},
      .in_3d = {.searcher = make_strategy<SerpaKdTree<3>>,
                .followers = {{.name = "KD-tree", .make = make_strategy<SerpaKdFollower<3>>}}},
  };
}

}  // namespace broadside::lab::literature
