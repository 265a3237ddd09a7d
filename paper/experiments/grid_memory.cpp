// Section III: a grid's cells are as many as the world is large, unless they are hashed or have levels.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "lab/numbers.hpp"
#include "paper/experiments/descriptions.hpp"
#include "paper/experiments/laboratory.hpp"
#include "paper/experiments/table.hpp"

namespace broadside::lab {
namespace {

constexpr std::size_t boxes_in_world = 2'000;

/// A box is about 1 in size.
constexpr double cell_size = 2;

/// The cells that the paper's grid of this cell size may have (erratum 2c); beyond, its cells grow.
constexpr double most_cells = 1 << 16;

struct MeasuredGrid {
  int dimension;
  std::string spec;
  std::string label;
};

const std::vector<MeasuredGrid>& measured_grids() {
  static const std::vector<MeasuredGrid> list = {{2, "paper_grid:cell=2", "paper_grid:cell=2"},
                                                 {2, "paper_grid", "paper_grid"},
                                                 {2, "grid:cell=2", "grid:cell=2"},
                                                 {2, "grid", "grid"},

                                                 {3, "grid", "grid in 3D"}};
  return list;
}

template <int D>
std::vector<Box<D>> boxes_of(const std::string& scene) {
  return history_of<D>(scene, {.boxes = boxes_in_world}).boxes;
}

/// The cells of a matrix over the world of the boxes.
template <int D>
double cells_in_matrix(const std::vector<Box<D>>& boxes) {
  const Box<D> world = bounds_of<D>(boxes);
  double cells = 1;
  for (int axis = 0; axis < D; ++axis)
    cells *= std::ceil((double{world.max[axis]} - double{world.min[axis]}) / cell_size);
  return cells;
}

/// How many cells hold a box: what a hash of cells keeps.
double cells_in_use(const std::vector<Box2>& boxes) {
  std::set<std::pair<double, double>> cells;
  for (const Box2& box : boxes) {
    for (double x = std::floor(box.min[0] / cell_size); x <= box.max[0] / cell_size; ++x) {
      for (double y = std::floor(box.min[1] / cell_size); y <= box.max[1] / cell_size; ++y)
        cells.emplace(x, y);
    }
  }
  return static_cast<double>(cells.size());
}

/// Adds what the grids of this dimension hold and test, in a world this many cells wide.
void measure_grids(const Laboratory& laboratory, const std::string& scene, int dimension, double world,
                   Table& table) {
  std::vector<std::string> specs;
  for (const MeasuredGrid& grid : measured_grids()) {
    if (grid.dimension == dimension) specs.push_back(grid.spec);
  }
  const CaseResult result =
      laboratory.measure(list_of(specs), {.scene = scene, .dimension = dimension, .boxes = boxes_in_world});
  for (const MeasuredGrid& grid : measured_grids()) {
    if (grid.dimension != dimension) continue;
    const Measurement& measured = measurement_of(result, grid.spec);
    const Cell tests = over(tests_cell(measured), boxes_in_world);
    table.add({world, grid.label, bytes_cell(measured), tests, time_cell(measured)});
  }
}

std::vector<Table> measure(const Laboratory& laboratory) {
  const std::string x = "world over cell";
  Table cells{.name = "cells",
              .title = "Cells of 2 x 2 for 2,000 boxes of about 1 x 1 in ever larger worlds",
              .columns = {{x}, {"kept"}, {"cells"}},
              .charts = {log_log_chart("Cells over the side of the world", x, "cells", "kept")}};
  Table grids{.name = "grids",
              .title = "What grids hold, test and take for 2,000 boxes in ever larger worlds",
              .columns = {{x}, {"grid"}, {"memory", "bytes"}, {"tests a box"}, {"time", "ms"}},
              .charts = {log_log_chart("Memory over the side of the world", x, "memory", "grid"),
                         log_log_chart("Tests a box over the side of the world", x, "tests a box", "grid")}};
  // Up to worlds in which a float still tells a box's sides apart.
  for (double spread = 0.16; spread > 2e-5; spread /= laboratory.either(2, 4)) {
    const std::string scene = fmt::format("clustered:spread={:.6f}", spread);
    const std::vector<Box2> boxes = boxes_of<2>(scene);
    const double matrix = cells_in_matrix<2>(boxes);
    cells.add({std::sqrt(matrix), "in a matrix", matrix});
    cells.add({std::sqrt(matrix), "in a hash", cells_in_use(boxes)});
    measure_grids(laboratory, scene, 2, std::sqrt(matrix), grids);
    measure_grids(laboratory, scene, 3, std::cbrt(cells_in_matrix<3>(boxes_of<3>(scene))), grids);
  }
  return {cells, grids};
}

/// A grid in the smallest world and in the largest.
struct Ends {
  double bytes = 0;   ///< the most in any world
  double growth = 0;  ///< that over the bytes in the smallest world
  double tests = 0;   ///< a box, in the largest world
  double tests_growth = 0;
};

Ends ends_of(const Table& grids, const std::string& grid) {
  const Table rows = grids.where("grid", grid);
  const std::vector<double> bytes = rows.numbers("memory");
  const std::vector<double> tests = rows.numbers("tests a box");
  if (bytes.size() < 3 || tests.size() < 3)
    throw std::invalid_argument(fmt::format(
        "table 'grids' has {} sizes and {} counts of tests of {}; expected three at least of both",
        bytes.size(), tests.size(), grid));
  const double most = *std::ranges::max_element(bytes);
  return {most, most / bytes.front(), tests.back(), tests.back() / tests.front()};
}

/// What the matrix takes in worlds in which it is as fine as was asked.
struct Matrix {
  double growth = 0;      ///< of its bytes with the side of the world, at its largest
  double cell_bytes = 0;  ///< for each cell more
};

Matrix matrix_of(const Table& cells, const Table& grids) {
  const auto sizes = cells.where("kept", std::string("in a matrix")).points("world over cell", "cells");
  const auto memory =
      grids.where("grid", std::string("paper_grid:cell=2")).points("world over cell", "memory");
  std::vector<std::pair<double, double>> held;  // bytes by cells
  for (std::size_t i = 0; i < std::min(sizes.size(), memory.size()); ++i) {
    if (sizes[i].second <= most_cells) held.emplace_back(sizes[i].second, memory[i].second);
  }
  if (held.size() < 3)
    throw std::invalid_argument(
        fmt::format("{} worlds of at most {:.0f} cells; expected three at least", held.size(), most_cells));
  const auto& [few, few_bytes] = held[held.size() - 3];
  const auto& [many, many_bytes] = held.back();
  // Cells go with the square of the side.
  return {2 * growth_of({{few, few_bytes}, {many, many_bytes}}), (many_bytes - few_bytes) / (many - few)};
}

Finding judge(const std::vector<Table>& tables) {
  const Table& cells = table_named(tables, "cells");
  const Table& grids = table_named(tables, "grids");
  const Matrix matrix = matrix_of(cells, grids);
  const Table in_matrix = cells.where("kept", std::string("in a matrix"));
  const std::vector<double> hashed = cells.where("kept", std::string("in a hash")).numbers("cells");
  if (hashed.empty()) throw std::invalid_argument("table 'cells' has no row of a hash; expected some");
  const double world = in_matrix.numbers("world over cell").back();
  const double printed = in_matrix.numbers("cells").back();
  const double most_hashed = *std::ranges::max_element(hashed);
  const Ends capped = ends_of(grids, "paper_grid:cell=2");
  const Ends own = ends_of(grids, "grid");
  // Results of a former version have no grid in 3D.
  const bool has_3d = !grids.where("grid", std::string("grid in 3D")).rows.empty();

  // Memory that did not explode would go with the boxes, whose number is fixed: a growth of 0. What is left
  // of the purpose is gone where a box is tested against twice as many.
  const bool explodes = matrix.growth > 1 && matrix.cell_bytes > 0;
  constexpr double gone = 2;
  const bool is_defeated = capped.tests_growth > gone;
  // 16 GB, as in a usual computer.
  const double full = matrix.cell_bytes > 0 ? std::sqrt(16e9 / matrix.cell_bytes) : 0;
  const double printed_bytes = std::max(0.0, matrix.cell_bytes * printed);

  Finding finding;
  finding.statements = {
      {.name = "matrix",
       .text = "the matrix of cells grows with the world until no memory holds it",
       .verdict = explodes ? Verdict::not_testable : Verdict::refuted,
       .condition =
           explodes ? "a tautology, Algorithm 2 makes as many cells as the world is large; what a cell costs "
                      "is measured"
                    : "",
       .evidence = {"memory_growth", "bytes_a_cell", "full_at_world"}},
      {.name = "purpose",
       .text = "cells that grow with the world defeat the purpose of small collections",
       .verdict = is_defeated ? Verdict::confirmed : Verdict::refuted,
       .threshold = fmt::format("a box is tested more than {} times as often in the largest world", gone),
       .evidence = {"capped_tests_growth"}}};
  finding.reason = fmt::format(
      "Memory grows with the side of the world to the power {:.2f}, {:.1f} bytes a cell: a world {} cells "
      "wide would take {}, and {} are full at {} cells. A hash keeps {} cells at most. Capped, as erratum 2c "
      "has it, the grid holds {} and its cells grow with the world: {:.1f} times as many tests a box as in "
      "the smallest. Our grid holds {} at most{}, {:.2f} times as much as in the smallest world and with "
      "{:.1f} times the tests.",
      matrix.growth, matrix.cell_bytes, rounded(world), bytes(printed_bytes), bytes(16'000'000'000),
      rounded(full), rounded(most_hashed), bytes(capped.bytes), capped.tests_growth, bytes(own.bytes),
      has_3d ? fmt::format(" (in 3D {})", bytes(ends_of(grids, "grid in 3D").bytes)) : "", own.growth,
      own.tests_growth);
  finding.figures = {{"memory_growth", matrix.growth},
                     {"bytes_a_cell", matrix.cell_bytes, "bytes"},
                     {"largest_world", world, "cells"},
                     {"largest_matrix_cells", printed, "cells"},
                     {"largest_matrix_bytes", printed_bytes, "bytes"},
                     {"full_at_world", full, "cells"},
                     {"most_hashed_cells", most_hashed, "cells"},
                     {"capped_bytes", capped.bytes, "bytes"},
                     {"capped_tests_growth", capped.tests_growth},
                     {"capped_tests_a_box", capped.tests},
                     {"grid_bytes", own.bytes, "bytes"},
                     {"grid_memory_growth", own.growth},
                     {"grid_tests_a_box", own.tests}};
  return finding;
}

}  // namespace

Experiment grid_memory() {
  return {.number = 3,
          .name = "grid_memory",
          .title = "Cells fill the memory in a large world",
          .claim =
              "A limitation of SPI is that it is bounded and does not handle a arbitrarily large world size "
              "without also having an arbitrarily large grid size. Having both ... may defeat the purpose of "
              "keeping the number of elements in a subcollection small. ... With a small grid or large "
              "world, this matrix of grids can grow extremely large and may become computationally "
              "impossible to hold in memory.",
          .section = "III",
          .measured =
              "The cells that a matrix and a hash keep, and the memory and tests of the paper's grid and of "
              "ours, for 2,000 boxes in 16 clusters that lie ever further apart.",
          .measure = measure,
          .judge = judge};
}

}  // namespace broadside::lab
