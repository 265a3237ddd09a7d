// An engine's recorded pairs: what is missed, stale or reported twice is named by frame and pair, and shown
// on two boxes.
#include "lab/verify/verify_recorded.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/world.hpp"

#include "lab/scenes/motion.hpp"
#include "lab/scenes/random.hpp"
#include "lab/verify/verify.hpp"
#include "lab/verify/verify_file.hpp"
#include "tests/support/files.hpp"
#include "tests/support/message.hpp"
#include "tests/support/recorded.hpp"
#include "tests/support/tape.hpp"

namespace broadside::lab {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class VerifyRecorded : public Files {
 protected:
  VerifyRecorded() {
    options_.algorithms = "brute_force";
    options_.counterexample = path("small.btrace");
  }

  Verification verified(const std::filesystem::path& file) const {
    return verify_file(Catalogue(), open_file(file), options_);
  }

  template <typename Report>
  Verification verified(const Report& report) const {
    return verified(put("falling.btrace", falling_box(report)));
  }

  /// The verification of the counterexample, which must fail again.
  Verification shown_again(const Verification& verification) const {
    EXPECT_TRUE(verification.counterexample);
    EXPECT_EQ(verification.counterexample->boxes, 2u);
    Verification again = verified(path("small.btrace"));
    EXPECT_FALSE(again.all_verified());
    EXPECT_THAT(again.verdicts[0].reason, StartsWith(verification.counterexample->fault + "\n"));
    return again;
  }

