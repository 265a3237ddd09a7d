// SnapshotCodec: what it writes it reads again, without a World around it.
#include "world/snapshot_codec.hpp"

#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/error.hpp"

namespace broadside::world {
namespace {

using Codec = SnapshotCodec<2, float>;
using Bytes = std::vector<std::byte>;

/// Two boxes that overlap, one of them with user data, before their first update.
class SnapshotCodecTest : public testing::Test {
 protected:
  SnapshotCodecTest() {
    parts.slots.reserve(2);
    parts.boxes.reserve(2, false);
    parts.boxes.reserve_changes(2);
    for (std::uint32_t slot = 0; slot < 2; ++slot) {
      parts.slots.add();
      parts.boxes.append();
      parts.boxes.set(slot, {{0, 0}, {1, 1}}, nullptr);
    }
    parts.user_data.reserve(2, 0, true);
    parts.user_data.use(2);
    parts.user_data.set(1, 77);
  }

  Bytes encoded() const {
    Bytes bytes;
    detail::OutputTo output(bytes);
    Codec::encode(parts, tracker, output);
    return bytes;
  }

  WorldOptions options{.algorithm = "grid", .margin = 0.5};
  WorldParts<2, float> parts{options};
  WorldTracker<2, float> tracker{options};
};

TEST_F(SnapshotCodecTest, ReadsWhatItWrote) {
  const auto decoded = Codec::decode(encoded(), parts, tracker);
  EXPECT_EQ(decoded.spec, "grid");
  EXPECT_EQ(decoded.parts->slots.live(), 2u);
  EXPECT_EQ(decoded.parts->user_data.get(1), 77u);
  EXPECT_EQ(decoded.parts->boxes.shown()[1], (Box2{{-0.5F, -0.5F}, {1.5F, 1.5F}}));
  EXPECT_FALSE(decoded.parts->is_settled());
  EXPECT_TRUE(decoded.last_frame.boxes.empty());
}

TEST_F(SnapshotCodecTest, KnowsAnUpdateThatFailedWithoutAnyChange) {
  parts.boxes.settle();
  parts.has_updated = true;
  for (const bool failed : {false, true}) {
    parts.update_failed = failed;
    Bytes bytes;
    detail::OutputTo output(bytes);
    // The tracker has taken the boxes, so that nothing differs from its last frame.
    PairEvents events;
    tracker.update(parts.frame(), events);
    Codec::encode(parts, tracker, output);
    EXPECT_EQ(Codec::decode(bytes, parts, tracker).parts->update_failed, failed);
  }
}

TEST_F(SnapshotCodecTest, RefusesBytesThatWereCutOrChanged) {
  const Bytes bytes = encoded();
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_THROW(Codec::decode(std::span(bytes).first(size), parts, tracker), InvalidSnapshot) << size;
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    Bytes changed = bytes;
    changed[at] ^= std::byte{1};
    EXPECT_THROW(Codec::decode(changed, parts, tracker), InvalidSnapshot) << at;
  }
}

TEST_F(SnapshotCodecTest, RefusesPairsThatTheTrackerDoesNotFind) {
  const auto decoded = Codec::decode(encoded(), parts, tracker);
  EXPECT_NO_THROW(decoded.check_pairs({}));
  EXPECT_THROW(decoded.check_pairs({{BoxId{0}, BoxId{1}}}), InvalidSnapshot);
}

}  // namespace
}  // namespace broadside::world
