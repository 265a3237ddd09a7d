// Algorithms 1 to 10 of paper.md exactly as printed; the header explains how to read them.
#include "paper/listings/printed.hpp"

#include <cmath>
#include <string>

namespace broadside::paper::printed {
namespace {

constexpr std::size_t max_steps = 1'000'000;
constexpr std::size_t max_depth = 100;

/// Whether "for i = 0 to n" has an iteration for i.
bool in_range(std::size_t i, double n, To to) {
  const auto at = static_cast<double>(i);
  return to == To::including ? at <= n : at < n;
}

bool in_range(std::size_t i, const Collection& e, To to) {
  return in_range(i, static_cast<double>(e.size()), to);
}

/// e[i], checked.
template <typename Sequence>
auto& at(Sequence& e, std::size_t i, const char* where) {
  if (i >= e.size())
    throw std::out_of_range(std::string(where) + " reads index " + std::to_string(i) +
                            "; expected less than " + std::to_string(e.size()));
  return e[i];
}

}  // namespace

void algorithm_1_brute_force(const Collection& e, To to, const TestCollide& test_collide) {
  for (std::size_t i = 0; in_range(i, e, to); ++i) {
    for (std::size_t j = i; in_range(j, e, to); ++j) {
      test_collide(at(e, i, "Algorithm 1, line 4"), at(e, j, "Algorithm 1, line 4"));
    }
  }
}

Grid algorithm_2_init(double width, double height, double size, std::size_t x, std::size_t y) {
  Grid grid{};
  grid.size = size;
  grid.x_grids = std::ceil(width / size);
  grid.y_grids = std::ceil(height / size);
  grid.g.assign(x, std::vector<Collection>(y));
  return grid;
}

void algorithm_3_spanning_add_element(const Collection& e, To to, float step, Grid& grid) {
  const auto size = static_cast<float>(grid.size);
  const auto before_end = [to](float value, float end) {
    return to == To::including ? value <= end : value < end;
  };
  std::size_t steps = 0;
  for (std::size_t i = 0; in_range(i, e, to); ++i) {
    const Object& object = at(e, i, "Algorithm 3, line 3");
    for (float y = object.box.min[1]; before_end(y, object.box.max[1] + size); y += step) {
      for (float x = object.box.min[0]; before_end(x, object.box.max[0] + size); x += step) {
        if (++steps > max_steps)
          throw NeverEnds("Algorithm 3 has taken " + std::to_string(max_steps) +
                          " steps; expected it to end");
        const double row = double{y} / grid.size;
        const double col = double{x} / grid.size;
        if (row < grid.y_grids && col < grid.x_grids) {
          const auto columns = static_cast<double>(grid.g.size());
          const double rows = grid.g.empty() ? 0 : static_cast<double>(grid.g.front().size());
          const bool cell_exists = x > -1 && x < columns && y > -1 && y < rows;
          if (cell_exists) grid.g[static_cast<std::size_t>(x)][static_cast<std::size_t>(y)].push_back(object);
          grid.filings.push_back({object.id, x, y, row, col, cell_exists});
        }
      }
    }
  }
}

void algorithm_4_spi(const Grid& grid, To to, const TestCollide& test_collide) {
  for (std::size_t i = 0; in_range(i, grid.x_grids, to); ++i) {
    for (std::size_t j = 0; in_range(j, grid.y_grids, to); ++j) {
      const std::vector<Collection>& column = at(grid.g, i, "Algorithm 4, line 4");
      algorithm_1_brute_force(at(column, j, "Algorithm 4, line 4"), To::excluding, test_collide);
    }
  }
}

void algorithm_5_sweep(const Collection& e, Collection& f, To to, const TestCollide& test_collide) {
  for (std::size_t i = 0; in_range(i, e, to); ++i) {
    algorithm_6_prune(f, at(e, i, "Algorithm 5, line 3"), To::excluding);
    f.push_back(e[i]);
    algorithm_1_brute_force(f, To::excluding, test_collide);
  }
}

void algorithm_6_prune(Collection& f, const Object& e, To to) {
  for (std::size_t i = 0; in_range(i, f, to); ++i) {
    if (at(f, i, "Algorithm 6, line 3").box.max[0] < e.box.min[0]) {
      f.erase(f.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
}

void algorithm_7_add_element(QuadTreeNode& node, const Object& e) {
  if (node.qi != nullptr) {
    algorithm_9_spanning_add_element(node, e);
  } else {
    node.e.push_back(e);
    if (node.count + 1 > node.count_max) {
      algorithm_8_split(node, To::excluding);
      node.count = 0;
    } else {
      node.count = node.count + 1;
    }
  }
}

void algorithm_8_split(QuadTreeNode& node, To to) {
  if (node.depth == max_depth)
    throw NeverEnds("Algorithm 8 splits a node at depth " + std::to_string(max_depth) +
                    "; expected it to end");
  const auto new_quad_tree_node = [&node](double x_origin, double y_origin) {
    return std::make_unique<QuadTreeNode>(QuadTreeNode{x_origin, y_origin, node.count_max, node.depth + 1});
  };
  const double x_origin = node.x_origin;
  const double y_origin = node.y_origin;
  node.qi = new_quad_tree_node(x_origin + x_origin * 0.5, y_origin - y_origin * 0.5);
  node.qii = new_quad_tree_node(x_origin - x_origin * 0.5, y_origin - y_origin * 0.5);
  node.qiii = new_quad_tree_node(x_origin - x_origin * 0.5, y_origin + y_origin * 0.5);
  node.qiv = new_quad_tree_node(x_origin + x_origin * 0.5, y_origin + y_origin * 0.5);
  for (std::size_t i = 0; in_range(i, node.e, to); ++i) {
    algorithm_9_spanning_add_element(node, at(node.e, i, "Algorithm 8, line 7"));
  }
}

void algorithm_9_spanning_add_element(QuadTreeNode& node, const Object& e) {
  if (e.box.max[0] > node.x_origin && e.box.min[1] < node.y_origin) {
    algorithm_7_add_element(*node.qi, e);
  }
  if (e.box.min[0] < node.x_origin && e.box.min[1] < node.y_origin) {
    algorithm_7_add_element(*node.qii, e);
  }
  if (e.box.min[0] < node.x_origin && e.box.max[1] > node.y_origin) {
    algorithm_7_add_element(*node.qiii, e);
  }
  if (e.box.max[0] > node.x_origin && e.box.max[1] > node.y_origin) {
    algorithm_7_add_element(*node.qiv, e);
  }
}

void algorithm_10_traverse(const QuadTreeNode& q, const TestCollide& test_collide) {
  if (q.qi != nullptr) {
    algorithm_10_traverse(*q.qi, test_collide);
  }
  if (q.qii != nullptr) {
    algorithm_10_traverse(*q.qii, test_collide);
  }
  if (q.qiii != nullptr) {
    algorithm_10_traverse(*q.qiii, test_collide);
  }
  if (q.qiv != nullptr) {
    algorithm_10_traverse(*q.qiv, test_collide);
  }
  algorithm_1_brute_force(q.e, To::excluding, test_collide);
}

bool section_vi_b_changes_cell(double position, double change, double size) {
  return change > std::fmod(position, size);
}

}  // namespace broadside::paper::printed