  VerifyOptions options_;
};

TEST_F(VerifyRecorded, PassesAnEngineThatKeepsItsPromise) {
  const Verification verification = verified(report_rightly);
  EXPECT_TRUE(verification.all_verified());
  EXPECT_FALSE(verification.counterexample);
  EXPECT_THAT(lab::text_of(verification),
              names("recorded pairs  verified", "brute_force     verified", "margin 0.25"));
}

TEST_F(VerifyRecorded, NamesAMissedPairAndShowsItsTwoBoxesBeforeAndThen) {
  const Verification verification = verified([](Recorder2& recorder, std::size_t frame) {
    if (frame == 4) recorder.add_pair(0, 1);
  });
  EXPECT_EQ(verification.verdicts[0].outcome, Outcome::failed);
  EXPECT_THAT(verification.verdicts[0].reason,
              names("frame 3, pair (0, 1) is missed", "never reported", "box 0 is [(-5, 0), (5, 1)]",
                    "box 1 is [(0, 1), (1, 2)]", "1 missed, 0 stale, 0 reported more than once"));
  EXPECT_EQ(verification.counterexample->frames, 2u);
  EXPECT_EQ(verification.counterexample->command, "verify " + path("small.btrace").string());
  EXPECT_THAT(lab::text_of(verification), names("small.btrace", "2 boxes, 2 frames", "broadside verify "));
  EXPECT_THAT(shown_again(verification).verdicts[0].reason, HasSubstr("frame 1, pair (0, 1) is missed"));
}

TEST_F(VerifyRecorded, SaysSinceWhenAPairIsNotReported) {
  const Verification verification = verified([](Recorder2& recorder, std::size_t frame) {
    if (frame == 3) recorder.add_pair(0, 1);
  });
  EXPECT_THAT(verification.verdicts[0].reason,
              names("frame 4, pair (0, 1) is missed", "last reported in frame 3"));
  EXPECT_THAT(shown_again(verification).verdicts[0].reason, HasSubstr("last reported in frame 0"));
}

TEST_F(VerifyRecorded, NamesAStalePair) {
  const Verification verification = verified([](Recorder2& recorder, std::size_t frame) {
    if (frame > 2) recorder.add_pair(0, 1);
  });
  EXPECT_THAT(verification.verdicts[0].reason,
              names("frame 5, pair (0, 1) is stale", "2 apart along y", "margin of 0.25", "0.5"));
  shown_again(verification);
}

TEST_F(VerifyRecorded, TakesAPairWithinTheMarginAndNoneBeyondIt) {
  const auto early = [](Recorder2& recorder, std::size_t frame) {
    if (frame > 1 && frame < 5) recorder.add_pair(0, 1);  // in frame 2, the boxes are 1 apart
  };
  put("exact.btrace", falling_box(early, 0.5));
  const Verification exact = verified(path("exact.btrace"));
  EXPECT_TRUE(exact.all_verified());
  EXPECT_EQ(exact.verdicts[0].reason, "margin 0.5, needed 0.5");
  put("less.btrace", falling_box(early, 0.4999));
  EXPECT_THAT(verified(path("less.btrace")).verdicts[0].reason,
              names("frame 2, pair (0, 1) is stale", "a margin of 0.5 allows all that are stale"));
}

TEST_F(VerifyRecorded, NamesAPairThatIsReportedTwice) {
  const Verification verification = verified([](Recorder2& recorder, std::size_t frame) {
    report_rightly(recorder, frame);
    if (frame == 4) recorder.add_pair(0, 1);
    if (frame == 4) recorder.add_pair(1, 0);
  });
  EXPECT_THAT(verification.verdicts[0].reason, names("frame 4, pair (0, 1) is reported more than once",
                                                     "3 times", "0 missed, 0 stale, 1 reported"));
  shown_again(verification);
}

TEST_F(VerifyRecorded, DemandsNoPairThatFiltersRejectOrThatIsIgnored) {
  EXPECT_TRUE(verified([](Recorder2& recorder, std::size_t frame) {
                if (frame == 3 || frame == 4) recorder.ignore_pair(0, 1);
              }).all_verified());
  EXPECT_TRUE(verified([](Recorder2& recorder, std::size_t frame) {
                if (frame == 0) recorder.set_filter(0, 2, 4);
              }).all_verified());
  const Verification emptied = verified([](Recorder2& recorder, std::size_t frame) {
    if (frame == 0) recorder.set_filter(0, 2, 4);
    if (frame == 2) recorder.remove(0);
  });
  EXPECT_THAT(emptied.verdicts[0].reason, HasSubstr("frame 3, pair (0, 1) is missed"))
      << "a new box in the slot has no filter";
  shown_again(emptied);
}

TEST_F(VerifyRecorded, TellsTheFirstFaultsByTheirFrames) {
  const Verification verification =
      verified([](Recorder2& recorder, std::size_t) { recorder.add_pair(0, 2); });
  EXPECT_THAT(verification.verdicts[0].reason,
              names("6 frames", "2 missed, 6 stale, 0 reported", "all name box 0",
                    "frames 0 to 5: pair (0, 2) stale", "frames 3 to 4: pair (0, 1) missed"));
  EXPECT_EQ(verification.counterexample->frames, 1u) << "it is wrong from the beginning";
}

/// A recording of boxes that come, move and go, and of all pairs that overlap; in one frame, `spoil` changes
/// them.
template <typename Spoil>
Recording<2, float> random_recording(std::uint64_t seed, std::size_t spoilt_frame, const Spoil& spoil) {
  Recording<2, float> recording{
      random_history<2>({.boxes = 25, .frames = 12, .seed = seed, .infinite_boxes = false})};
  std::vector<Box2> boxes = recording.history.boxes;
  std::vector<Pair> before;
  for (std::size_t frame = 0; frame <= recording.history.steps.size(); ++frame) {
    if (frame > 0) lab::apply(recording.history.steps[frame - 1], boxes);
    std::vector<Pair> now = reference_pairs<2>(boxes);
    if (frame == spoilt_frame) spoil(now, boxes);
    std::ranges::sort(now);
    RecordedPairs changes;
    std::ranges::set_difference(before, now, std::back_inserter(changes.ended));
    std::ranges::set_difference(now, before, std::back_inserter(changes.begun));
    recording.pairs.push_back(std::move(changes));
    before = std::move(now);
  }
  return recording;
}

/// The recording has no fault but this one, and its smallest form has it as well.
void expect_the_one_fault(const Recording<2, float>& recording, RecordedFault::Kind kind, std::size_t frame) {
  const auto verdict = [](const Recording<2, float>& some) {
    return verify_recorded<2, float>(some, {}, {});
  };
  const RecordedVerdict found = verdict(recording);
  ASSERT_TRUE(found.first);
  EXPECT_EQ(found.first->kind, kind);
  EXPECT_EQ(found.first->first_frame, frame);
  EXPECT_EQ(found.first->last_frame, frame);
  const RecordedVerdict again = verdict(smallest_recording<2, float>(recording, *found.first));
  ASSERT_TRUE(again.first);
  EXPECT_EQ(again.first->kind, kind);
  EXPECT_EQ(again.first->first_frame, frame == 0 ? 0u : 1u);
  EXPECT_EQ(again.first->pair, (Pair{BoxId{0}, BoxId{1}}));
}

TEST(VerifyRecordedAtRandom, FindsOneFaultAndNoOther) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const auto frame = static_cast<std::size_t>(random.below(13));
    const auto nothing = [](std::vector<Pair>&, const std::vector<Box2>&) {};
    EXPECT_FALSE((verify_recorded<2, float>(random_recording(seed, frame, nothing), {}, {}).first));
    bool is_spoilt = false;
    const auto any = [&](const std::vector<Pair>& pairs) {
      is_spoilt = !pairs.empty();
      return static_cast<std::ptrdiff_t>(is_spoilt ? random.below(pairs.size()) : 0);
    };
    const auto dropped = [&](std::vector<Pair>& pairs, const std::vector<Box2>&) {
      const std::ptrdiff_t at = any(pairs);
      if (is_spoilt) pairs.erase(pairs.begin() + at);
    };
    const auto repeated = [&](std::vector<Pair>& pairs, const std::vector<Box2>&) {
      const std::ptrdiff_t at = any(pairs);
      if (is_spoilt) pairs.push_back(Pair(pairs[static_cast<std::size_t>(at)]));
    };
    const auto added = [&](std::vector<Pair>& pairs, const std::vector<Box2>& boxes) {
      is_spoilt = false;
      for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        for (std::uint32_t j = i + 1; j < boxes.size() && !is_spoilt; ++j) {
          is_spoilt = is_present(boxes[i]) && is_present(boxes[j]) && !overlap(boxes[i], boxes[j]);
          if (is_spoilt) pairs.push_back({BoxId{i}, BoxId{j}});
        }
      }
    };
    const Recording<2, float> missed = random_recording(seed, frame, dropped);
    if (is_spoilt) expect_the_one_fault(missed, RecordedFault::Kind::missed, frame);
    const Recording<2, float> twice = random_recording(seed, frame, repeated);
    if (is_spoilt) expect_the_one_fault(twice, RecordedFault::Kind::repeated, frame);
    const Recording<2, float> stale = random_recording(seed, frame, added);
    if (is_spoilt) expect_the_one_fault(stale, RecordedFault::Kind::stale, frame);
  }
}

