// Snapshots of worlds: the future after restore() is the one there was; and bytes that are none are refused.
#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/error.hpp"
#include "broadside/recorder.hpp"
#include "broadside/world.hpp"

#include "lab/measure/memory.hpp"
#include "tests/support/boxes.hpp"
#include "tests/support/message.hpp"
#include "tests/support/trackers.hpp"
#include "tests/support/world_history.hpp"
#include "tests/world/handle_pairs.hpp"

namespace broadside {
namespace {

using testing::HasSubstr;
using Bytes = std::vector<std::byte>;

struct Way {
  std::string name;
  WorldOptions options;
  bool with_filters;
  bool with_predicate;
};

std::vector<Way> ways() {
  std::vector<Way> ways;
  for (const char* const algorithm : {"auto", "brute_force", "grid", "sweep_and_prune", "quadtree", "bvh"}) {
    for (const bool with_filters : {false, true}) {
      for (const double margin : {0.0, 1.0}) {
        Way way{fmt::format("{}, filters {}, margin {}", algorithm, with_filters, margin),
                {},
                with_filters,
                false};
        way.options.algorithm = algorithm;
        way.options.margin = margin;
        ways.push_back(way);
      }
    }
  }
  ways.push_back({"predicate", {}, true, true});
  ways.push_back({"predicate and margin", {}, true, true});
  ways.back().options.margin = 0.5;
  ways.push_back({"enlarged events", {}, true, false});
  ways.back().options.margin = 1;
  ways.back().options.relative_margin = 0.25;
  ways.back().options.events = WorldEvents::enlarged;
  ways.push_back({"enlarged events and predicate", ways.back().options, true, true});
  ways.push_back({"predicted frames", {}, true, false});
  ways.back().options.predicted_frames = 4;
  return ways;
}

template <int D, typename Real = float>
WorldCourse<D, Real> course_of(const Way& way) {
  WorldCourse<D, Real> course;
  course.options = way.options;
  course.box = [](Choices& choices) { return random_box<D, Real>(choices, {20, 4, 0}); };
  course.has_filters = way.with_filters;
  course.has_predicate = way.with_predicate;
  return course;
}

template <int D, typename Real = float>
void check_the_future(const Way& way, std::uint64_t seed) {
  SCOPED_TRACE(way.name);
  Rng rng(seed);
  WorldHistory<D, Real> history(rng, course_of<D, Real>(way));
  for (int frame = 0; frame < 12; ++frame) {
    for (std::size_t i = rng.below(12); i > 0; --i) history.change();
    Rng same_rng = rng;
    WorldHistory<D, Real> same = history.twin(same_rng);  // between changes and the update
    for (int then = 0; then < 3; ++then) {
      for (WorldHistory<D, Real>* const one : {&history, &same}) {
        one->update();
        for (int i = 0; i < 5; ++i) one->change();
        one->check();
      }
    }
    ASSERT_EQ(same.world().snapshot(), history.world().snapshot()) << "frame " << frame;
    history.go_back();
  }
}

TEST(Snapshot, IsFollowedByTheSameFuture) {
  for (const Way& way : ways()) {
    check_the_future<2>(way, 1);
    check_the_future<3>(way, 2);
  }
}

TEST(Snapshot, IsFollowedByTheSameFutureInDouble) {
  for (const Way& way : ways()) check_the_future<2, double>(way, 3);
}

/// Each registered algorithm, with none of its tunables and with all of them, oddly written; former names.
std::vector<std::string> odd_specs() {
  std::vector<std::string> specs = {"hierarchical_grid", "hierarchical_grid:cell=2.50", "bvh:update=reinsert",
                                    "brute_force:update=changed", "brute_force:update=all"};
  for (const Algorithm& algorithm : algorithms()) {
    Spec spec{algorithm.name, {}};
    specs.push_back(spec.text());
    for (const Tunable& tunable : algorithm.tunables) {
      const double number = std::clamp(2.0, tunable.min, tunable.max);
      const bool is_choice = tunable.type == Tunable::Type::choice;
      spec.values.emplace(spec.values.begin(), tunable.name,
                          is_choice ? tunable.choices.front() : fmt::format("{:.3f}", number));
    }
    specs.push_back(spec.text());
    for (auto& given : spec.values) {
      const auto is_it = [&given](const Tunable& one) { return one.name == given.first; };
      given.second = std::ranges::find_if(algorithm.tunables, is_it)->default_value;
    }
    specs.push_back(spec.text());
  }
  return specs;
}

template <int D>
void expect_the_same_bytes_after_a_restore(const std::string& spec) {
  World<D> world(spec);
  for (int i = 0; i < 3; ++i) world.add(Box<D>{});
  world.update();
  const Bytes bytes = world.snapshot();
  World<D> other;
  other.restore(bytes);
  EXPECT_EQ(other.snapshot(), bytes) << spec;
  world.restore(bytes);
  EXPECT_EQ(world.snapshot(), bytes) << spec;
}

TEST(Snapshot, HasTheSameBytesAfterARestoreWhateverTheSpec) {
  for (const std::string& spec : odd_specs()) {
    const Algorithm& algorithm = *find_algorithm(Spec(spec).name);
    if (algorithm.has_dimension(2)) expect_the_same_bytes_after_a_restore<2>(spec);
    if (algorithm.has_dimension(3)) expect_the_same_bytes_after_a_restore<3>(spec);
  }
}

TEST(Snapshot, OfACallersTrackerHasTheSameBytesWhateverTheSpec) {
  WorldOptions options;
  options.algorithm = "not used";
  World2 world(Tracker<2>("grid"), options);
  World2 other(Tracker<2>("bvh"));
  other.restore(world.snapshot());
  EXPECT_EQ(other.snapshot(), world.snapshot());
}

TEST(Snapshot, KeepsWhatCanBeReadOfBoxes) {
  World2 world;
  BoxOptions options;
  options.filter.group = -3;
  options.user_data = 0xfeedU;
  const Handle kept = world.add(at(0), options);
  const Handle gone = world.add(at(0.5F), options);
  world.update();
  world.remove(gone);
  World2 other;
  other.restore(world.snapshot());
  EXPECT_EQ(other.size(), 1u);
  EXPECT_EQ(other.box(kept), at(0));
  EXPECT_EQ(other.box(gone), at(0.5F));
  EXPECT_EQ(other.user_data(gone), 0xfeedU);
  EXPECT_EQ(other.filter(kept), options.filter);
  EXPECT_FALSE(other.contains(gone));
}

TEST(Snapshot, GivesBackTheHandlesThatWereFree) {
  World2 world;
  std::vector<Handle> handles;
  for (int i = 0; i < 5; ++i) handles.push_back(world.add(at(0)));
  world.update();
  world.remove(handles[3]);
  world.remove(handles[1]);
  world.update();
  world.update();
  World2 other;
  other.restore(world.snapshot());
  for (int i = 0; i < 3; ++i) EXPECT_EQ(other.add(at(0)), world.add(at(0)));
  EXPECT_THROW(other.move(handles[3], at(1)), InvalidHandle);
}

TEST(Snapshot, BringsItsAlgorithmAndMargin) {
  WorldOptions options;
  options.algorithm = "grid";
  options.margin = 2;
  World2 world(options);
  world.add(at(0));
  World2 other("bvh");
  other.restore(world.snapshot());
  EXPECT_EQ(other.snapshot(), world.snapshot());
}

TEST(Snapshot, IsReturnedToByShowingTheTrackerOnlyWhatDiffers) {
  std::vector<std::size_t> seen;
  World2 world(stub_tracker([&](const Change<2>& change, PairSink& begun, PairSink& ended) {
    seen.push_back(change.changed.size());
    for (std::uint32_t a = 0; a < change.now.size(); ++a) {
      for (std::uint32_t b = a + 1; b < change.now.size(); ++b)
        change.report(BoxId{a}, BoxId{b}, begun, ended);
    }
  }));
  std::vector<Handle> handles;
  for (int i = 0; i < 100; ++i) handles.push_back(world.add(at(static_cast<float>(2 * i))));
  world.update();
  const Bytes bytes = world.snapshot();
  world.move(handles[7], at(500));
  world.move(handles[8], at(500));
  world.update();
  world.restore(bytes);
  EXPECT_EQ(seen, (std::vector<std::size_t>{100, 2, 2}));
  EXPECT_TRUE(world.update().begun.empty());
  EXPECT_EQ(world.box(handles[7]), at(14));
}

TEST(Snapshot, CanBeTakenAfterAnUpdateThatFailed) {
  bool fails = true;
  const auto predicate = [&](Handle, Handle) {
    if (fails) throw std::runtime_error("not now");
    return true;
  };
  World2 world;
  world.set_predicate(predicate);
  world.add(at(0));
  world.add(at(0));
  EXPECT_THROW(world.update(), std::runtime_error);
  World2 other;
  other.set_predicate(predicate);
  other.restore(world.snapshot());
  fails = false;
  const Events events = world.update();
  const Events same = other.update();
  EXPECT_EQ(listed(same.begun), listed(events.begun));
  EXPECT_EQ(listed(same.ended), listed(events.ended));
  EXPECT_EQ(world.pairs().size(), 1u);
}

TEST(Snapshot, CanBeTakenAfterSeveralUpdatesThatFailed) {
  bool fails = false;
  World2 world;
  world.set_predicate([&](Handle, Handle) {
    if (fails) throw std::runtime_error("not now");
    return true;
  });
  std::vector<Handle> handles;
  for (const float x : {0.F, 0.F, 5.F, 5.F, 10.F, 20.F}) handles.push_back(world.add(at(x)));
  world.update();
  fails = true;
  world.move(handles[3], at(30));
  world.move(handles[5], at(10));
  EXPECT_THROW(world.update(), std::runtime_error);
  world.move(handles[1], at(40));
  EXPECT_THROW(world.update(), std::runtime_error);
  world.restore(world.snapshot());
  fails = false;
  const Events events = world.update();
  EXPECT_EQ(events.begun.size(), 1u);
  EXPECT_EQ(events.ended.size(), 2u);
}

/// A world with a bit of everything, in the middle of a frame.
World2 full_world() {
  Way way{"", {}, true, false};
  way.options.algorithm = "brute_force";
  way.options.margin = 1;
  Rng rng(7);
  WorldHistory<2> history(rng, course_of<2>(way));
  for (const int changes : {40, 20, 10}) {
    history.update();
    for (int i = 0; i < changes; ++i) history.change();
  }
  return std::move(history.world());
}

TEST(Snapshot, IsRefusedWithAnyBitWrong) {
  Bytes bytes = full_world().snapshot();
  World2 world;
  const Handle handle = world.add(at(3));
  world.update();
  const Bytes before = world.snapshot();
  for (std::size_t bit = 0; bit < 8 * bytes.size(); bit += 3) {
    bytes[bit / 8] ^= std::byte{1} << bit % 8;
    ASSERT_THROW(world.restore(bytes), InvalidSnapshot) << "bit " << bit;
    bytes[bit / 8] ^= std::byte{1} << bit % 8;
  }
  EXPECT_EQ(world.snapshot(), before);
  EXPECT_EQ(world.box(handle), at(3));
}

TEST(Snapshot, IsRefusedWithAnyBytesMissingOrTooMany) {
  const Bytes bytes = full_world().snapshot();
  World2 world;
  for (std::size_t size = 0; size < bytes.size(); ++size)
    ASSERT_THROW(world.restore(std::span(bytes).first(size)), InvalidSnapshot) << size;
  Bytes longer = bytes;
  longer.push_back({});
  EXPECT_THROW(world.restore(longer), InvalidSnapshot);
}

TEST(Snapshot, SaysWhatItIsNotASnapshotOf) {
  World2 world;
  const Bytes bytes = world.snapshot();
  DoubleWorld2 precise;
  EXPECT_THAT(message_of<InvalidSnapshot>([&] { precise.restore(bytes); }),
              HasSubstr("the size of a coordinate of a snapshot is 4; expected 8"));
  World3 deep;
  EXPECT_THAT(message_of<InvalidSnapshot>([&] { deep.restore(bytes); }),
              HasSubstr("the dimension of a snapshot is 2; expected 3"));
  Bytes newer = bytes;
  newer[8] = std::byte{4};
  EXPECT_THAT(message_of<InvalidSnapshot>([&] { world.restore(newer); }),
              HasSubstr("the version of a snapshot is 4; expected 3"));
  EXPECT_THAT(message_of<InvalidSnapshot>([&] { world.restore(std::span(bytes).first(3)); }),
              HasSubstr("expected"));
  World2 choosy;
  choosy.set_predicate([](Handle, Handle) { return true; });
  EXPECT_THAT(message_of<InvalidSnapshot>([&] { choosy.restore(bytes); }),
              HasSubstr("a world without a predicate, but this one has one"));
}

/// Makes the checksum and the length right.
void seal(Bytes& bytes) {
  const std::uint64_t size = bytes.size();
  for (std::size_t i = 0; i < 8; ++i) bytes[16 + i] = static_cast<std::byte>(size >> 8 * i);
  trace::Checksum checksum;
  checksum.add(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size() - 4);
  for (std::size_t i = 0; i < 4; ++i)
    bytes[bytes.size() - 4 + i] = static_cast<std::byte>(checksum.value() >> 8 * i);
}

TEST(Snapshot, ThatLiesUnderARightChecksumDoesNoHarm) {
  const Bytes right = full_world().snapshot();
  std::size_t refused = 0;
  std::int64_t max_memory = 0;
  for (std::size_t bit = 8 * 24; bit < 8 * (right.size() - 4); ++bit) {
    Bytes bytes = right;
    bytes[bit / 8] ^= std::byte{1} << bit % 8;
    seal(bytes);
    World2 world;
    const lab::AllocationMeter meter;
    try {
      world.restore(bytes);
    } catch (const InvalidSnapshot&) {
      ++refused;
      EXPECT_EQ(world.size(), 0u);
    }
    if (const auto allocation = meter.read()) max_memory = std::max(max_memory, allocation->peak);
    world.add(at(0));
    world.update();  // it may say that it keeps no pairs
  }
  EXPECT_GT(refused, right.size());
  EXPECT_LT(max_memory, std::int64_t{1} << 20) << "a count that is not true takes no memory";
}

TEST(Snapshot, LeavesTheWorldAsItWasWhenItsPairsAreNotThoseOfItsBoxes) {
  World2 lying;
  lying.add(at(0));
  lying.add(at(0));
  lying.update();
  Bytes bytes = lying.snapshot();
  World2 world;
  const Handle handle = world.add(at(7));
  world.add(at(7));
  world.update();
  const Bytes before = world.snapshot();
  // The first box, which follows the slots' number: there it lies apart from the other.
  const std::array<float, 4> apart = {100, 0, 101, 1};
  const std::size_t place = 24 + 4 + 3 * 8 + 8 + 4 + 4 + 8 + 8;
  ASSERT_EQ(std::memcmp(bytes.data() + place, std::array<float, 4>{0, 0, 1, 1}.data(), 16), 0);
  std::memcpy(bytes.data() + place, apart.data(), 16);
  seal(bytes);
  EXPECT_THAT(message_of<InvalidSnapshot>([&] { world.restore(bytes); }), HasSubstr("contradicts itself"));
  EXPECT_EQ(world.snapshot(), before);
  world.move(handle, at(8));
  EXPECT_TRUE(world.update().ended.empty());
  world.move(handle, at(80));
  EXPECT_EQ(world.update().ended.size(), 1u);
}

TEST(Snapshot, HasTheBytesThatTheDocumentationSays) {
  World2 world("brute_force");
  const Handle first = world.add(at(0));
  const Handle second = world.add(at(1));
  world.add(at(9));
  world.update();
  world.remove(second);
  world.move(first, at(2));
  std::string text;
  for (const std::byte byte : world.snapshot()) text += fmt::format("{:02x}", static_cast<unsigned>(byte));
  // One part a line; docs/snapshot-format.md has the same. A change of these bytes is a new version.
  EXPECT_EQ(text,
            "894257530d0a1a0a"                  // magic number
            "03000000"                          // version 3
            "02040201"                          // 2D, coordinates of 4 bytes, byte order
            "9301000000000000"                  // length: 403
            "43000000"                          // flags: keeps pairs, own algorithm, has had an update
            "0000000000000000"                  // margin 0
            "0000000000000000"                  // relative margin 0
            "0000000000000000"                  // 0 predicted frames
            "0b00000000000000"                  // 11 characters
            "62727574655f666f726365"            // brute_force
            "00000000"                          // generation of new slots: 0
            "0100000000000000"                  // 1 pair
            "0300000000000000"                  // 3 slots
            "0000004000000000000040400000803f"  // slot 0: (2, 0) to (3, 1)
            "0000807f0000807f000080ff000080ff"  // slot 1: absent
            "0000104100000000000020410000803f"  // slot 2: (9, 0) to (10, 1)
            "000000000000000000000000"          // generations
            "010201"                            // live, removed, live
            "0100000000000000"                  // 1 removed box
            "010000000000803f00000000000000400000803f"  // slot 1: (1, 0) to (2, 1)
            "0000000000000000"                          // no removal was told
            "0200000000000000"                          // 2 changed slots
            "0100000000000000"                          // 1, 0
            "0000000000000000"                          // no box left its enlarged one
            "0000000000000000"                          // no pair is to be asked about again
            "0000000000000000"                          // no ignored pairs
            "0000000000000000"                          // none that changed
            "02"                                        // last frame: no filters, a set of ignored pairs
            "0300000000000000"                          // of 3 boxes
            "0200000000000000"                          // 2 of them otherwise than now
            "0000000001000000"                          // 0, 1
            "00000000000000000000803f0000803f"          // box 0: (0, 0) to (1, 1)
            "0000803f00000000000000400000803f"          // box 1: (1, 0) to (2, 1)
            "0000000000000000"                          // no other filters
            "0000000000000000"                          // no ignored pairs
            "0100000000000000"                          // 1 pair
            "0000000001000000"                          // (0, 1)
            "0100000000000000"                          // 1 began
            "0000000001000000"                          // (0, 1)
            "0000000000000000"                          // none ended
            "0000000000000000"                          // no pairs of enlarged boxes
            "0000000000000000000000000000000000000000"  // no events of a failed update: five lists
            "0000000000000000000000000000000000000000"
            "a0fac269");  // checksum
}

}  // namespace
}  // namespace broadside
