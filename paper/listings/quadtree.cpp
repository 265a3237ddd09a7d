// The quadtree as section V of paper.md has it: Algorithms 7 to 10. What was mended, and why, is in
// docs/paper/errata.md.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "broadside/broad_phase.hpp"
#include "broadside/outline.hpp"

#include "paper/listings/algorithm_1.hpp"
#include "paper/listings/descriptions.hpp"
#include "paper/listings/world.hpp"

namespace broadside::paper {
namespace {

/// No tree is deeper: by then a node is 2^-48 of the world, below what a float can tell apart but near zero.
constexpr int max_depth = 48;

/// The references a box that the leaves may hold on average.
constexpr double max_references_a_box = 16;

/// What all nodes of a tree share.
struct Tree {
  std::span<const Box2> boxes;
  std::size_t count_max;
  int depth_max;
};

/// The points for which begin <= x < end on both axes; +inf lies in what ends at +inf.
struct Region {
  std::array<double, 2> begin;
  std::array<double, 2> end;

  bool holds(double x, double y) const {
    return begin[0] <= x && (x < end[0] || std::isinf(end[0])) && begin[1] <= y &&
           (y < end[1] || std::isinf(end[1]));
  }
};

class QuadTreeNode {
 public:
  QuadTreeNode(const Tree& tree, int depth, const Region& region, double x_origin, double y_origin,
               double half_width, double half_height)
      : tree_(&tree),
        depth_(depth),
        region_(region),
        x_origin_(x_origin),
        y_origin_(y_origin),
        half_width_(half_width),
        half_height_(half_height) {}

  /// Algorithm 7, "Add Element".
  void algorithm_7_add_element(BoxId e) {
    if (qi_ != nullptr) {  // Erratum 7a
      algorithm_9_spanning_add_element(e);
    } else {
      e_.push_back(e);
      if (count_ + 1 > tree_->count_max && can_split()) {  // Errata 7b and 7c
        algorithm_8_split();
        count_ = 0;
      } else {
        count_ = count_ + 1;
      }
    }
  }

  /// Algorithm 10, "Traverse". Calls test_collide(region, a, b) for the pairs of each leaf.
  template <typename TestCollide>
  void algorithm_10_traverse(TestCollide& test_collide) const {
    if (qi_ != nullptr) qi_->algorithm_10_traverse(test_collide);      // Erratum 10c
    if (qii_ != nullptr) qii_->algorithm_10_traverse(test_collide);    // Erratum 10c
    if (qiii_ != nullptr) qiii_->algorithm_10_traverse(test_collide);  // Erratum 10c
    if (qiv_ != nullptr) qiv_->algorithm_10_traverse(test_collide);    // Erratum 10c
    algorithm_1_brute_force(e_, [&](BoxId a, BoxId b) { test_collide(region_, a, b); });
  }

  /// Appends the node's region and those below it to the levels. Returns how many of them are leaves.
  std::size_t lay_out(std::vector<std::vector<Box2>>& levels) const {
    const auto depth = static_cast<std::size_t>(depth_);
    levels.resize(std::max(levels.size(), depth + 1));
    Box2 box;
    for (int axis = 0; axis < 2; ++axis) {
      box.min[axis] = static_cast<float>(region_.begin[axis]);
      box.max[axis] = static_cast<float>(region_.end[axis]);
    }
    levels[depth].push_back(box);
    if (qi_ == nullptr) return 1;
    return qi_->lay_out(levels) + qii_->lay_out(levels) + qiii_->lay_out(levels) + qiv_->lay_out(levels);
  }

  /// The entries in this node's leaves.
  std::size_t references() const {
    if (qi_ == nullptr) return e_.size();
    return qi_->references() + qii_->references() + qiii_->references() + qiv_->references();
  }

 private:
  /// Algorithm 8, "Split".
  void algorithm_8_split() {
    qi_ = child(1, -1);                            // Erratum 8a
    qii_ = child(-1, -1);                          // Erratum 8a
    qiii_ = child(-1, 1);                          // Erratum 8a
    qiv_ = child(1, 1);                            // Erratum 8a
    for (std::size_t i = 0; i < e_.size(); ++i) {  // Erratum 8c
      algorithm_9_spanning_add_element(e_[i]);
    }
    e_ = {};  // Erratum 8b
  }

  /// Algorithm 9, "Spanning Add Element".
  void algorithm_9_spanning_add_element(BoxId id) {
    const Box2& e = tree_->boxes[index(id)];
    if (e.max[0] >= x_origin_ && e.min[1] < y_origin_) {  // Errata 9a and 9b
      qi_->algorithm_7_add_element(id);
    }
    if (e.min[0] < x_origin_ && e.min[1] < y_origin_) {
      qii_->algorithm_7_add_element(id);
    }
    if (e.min[0] < x_origin_ && e.max[1] >= y_origin_) {  // Errata 9a and 9b
      qiii_->algorithm_7_add_element(id);
    }
    if (e.max[0] >= x_origin_ && e.max[1] >= y_origin_) {  // Errata 9a and 9b
      qiv_->algorithm_7_add_element(id);
    }
  }

  /// The new subnode on the given side (-1 or 1) of each axis.
  std::unique_ptr<QuadTreeNode> child(int x_side, int y_side) const {
    Region region = region_;
    (x_side < 0 ? region.end : region.begin)[0] = x_origin_;
    (y_side < 0 ? region.end : region.begin)[1] = y_origin_;
    const double half_width = half_width_ * 0.5;
    const double half_height = half_height_ * 0.5;
    return std::make_unique<QuadTreeNode>(*tree_, depth_ + 1, region, x_origin_ + x_side * half_width,
                                          y_origin_ + y_side * half_height, half_width, half_height);
  }

