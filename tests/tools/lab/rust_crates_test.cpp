// What the peers from crates.io have in common: panics and unknown names.
#include "lab/peers/rust_crates.hpp"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lab/catalogue.hpp"
#include "lab/measure/compare.hpp"
#include "tests/support/message.hpp"

namespace broadside::lab::peers {
namespace {

using testing::HasSubstr;

/// A peer whose searcher always panics.
Algorithm panicking() {
  return {
      .name = "panicking",
      .summary = "Panics",
      .source = "tools/lab/peers/rust/src/panicking.rs",
      .kind = AlgorithmKind::peer,
      .in_2d = {.searcher = rust_searcher<2>("panicking")},
  };
}

TEST(RustCrates, ThatPanicHaveFailedAndTheComparisonGoesOn) {
  Catalogue catalogue;
  catalogue.add(panicking());
  CompareOptions options;
  options.algorithms = "panicking,grid";
  options.plan = {{.scene = "uniform", .dimension = 2, .boxes = 100}};
  options.effort.share_seconds = 0.001;
  const Comparison comparison = compare(catalogue, options);
  const std::vector<Measurement>& measurements = comparison.cases.at(0).measurements;
  EXPECT_EQ(measurements.at(0).outcome, Outcome::failed);
  EXPECT_THAT(measurements[0].reason,
              HasSubstr("a panic: on purpose, with 100 boxes (src/panicking.rs, line "));
  EXPECT_EQ(measurements.at(1).outcome, Outcome::verified);
}

TEST(RustCrates, AreRefusedByAnUnknownName) {
  EXPECT_THAT(message_of<RustError>([] { RustCrateSearcher<2>("nothing"); }),
              HasSubstr("no searcher 'nothing' in 2D"));
  EXPECT_THAT(message_of<RustError>([] { RustCrateFollower<3>("nothing"); }),
              HasSubstr("no follower 'nothing' in 3D"));
}

}  // namespace
}  // namespace broadside::lab::peers