/// What a world reports of moving boxes, a fifth of them static.
std::string trace_of_world(const WorldOptions& options, double margin) {
  const NamedScene scene = find_scene("uniform");
  const History<2> history =
      make_history<2>(scene.scene, scene.spec, {.boxes = 200, .frames = 30, .moving = 0.6});
  Tape<2> tape(margin);
  World2 world(options);
  std::vector<Handle> handles;
  const auto set = [&](std::size_t slot, const Box2& box) {
    tape.set(static_cast<std::uint32_t>(slot), {box.min[0], box.min[1], box.max[0], box.max[1]});
  };
  const auto end_frame = [&] {
    world.update();
    for (const HandlePair& pair : world.pairs()) tape.recorder.add_pair(pair.first.slot, pair.second.slot);
    tape.end_frame();
  };
  for (std::size_t i = 0; i < history.boxes.size(); ++i) {
    const bool is_static = i % 5 == 0;
    handles.push_back(world.add(history.boxes[i], {.filter = {.is_static = is_static}}));
    EXPECT_EQ(handles[i].slot, i);
    set(i, history.boxes[i]);
    tape.recorder.set_filter(handles[i].slot, 1, ~std::uint64_t{0}, 0, is_static);
  }
  end_frame();
  for (const Step<2>& step : history.steps) {
    for (std::size_t i = 0; i < step.changed.size(); ++i) {
      world.move(handles[index(step.changed[i])], step.boxes[i]);
      set(index(step.changed[i]), step.boxes[i]);
    }
    end_frame();
  }
  EXPECT_EQ(tape.recorder.error(), "");
  return tape.bytes;
}

TEST_F(VerifyRecorded, PassesAWorldWithExactAndWithEnlargedPairs) {
  put("exact.btrace", trace_of_world({}, 0));
  EXPECT_TRUE(verified(path("exact.btrace")).all_verified());
  constexpr double margin = 0.25;
  const WorldOptions enlarged{.margin = margin, .events = WorldEvents::enlarged};
  // A box is enlarged to all sides, and may then move as far to one of them.
  put("enlarged.btrace", trace_of_world(enlarged, 2.0001 * margin));
  EXPECT_TRUE(verified(path("enlarged.btrace")).all_verified());
  put("promising.btrace", trace_of_world(enlarged, margin / 2));
  EXPECT_THAT(verified(path("promising.btrace")).verdicts[0].reason, HasSubstr(" is stale: "));
}

TEST_F(VerifyRecorded, StopsWhereTheBudgetIsUsedUp) {
  options_.budget_seconds = 1e-9;
  put("falling.btrace", falling_box(report_rightly));
  EXPECT_THAT(verified(path("falling.btrace")).verdicts[0].reason,
              HasSubstr("margin 0.25, needed 0; frames 0 to 0 of 5; budget 1e-09 s"));
}

TEST_F(VerifyRecorded, RefusesACounterexampleInAFormatWithoutPairs) {
  options_.counterexample = path("small.csv");
  put("falling.btrace", falling_box(report_rightly));
  EXPECT_THAT(message_of<FileError>([&] { verified(path("falling.btrace")); }),
              AllOf(HasSubstr("small.csv: would hold recorded pairs"), HasSubstr("expected a .btrace")));
}

}  // namespace
}  // namespace broadside::lab