  /// Whether subnodes may help. They cannot where all boxes share a point: some subnode gets every one of
  /// them, and no test is spared since every test finds a pair.
  bool can_split() const {
    if (depth_ == tree_->depth_max) return false;
    Box2 common = tree_->boxes[index(e_.front())];
    for (const BoxId id : e_) {
      const Box2& e = tree_->boxes[index(id)];
      for (int axis = 0; axis < 2; ++axis) {
        common.min[axis] = std::max(common.min[axis], e.min[axis]);
        common.max[axis] = std::min(common.max[axis], e.max[axis]);
      }
    }
    return !is_present(common);
  }

  const Tree* tree_;
  int depth_;
  Region region_;
  double x_origin_;
  double y_origin_;
  double half_width_;
  double half_height_;
  std::size_t count_ = 0;
  std::vector<BoxId> e_;
  std::unique_ptr<QuadTreeNode> qi_;
  std::unique_ptr<QuadTreeNode> qii_;
  std::unique_ptr<QuadTreeNode> qiii_;
  std::unique_ptr<QuadTreeNode> qiv_;
};

/// The entries that leaves hold in all if every node down to `depth` is split; no tree of that depth has
/// more.
double references_at(int depth, std::span<const Box2> boxes, const World& world) {
  const double nodes = std::ldexp(1.0, depth);
  const auto spanned = [nodes](const Box2& box, int axis, double begin, double length) {
    const auto node = [&](double x) {
      return std::clamp<double>(std::floor((x - begin) / length * nodes), 0, nodes - 1);
    };
    return node(box.max[axis]) - node(box.min[axis]) + 1;
  };
  double references = 0;
  for (const Box2& box : boxes)
    references += spanned(box, 0, world.left, world.width) * spanned(box, 1, world.top, world.height);
  return references;
}

/// The greatest depth at which the leaves cannot hold too many entries, whatever the order of filing.
int choose_depth(std::span<const Box2> boxes, const World& world) {
  int fits = 0;
  int beyond = max_depth + 1;
  while (beyond - fits > 1) {
    const int depth = (fits + beyond) / 2;
    const bool few =
        references_at(depth, boxes, world) <= max_references_a_box * static_cast<double>(boxes.size());
    (few ? fits : beyond) = depth;
  }
  return fits;
}

class Quadtree final : public PairFinder<2>, public Outlined<2> {
 public:
  explicit Quadtree(const Settings& settings)
      : world_settings_(settings), capacity_(static_cast<std::size_t>(settings.integer("capacity"))) {}

 private:
  /// The root of a tree over the boxes.
  static QuadTreeNode fill(const Tree& tree, const World& world) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const double half_width = world.width * 0.5;
    const double half_height = world.height * 0.5;
    QuadTreeNode root(tree, 0, {{-infinity, -infinity}, {infinity, infinity}}, world.left + half_width,
                      world.top + half_height, half_width, half_height);
    for (std::size_t i = 0; i < tree.boxes.size(); ++i) root.algorithm_7_add_element(BoxId(i));
    return root;
  }

  Outline<2> lay_out(std::span<const Box2> boxes) override {
    const World world = world_settings_.around(boxes);
    const Tree tree{boxes, capacity_, choose_depth(boxes, world)};
    Outline<2> outline;
    outline.kind = "nodes";
    const std::size_t leaves = fill(tree, world).lay_out(outline.levels);
    std::size_t nodes = 0;
    for (const std::vector<Box2>& level : outline.levels) nodes += level.size();
    const auto counted = [](std::size_t count, const std::string& one) {
      return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
    };
    outline.caption = counted(nodes, "node") + " on " + counted(outline.levels.size(), "level") + ", " +
                      (leaves == 1 ? "1 of them a leaf" : std::to_string(leaves) + " of them leaves");
    return outline;
  }

  void find_valid(std::span<const Box2> boxes, PairSink& pairs) override {
    const World world = world_settings_.around(boxes);
    const Tree tree{boxes, capacity_, choose_depth(boxes, world)};
    const QuadTreeNode root = fill(tree, world);

    Statistics statistics{.references = root.references()};
    auto test_collide = [&](const Region& leaf, BoxId a, BoxId b) {
      ++statistics.tests;
      const Box2& first = boxes[index(a)];
      const Box2& second = boxes[index(b)];
      if (!overlap(first, second)) return;
      const bool here =
          leaf.holds(std::max(first.min[0], second.min[0]), std::max(first.min[1], second.min[1]));
      if (here) pairs.add(a, b);  // Erratum 10a
    };
    root.algorithm_10_traverse(test_collide);
    this->count(statistics);
  }

  WorldSettings world_settings_;
  std::size_t capacity_;
};

}  // namespace

Algorithm quadtree() {
  std::vector<Tunable> tunables = {{
      .name = "capacity",
      .summary = "boxes that a leaf holds before it splits; more where all share a point, or where the "
                 "leaves would come to hold 16 references a box",
      .standard = "8",
      .type = Tunable::Type::integer,
      .least = 1,
      .most = 1'000'000,
  }};
  for (Tunable& tunable : world_tunables()) tunables.push_back(std::move(tunable));
  return {
      .name = "paper_quadtree",
      .summary = "a quadtree with brute force in each leaf, as the paper lists it, mended; 2D only",
      .source = "paper.md, section V, Algorithms 7 to 10",
      .kind = AlgorithmKind::paper,
      .tunables = std::move(tunables),
      .finder_2d = [](const Settings& settings) { return std::make_unique<Quadtree>(settings); },
  };
}

}  // namespace broadside::paper
