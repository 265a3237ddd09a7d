// docs/paper/errata.md on Algorithms 7 to 10: each printed listing goes wrong on its input, the mended one
// does not.
#include <string>

#include "paper_errata.hpp"

namespace broadside::paper {
namespace {

using enum printed::To;
using printed::QuadTreeNode;

/// The world from (0, 0) to (100, 100), around whose centre the printed root is right, with the boxes in it.
QuadTreeNode tree_of(const std::vector<Box2>& boxes, std::size_t count_max) {
  QuadTreeNode root{50, 50, count_max};
  for (const printed::Object& object : objects(boxes)) printed::algorithm_7_add_element(root, object);
  return root;
}

Record traverse(const QuadTreeNode& root) {
  Record record;
  printed::algorithm_10_traverse(root, record.sink());
  return record;
}

/// The entries in the leaves.
std::size_t references(const QuadTreeNode& node) {
  if (node.qi == nullptr) return node.e.size();
  return references(*node.qi) + references(*node.qii) + references(*node.qiii) + references(*node.qiv);
}

std::string in_that_world(const std::string& capacity) {
  return "paper_quadtree:left=0:top=0:width=100:height=100:capacity=" + capacity;
}

TEST(Erratum7b, MoreCoincidentBoxesThanALeafHoldsNeverEnd) {
  const std::vector<Box2> boxes(3, box(10, 10, 20, 20));
  EXPECT_THROW(tree_of(boxes, 2), printed::NeverEnds);
  EXPECT_EQ(expect_right(in_that_world("2"), boxes).references, 3U);
}

TEST(Erratum7b, MoreBoxesAroundOnePointThanALeafHoldsNeverEnd) {
  const std::vector<Box2> boxes = {box(10, 10, 20, 20), box(11, 11, 21, 21), box(12, 12, 22, 22)};
  EXPECT_THROW(tree_of(boxes, 2), printed::NeverEnds);
  EXPECT_EQ(expect_right(in_that_world("2"), boxes).references, 3U);
}

TEST(Erratum7c, LongBoxesFillTheTree) {
  std::vector<Box2> boxes;
  for (int i = 0; i < 20; ++i) {
    const float y = 5 * static_cast<float>(i) + 2.5F;
    boxes.push_back(box(0, y, 100, y));
  }
  EXPECT_EQ(references(tree_of(boxes, 1)), 165'866U);
  EXPECT_EQ(expect_right(in_that_world("1"), boxes).references, 320U);
}

TEST(Erratum8a, SubnodesOfSubnodesAreCentredOutsideTheWorld) {
  QuadTreeNode root{50, 50, 1};
  printed::algorithm_8_split(root, excluding);
  EXPECT_EQ(root.qi->x_origin, 75);
  EXPECT_EQ(root.qi->y_origin, 25);
  printed::algorithm_8_split(*root.qi, excluding);
  EXPECT_EQ(root.qi->qi->x_origin, 112.5) << "expected 87.5";
}

TEST(Erratum8a, AWorldAroundZeroIsNeverDivided) {
  const std::vector<Box2> boxes = {box(1, 1, 2, 2), box(5, 5, 6, 6)};
  QuadTreeNode root{0, 0, 1};
  printed::algorithm_7_add_element(root, objects(boxes)[0]);
  EXPECT_THROW(printed::algorithm_7_add_element(root, objects(boxes)[1]), printed::NeverEnds);
  const Statistics statistics =
      expect_right("paper_quadtree:left=-10:top=-10:width=20:height=20:capacity=1", boxes);
  EXPECT_EQ(statistics.tests, 0U);
}

TEST(Erratum8b, ASplitNodeKeepsItsElements) {
  const std::vector<Box2> boxes = {box(10, 10, 20, 20), box(80, 80, 90, 90)};
  const QuadTreeNode root = tree_of(boxes, 1);
  EXPECT_NE(root.qi, nullptr);
  EXPECT_EQ(root.e.size(), 2U);
  EXPECT_EQ(references(root), 2U);
  EXPECT_EQ(expect_right(in_that_world("1"), boxes).tests, 0U);
}

TEST(Erratum8c, TheLoopToTheLengthReadsPastTheEnd) {
  const std::vector<Box2> boxes = {box(10, 10, 20, 20), box(80, 80, 90, 90)};
  QuadTreeNode root{50, 50, 2};
  root.e = objects(boxes);
  expect_past_the_end("Algorithm 8", [&] { printed::algorithm_8_split(root, including); });
  expect_right(in_that_world("1"), boxes);
}

// In what follows the first boxes split the root, so that the others are in its subnodes alone.

TEST(Erratum9a, TouchingBoxesThatABorderSeparatesAreLost) {
  const std::vector<Box2> boxes = {box(10, 80, 20, 90), box(80, 80, 90, 90), box(40, 10, 50, 20),
                                   box(50, 10, 60, 20)};
  EXPECT_EQ(traverse(tree_of(boxes, 1)).times(2, 3), 0U);
  expect_right(in_that_world("1"), boxes);
}

TEST(Erratum9b, ABoxWithoutExtentOnABorderIsInNoSubnode) {
  const std::vector<Box2> boxes = {box(10, 80, 20, 90), box(80, 80, 90, 90), box(50, 10, 50, 20),
                                   box(45, 10, 55, 20)};
  const Record record = traverse(tree_of(boxes, 1));
  EXPECT_EQ(record.times(2, 2), 0U) << "in no leaf, or it would be tested with itself";
  EXPECT_EQ(record.times(2, 3), 0U);
  expect_right(in_that_world("1"), boxes);
}

TEST(Erratum10a, APairIsTestedInEachLeafThatItShares) {
  const std::vector<Box2> boxes = {box(10, 80, 20, 90), box(60, 80, 70, 90), box(80, 80, 90, 90),
                                   box(45, 10, 55, 20), box(46, 10, 56, 20)};
  EXPECT_EQ(traverse(tree_of(boxes, 2)).times(3, 4), 2U);
  expect_right(in_that_world("2"), boxes);
}

TEST(Erratum10b, BruteForceRunsAtInnerNodesToo) {
  const std::vector<Box2> boxes = {box(10, 10, 20, 20), box(15, 15, 25, 25), box(80, 80, 90, 90)};
  const Record record = traverse(tree_of(boxes, 2));
  EXPECT_EQ(record.times(0, 1), 2U) << "in their leaf and at the root";
  EXPECT_EQ(record.times(0, 2), 1U) << "they share no leaf";
  EXPECT_EQ(expect_right(in_that_world("2"), boxes).tests, 1U);
}

TEST(ErratumT16, SubnodesLieInTheDiagonals) {
  printed::QuadTreeNode root{.x_origin = 50, .y_origin = 50, .count_max = 1};
  printed::algorithm_8_split(root, printed::To::excluding);
  const auto off = [&](const printed::QuadTreeNode& node) {
    return std::pair(node.x_origin - root.x_origin, node.y_origin - root.y_origin);
  };
  EXPECT_EQ(off(*root.qi), std::pair(25.0, -25.0));
  EXPECT_EQ(off(*root.qii), std::pair(-25.0, -25.0));
  EXPECT_EQ(off(*root.qiii), std::pair(-25.0, 25.0));
  EXPECT_EQ(off(*root.qiv), std::pair(25.0, 25.0));
}

}  // namespace
}  // namespace broadside::paper
