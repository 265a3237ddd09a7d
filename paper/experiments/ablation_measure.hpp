// What is measured for our claim on what makes searches fast: tables, rows and columns by name.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "paper/experiments/laboratory.hpp"
#include "paper/experiments/table.hpp"

namespace broadside::lab {

/// What a search that is written plainly is called in the tables, and what one is without all its switches.
inline const std::string ablation_plain = "plain, without SIMD";
inline const std::string ablation_nothing = "without all of these";

/// With what a row of one switch begins.
inline const std::string ablation_but = "plain, but ";

/// The boxes: alike everywhere, where a sample can tell little, and in clusters.
inline const std::array<std::string, 2> ablation_scenes = {"uniform", "clustered"};

/// A peer that looks for one box after the other, without SIMD.
inline const std::string ablation_peer = "boost_rtree";

/// Columns of the table "shares".
inline const std::string simd_share = "share of SIMD";
inline const std::string rest_share = "share of the other things";
inline const std::string peer_over_without_simd = "Boost over without SIMD";
inline const std::string peer_over_without_all = "Boost over without all";

/// The table of a search on a scene: "grid", "grid_clustered".
std::string ablation_table(const std::string& own, const std::string& scene);

/// What the column of a dimension's ratios is called.
std::string ablation_ratio(int dimension);

/// The table "shares", without rows: what SIMD gains, and what the other things do, of the whole.
Table table_of_shares();

/// A table for each search and scene, and "shares".
std::vector<Table> measure_ablation(const Laboratory& laboratory);

}  // namespace broadside::lab
