// What the experiment makes of tables made by hand.
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "paper/experiments/ablation_measure.hpp"
#include "tests/unit/paper/judged.hpp"

namespace broadside::lab {
namespace {

using testing::HasSubstr;

/// Tables in which the library takes 1 ms, and the searches without SIMD and without all take these times.
std::vector<Table> tables_of(double grid_without_simd, double bvh_without_simd, double without_all) {
  std::vector<Table> tables;
  for (const auto& [name, without_simd] :
       {std::pair("grid", grid_without_simd), std::pair("bvh", bvh_without_simd)}) {
    Table table{.name = name, .title = name, .columns = {{"search"}}};
    for (const std::string dimension : {"2D", "3D"}) {
      table.columns.push_back({dimension, "ms"});
      append(table.columns, ratio_columns(dimension + " ratio"));
    }
    const auto add = [&table](const std::string& search, double times) {
      std::vector<Cell> row = {search};
      for (int dimension = 2; dimension <= 3; ++dimension) {
        row.emplace_back(times);
        append(row, ratio(times));
      }
      table.add(row);
    };
    add("as the library has it", 1);
    add("by AVX2", 1.1);
    add("by SCALAR", without_simd);
    add("plain, without SIMD", 1.2 * without_simd);
    add("plain, but std::sort to pack", 2.4 * without_simd);
    add("without all of these", without_all);
    tables.push_back(std::move(table));
  }
  return tables;
}

TEST(Ablation, IsConfirmedWhereSimdIsMostOfTheGain) {
  const Finding finding = judged("ablation", tables_of(4, 4, 8));
  EXPECT_EQ(verdict(finding, "simd"), "confirmed");
  EXPECT_NEAR(figure(finding, "grid_2d_share_of_simd"), 2.0 / 3, 1e-12);
  EXPECT_NEAR(figure(finding, "bvh_3d_but_std__sort_to_pack"), 2, 1e-12);
}

TEST(Ablation, HoldsForTheSearchesOfWhichSimdIsMost) {
  EXPECT_EQ(verdict(judged("ablation", tables_of(4, 2, 8)), "simd"),
            "holds within bounds: it is grid on uniform boxes in 2D, grid on uniform boxes in 3D; not bvh on "
            "uniform "
            "boxes in 2D, bvh on uniform boxes in 3D");
}

TEST(Ablation, IsRefutedWhereTheRestGainsMore) {
  EXPECT_EQ(verdict(judged("ablation", tables_of(2, 2, 8)), "simd"), "refuted");
}

TEST(Ablation, IsOpenWhereTheIntervalOfTheShareHoldsOneHalf) {
  EXPECT_EQ(verdict(judged("ablation", tables_of(std::sqrt(8.0), std::sqrt(8.0), 8)), "simd"),
            "not testable: each interval holds one half");
  EXPECT_EQ(verdict(judged("ablation", tables_of(4, std::sqrt(8.0), 8)), "simd"),
            "holds within bounds: it is grid on uniform boxes in 2D, grid on uniform boxes in 3D; the others "
            "are open");
}

TEST(Ablation, TakesSharesOfTheSameRoundsWhereTheyWereMeasured) {
  std::vector<Table> tables = tables_of(4, 4, 8);
  Table shares = table_of_shares();
  for (const std::string own : {"grid", "bvh"}) {
    for (const std::string dimension : {"2D", "3D"}) {
      std::vector<Cell> row = {own, "uniform", dimension, 0.4, 0.35, 0.45};
      row.resize(shares.columns.size());
      shares.add(row);
    }
  }
  tables.push_back(shares);
  const Finding finding = judged("ablation", tables);
  EXPECT_EQ(verdict(finding, "simd"), "refuted");
  EXPECT_EQ(figure(finding, "grid_2d_share_of_simd"), 0.4);
}

TEST(Ablation, JudgesClusteredBoxesWhereTheyWereMeasured) {
  std::vector<Table> tables = tables_of(4, 4, 8);
  for (Table table : tables_of(2, 2, 8)) {
    table.name += "_clustered";
    tables.push_back(std::move(table));
  }
  const Finding finding = judged("ablation", tables);
  EXPECT_THAT(verdict(finding, "simd"), HasSubstr("not grid on clustered boxes in 2D"));
  EXPECT_EQ(figure(finding, "parts"), 8);
}

TEST(Ablation, SaysWhatBoostTakesOnlyWhereItIsMeasured) {
  std::vector<Table> tables = tables_of(2, 2, 8);
  EXPECT_THAT(judged("ablation", tables).reason, Not(HasSubstr("Boost")));
  for (Table& table : tables) {
    table.rows.push_back(table.rows.back());
    table.rows.back()[0] = std::string("boost_rtree");
  }
  EXPECT_THAT(judged("ablation", tables).reason, HasSubstr("Boost's tree 8.0 times"));
}

}  // namespace
}  // namespace broadside::lab
