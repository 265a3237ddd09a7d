// Algorithms 1 to 10 of paper.md exactly as printed, faults included: the errata's tests show where they go
// wrong. Nothing here is registered; the corrected listings are in the files beside this one.
//
// Where the print cannot run or is silent, this takes the most literal reading and makes it safe: an index
// out of range and an endless listing throw, and whatever a listing leaves open is a parameter. Each such
// place has a comment here and a number in docs/paper/errata.md.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <stdexcept>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

namespace broadside::paper::printed {

/// The paper's object or element: a box, and a number that identifies it in tests.
struct Object {
  BoxId id;
  Box2 box;
};

using Collection = std::vector<Object>;

/// The listings' TEST COLLIDE, which the paper leaves to the reader. Called for every test, including
/// repetitions and an object with itself.
using TestCollide = std::function<void(const Object&, const Object&)>;

/// How to read "for i = 0 to n": including n, as printed, or excluding n, as a collection indexed from 0
/// needs it (errata 1a, 3a, 4a, 5a, 6a and 8c). Including n, each listing reads past an end and throws
/// std::out_of_range. The choice applies to the called listing; listings that it calls exclude n, so that
/// each shows only its own faults.
enum class To { including, excluding };

/// Thrown where a listing would not terminate.
class NeverEnds : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Algorithm 1, "Brute Force".
void algorithm_1_brute_force(const Collection& e, To to, const TestCollide& test_collide);

/// One G[x][y].Add(E[i]) of Algorithm 3.
struct Filing {
  BoxId id;
  double x, y;      ///< the coordinates that the listing uses as indices
  double row, col;  ///< computed but not used by the listing
  bool cell_exists;
};

/// The variables that Algorithms 2 to 4 share.
struct Grid {
  double size;
  double x_grids;
  double y_grids;
  std::vector<std::vector<Collection>> g;
  std::vector<Filing> filings;  ///< not in the print: records line 8 of Algorithm 3
};

/// Algorithm 2, "Initialize". `x` and `y` are parameters, because the print gives them no value (erratum 2a).
Grid algorithm_2_init(double width, double height, double size, std::size_t x, std::size_t y);

/// Algorithm 3, "Spanning Add Element" of the grid. `step` is the increment of x and y, which the print does
/// not give (erratum 3b). A real index is truncated; an index without a cell is recorded as a filing, but
/// stored nowhere. Throws NeverEnds after a million steps (erratum 3d).
void algorithm_3_spanning_add_element(const Collection& e, To to, float step, Grid& grid);

/// Algorithm 4, "SPI". Its xGrid and yGrid are read as Algorithm 2's xGrids and yGrids (erratum 4c).
void algorithm_4_spi(const Grid& grid, To to, const TestCollide& test_collide);

/// Algorithm 5, "Sweep". `f` is a parameter, because the print neither declares nor empties it (erratum 5d).
void algorithm_5_sweep(const Collection& e, Collection& f, To to, const TestCollide& test_collide);

/// Algorithm 6, "Prune". F.length is read anew in each iteration, and F.REMOVE closes the gap.
void algorithm_6_prune(Collection& f, const Object& e, To to);

/// The variables that Algorithms 7 to 10 share. The print does not give their initial values: E empty, Count
/// 0, no subnodes, and Count Max as in the parent.
struct QuadTreeNode {
  double x_origin;
  double y_origin;
  std::size_t count_max;
  std::size_t depth = 0;  ///< not in the print: detects NeverEnds

  Collection e{};
  std::size_t count = 0;
  std::unique_ptr<QuadTreeNode> qi{};
  std::unique_ptr<QuadTreeNode> qii{};
  std::unique_ptr<QuadTreeNode> qiii{};
  std::unique_ptr<QuadTreeNode> qiv{};
};

/// Algorithm 7, "Add Element". Its Quadrant is read as QI (erratum 7a). Throws NeverEnds if the tree is a
/// hundred nodes deep (errata 7b and 8a).
void algorithm_7_add_element(QuadTreeNode& node, const Object& e);

/// Algorithm 8, "Split".
void algorithm_8_split(QuadTreeNode& node, To to);

/// Algorithm 9, "Spanning Add Element" of the quadtree.
void algorithm_9_spanning_add_element(QuadTreeNode& node, const Object& e);

/// Algorithm 10, "Traverse". Its QI to QIV and E are read as q's, and its TraverseTree as itself (erratum
/// 10c).
void algorithm_10_traverse(const QuadTreeNode& q, const TestCollide& test_collide);

/// Section VI-B in words: whether the references of an object at `position` that moves by `change` go to
/// another cell, "if the change in position is greater than the offset".
bool section_vi_b_changes_cell(double position, double change, double size);

}  // namespace broadside::paper::printed
