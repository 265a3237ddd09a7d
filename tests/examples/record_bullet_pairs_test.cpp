// What examples/record_bullet_pairs recorded: Bullet's broad phase keeps its promise, and `verify` finds the
// one that was broken on purpose.
#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lab/verify/verify_file.hpp"
#include "lab/verify/verify_recorded.hpp"
#include "tests/support/files.hpp"

namespace broadside::lab {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class RecordBulletPairs : public Files {
 protected:
  Verification verified(const std::filesystem::path& recording) const {
    VerifyOptions options;
    options.algorithms = "auto";
    options.counterexample = path("small.btrace");
    return verify_file(Catalogue(), open_file(recording), options);
  }
};

/// The first frame in which the box in this slot overlaps another one without being reported, or is reported
/// with one that is further away than twice the margin; by loops over all boxes.
std::size_t first_wrong_frame(const std::filesystem::path& path, BoxId slot) {
  const BoxFile file = open_file(path);
  const Recording<3, float> recording =
      read_recording(*std::get<std::unique_ptr<FrameReader<3, float>>>(file.frames));
  std::vector<Box3> boxes = recording.history.boxes;
  RecordedFrame pairs;
  for (std::size_t frame = 0; frame < recording.pairs.size(); ++frame) {
    if (frame > 0) lab::apply(recording.history.steps[frame - 1], boxes);
    pairs.apply(recording.pairs[frame], boxes.size(), {});
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const BoxId other = BoxId(i);
      if (other == slot) continue;
      float apart = -1;
      for (int axis = 0; axis < 3; ++axis) {
        apart = std::max({apart, boxes[i].min[axis] - boxes[index(slot)].max[axis],
                          boxes[index(slot)].min[axis] - boxes[i].max[axis]});
      }
      const bool is_reported =
          std::ranges::binary_search(pairs.reported(), Pair{std::min(slot, other), std::max(slot, other)});
      if (is_reported ? apart > 0.2401F : apart <= 0) return frame;
    }
  }
  return recording.pairs.size();
}

TEST_F(RecordBulletPairs, FindsNothingWrongWithBullet) {
  const Verification verification = verified(RECORDING);
  EXPECT_TRUE(verification.all_verified()) << lab::text_of(verification);
  EXPECT_EQ(verification.verdicts[0].algorithm, recorded_pairs_name);
  EXPECT_EQ(verification.verdicts[0].frames, 240u);
  EXPECT_GT(verification.pairs, 100u);
}

TEST_F(RecordBulletPairs, NamesTheFrameAndTheBodyWhoseUpdatesAreSkipped) {
  const Verification verification = verified(BROKEN_RECORDING);
  EXPECT_FALSE(verification.all_verified());
  const std::size_t frame = first_wrong_frame(BROKEN_RECORDING, BoxId{20});
  EXPECT_GT(frame, 15u);
  EXPECT_THAT(verification.verdicts[0].reason,
              AllOf(HasSubstr("recorded pairs: frame " + std::to_string(frame) + ", pair ("),
                    HasSubstr("; all name box 20\n"), HasSubstr("pair (0, 20) missed")))
      << "it falls through the floor";
  ASSERT_TRUE(verification.counterexample);
  EXPECT_EQ(verification.counterexample->boxes, 2u);
  EXPECT_EQ(verification.counterexample->frames, 2u);
  EXPECT_FALSE(verified(path("small.btrace")).all_verified());
}

}  // namespace
}  // namespace broadside::lab
