// The plain searches against the definition, whatever is left out; and what the experiment makes of tables
// made by hand.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"

#include "paper/experiments/ablation_measure.hpp"
#include "paper/experiments/plain.hpp"
#include "tests/support/model.hpp"
#include "tests/support/scattered.hpp"
#include "tests/unit/paper/judged.hpp"

namespace broadside::lab {
namespace {

using testing::HasSubstr;

/// All combinations of the algorithm's switches.
std::vector<Spec> all_specs(const Algorithm& algorithm) {
  std::vector<Spec> specs = {{algorithm.name, {}}};
  for (const Tunable& tunable : algorithm.tunables) {
    const std::size_t count = specs.size();
    for (std::size_t i = 0; i < count; ++i) {
      specs.push_back(specs[i]);
      specs.back().values.emplace_back(tunable.name, "no");
    }
  }
  return specs;
}

template <int D>
std::vector<Pair> pairs_by(const Algorithm& algorithm, const Spec& spec, const std::vector<Box<D>>& boxes) {
  std::vector<Pair> pairs;
  PairCollector collector(pairs);
  Finder<D>(algorithm, spec).find(boxes, collector);
  std::ranges::sort(pairs);
  return pairs;
}

template <int D>
std::vector<Pair> pairs_by_definition(const std::vector<Box<D>>& boxes) {
  std::vector<Pair> pairs;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    for (std::uint32_t j = i + 1; j < boxes.size(); ++j) {
      if (overlap(boxes[i], boxes[j])) pairs.push_back({BoxId{i}, BoxId{j}});
    }
  }
  return pairs;
}

TEST(PlainSearches, FindEachPairOnceWhateverIsLeftOut) {
  in_each_dimension([]<int D>() {
    // Few and many, sparse and crowded, large ones among small ones, and all at one place.
    std::vector<std::vector<Box<D>>> inputs = {{},
                                               scattered_boxes<D>(1),
                                               scattered_boxes<D>(17),
                                               scattered_boxes<D>(700, 60),
                                               scattered_boxes<D>(700, 12)};
    inputs.push_back(scattered_boxes<D>(400, 40));
    for (std::size_t i = 0; i < inputs.back().size(); i += 40) inputs.back()[i].max.fill(50);
    inputs.emplace_back(40, scattered_boxes<D>(1)[0]);
    for (const Algorithm& algorithm : {plain_grid(), plain_bvh()}) {
      for (const Spec& spec : all_specs(algorithm)) {
        for (const std::vector<Box<D>>& boxes : inputs)
          ASSERT_EQ(pairs_by<D>(algorithm, spec, boxes), pairs_by_definition<D>(boxes))
              << spec.text() << ", " << boxes.size() << " boxes in " << D << "D";
      }
    }
  });
}

TEST(PlainSearches, HoldTheLibraryBackForOneSearch) {
  const std::string before = instruction_set();
  const std::vector<Box2> boxes = scattered_boxes<2>(300);
  for (const std::string& set : instruction_sets())
    EXPECT_EQ(pairs_by<2>(held_back(), {"held_back", {{"simd", set}}}, boxes), pairs_by_definition<2>(boxes));
  EXPECT_EQ(instruction_set(), before);
}

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
