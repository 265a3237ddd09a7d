// Corruptions of finders' pairs and trackers' events, one at a time: the comparison catches every one that an
// algorithm has alone. bench/corruptions tries ten thousand.
#include <gtest/gtest.h>

#include "bench/corrupted.hpp"

namespace broadside::bench {
namespace {

lab::CaseRequest request_for(bool moves) {
  lab::CaseRequest request;
  request.scene = "uniform";
  request.boxes = 200;
  request.moving = moves ? 0.5 : 0;
  request.frames = moves ? 5 : 0;
  return request;
}

TEST(Compare, CatchesEveryCorruptionOfOneSearchOrFrame) {
  for (const bool moves : {false, true}) {
    for (const std::size_t definition_boxes : {20'000, 0}) {
      CorruptionCounts all;
      for (const char* const base : {"grid", "bvh", "sweep_and_prune"})
        all.add(compare_corrupted(base, request_for(moves), all.applied, 25, definition_boxes));
      EXPECT_EQ(all.caught, all.applied) << "moves " << moves << ", definition " << definition_boxes;
      EXPECT_GE(all.applied, 70u) << "moves " << moves;
    }
  }
}

TEST(Compare, CatchesAFaultThatTheReferenceSharesWhereBoxesAreSampled) {
  for (const bool moves : {false, true}) {
    // No more boxes than are sampled.
    const CorruptionCounts all = compare_with_corrupted_reference(request_for(moves), 0, 15);
    EXPECT_EQ(all.applied, 15u);
    EXPECT_EQ(all.caught, all.applied) << "moves " << moves;
  }
}

}  // namespace
}  // namespace broadside::bench
