// The paper's grid as an algorithm: its searcher, its outline, and its description.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>
#include <vector>

#include "broadside/debug/outline.hpp"
#include "broadside/searcher.hpp"

#include "paper/listings/coherent_follower.hpp"
#include "paper/listings/followers.hpp"
#include "paper/listings/grid_listing.hpp"
#include "paper/listings/listing_searcher.hpp"
#include "paper/listings/registry.hpp"
#include "paper/listings/world.hpp"

namespace broadside::paper {
namespace {

class Grid final : public ListingSearcher<2> {
 public:
  explicit Grid(const Settings& settings) : grid_(settings) {}

 private:
  Statistics search_listed(std::span<const Box2> boxes, PairSink& pairs, Checkpoint& checkpoint) override {
    Statistics statistics;
    if (!boxes.empty()) {
      grid_.initialize(boxes);
      end_phase(&Phases::initializing_ms);
      grid_.algorithm_3_spanning_add_element(boxes);
      end_phase(&Phases::adding_ms);
      grid_.algorithm_4_spi(boxes, pairs, checkpoint, statistics);
    }
    return statistics;
  }

  GridListing grid_;
};

/// Where a cell begins and ends on an axis. A cell at the world's border extends to infinity if boxes do.
std::pair<float, float> ends(const GridListing& listing, std::span<const Box2> boxes, std::size_t cell,
                             std::size_t count, int axis) {
  const double origin = axis == 0 ? listing.world().left : listing.world().top;
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const auto begin = static_cast<float>(origin + static_cast<double>(cell) * listing.size());
  const auto end = static_cast<float>(origin + static_cast<double>(cell + 1) * listing.size());
  const bool before = cell == 0 && std::any_of(boxes.begin(), boxes.end(),
                                               [&](const Box2& e) { return e.min[axis] < begin; });
  const bool beyond = cell + 1 == count && std::any_of(boxes.begin(), boxes.end(),
                                                       [&](const Box2& e) { return e.max[axis] > end; });
  return {before ? -infinity : begin, beyond ? infinity : end};
}

/// With more cells than this, an outline has only the cells that contain a box.
constexpr std::size_t max_drawn = 1 << 16;

/// Every cell or, if there are very many, those that contain a box.
Outline<2> grid_outline(std::span<const Box2> boxes, const Workers&, const Settings& settings) {
  GridListing listing(settings);
  listing.initialize(boxes);
  const std::size_t columns = listing.columns();
  const std::size_t rows = listing.rows();
  const bool all = columns * rows <= max_drawn;
  if (!all) listing.algorithm_3_spanning_add_element(boxes);
  Outline<2> outline;
  outline.kind = "cells";
  outline.levels.resize(1);
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t c = 0; c < columns; ++c) {
      if (!all && listing.g(c, r).empty()) continue;
      const auto [left, right] = ends(listing, boxes, c, columns, 0);
      const auto [top, bottom] = ends(listing, boxes, r, rows, 1);
      outline.levels[0].push_back({{left, top}, {right, bottom}});
    }
  }
  std::array<char, 32> size{};
#if __cpp_lib_to_chars >= 201611L
  // As a stream would format it, but independent of the rounding mode.
  std::to_chars(size.data(), size.data() + size.size() - 1, listing.size(), std::chars_format::general, 3);
#else
  std::snprintf(size.data(), size.size(), "%.3g", listing.size());
#endif
  outline.caption = std::to_string(columns) + " x " + std::to_string(rows) +
                    (rows == 1 ? " cell of " : " cells of ") + size.data();
  return outline;
}

}  // namespace

Algorithm grid() {
  std::vector<Tunable> tunables = {{
      .name = "cell",
      .summary = "side of a cell, in the coordinates' unit; doubled while the grid would be too large for "
                 "memory",  // errata 2c and 3i
      .default_value = "auto",
      .min = std::numeric_limits<float>::min(),
      .max = std::numeric_limits<float>::max(),
  }};
  tunables.push_back({.name = "limit",
                      .summary = "what limits the cells and the references: memory, or nothing, as printed",
                      .default_value = "memory",
                      .type = Tunable::Type::choice,
                      .choices = {"memory", "none"}});
  for (Tunable& tunable : world_tunables()) tunables.push_back(std::move(tunable));
  tunables.push_back(
      {.name = "update",
       .summary = "how a tracker mends its cells before it searches them: built anew; all cells searched for "
                  "each mover, or once for all movers, which are then inserted; movers found by hashing "
                  "their old place, and inserted; or references translated to neighbouring cells",
       .default_value = "rebuild",
       .type = Tunable::Type::choice,
       .choices = {"rebuild", "search_delete_reinsert", "search_once", "reinsert", "translate"}});
  tunables.push_back(detect_tunable());
  return {
      .name = "paper_grid",
      .summary = "a uniform grid with brute force in each cell, as the paper lists it, mended; 2D only",
      .source = "paper.md, sections III (Algorithms 2 to 4) and VI-B",
      .kind = AlgorithmKind::paper,
      .tunables = std::move(tunables),
      .in_2d = {.searcher = make_strategy<Grid>,
                .followers = {{.name = "paper_grid", .make = make_grid_follower}},
                .outline = grid_outline},
  };
}

}  // namespace broadside::paper
