// The recorder writes the bytes that docs/trace-format.md shows, stores only what changed, and says what
// failed.
#include "broadside/recorder.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lab/formats/format.hpp"
#include "lab/scenes/motion.hpp"
#include "tests/support/files.hpp"
#include "tests/support/message.hpp"
#include "tests/support/tape.hpp"

namespace broadside {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

constexpr std::size_t empty_frame = trace::header_bytes + trace::checksum_bytes;
constexpr std::size_t removal = 4;
constexpr std::size_t flat_box = 4 + 4 * 4;

/// Bytes as docs/trace-format.md shows them.
std::string hexadecimal(const std::string& bytes) {
  std::string text;
  for (const unsigned char byte : bytes) {
    constexpr const char* digits = "0123456789abcdef";
    text += {digits[byte >> 4], digits[byte & 15], ' '};
  }
  return text;
}

/// The bytes of an example of docs/trace-format.md under its heading: the pairs of digits with which the
/// lines begin.
std::string documented_example(const std::string& heading = "## An example") {
  std::ifstream file(BROADSIDE_SOURCE_DIR "/docs/trace-format.md");
  std::string text;
  std::string example;
  while (std::getline(file, text) && text != heading) continue;
  while (std::getline(file, text) && !text.starts_with("## ")) {
    std::istringstream line(text);
    const auto is_byte = [](const std::string& word) {
      return word.size() == 2 && word.find_first_not_of("0123456789abcdef") == std::string::npos;
    };
    for (std::string word; line >> word && is_byte(word);) example += word + " ";
  }
  return example;
}

template <int D>
bool set_boxes(Tape<D>& tape, const std::vector<float>& boxes) {
  return tape.recorder.set_boxes(boxes.data(), boxes.size() / (2 * D));
}

class RecorderFiles : public lab::Files {
 protected:
  /// What an engine of C++11 prints that records what `script` says to the file `name`.
  std::string run_engine(const std::string& engine, const std::string& name, const std::string& arguments,
                         const std::string& script) const {
    const std::string command = engine + " " + path(name).string() + " " + arguments + " < " +
                                put("script", script).string() + " > " + path("output").string();
    [[maybe_unused]] const int status = std::system(command.c_str());
    return text_of("output");
  }
};

TEST(TraceChecksum, IsCrc32c) {
  const auto checksum_of = [](const std::string& text) {
    trace::Checksum checksum;
    checksum.add(reinterpret_cast<const unsigned char*>(text.data()), text.size());
    return checksum.value();
  };
  EXPECT_EQ(checksum_of(""), 0u);
  EXPECT_EQ(checksum_of("123456789"), 0xe3069283u);
  // RFC 3720, appendix B.4: 32 bytes of zero, and of one.
  EXPECT_EQ(checksum_of(std::string(32, '\0')), 0x8a9136aau);
  EXPECT_EQ(checksum_of(std::string(32, '\xff')), 0x62a8ab43u);
}

TEST(TraceChecksum, DoesNotDependOnHowTheBytesArrive) {
  const std::string text = "the bytes of a frame come in pieces of any size";
  const auto* const bytes = reinterpret_cast<const unsigned char*>(text.data());
  trace::Checksum whole;
  whole.add(bytes, text.size());
  for (std::size_t cut = 0; cut <= text.size(); ++cut) {
    trace::Checksum parts;
    parts.add(bytes, cut);
    parts.add(bytes + cut, text.size() - cut);
    EXPECT_EQ(parts.value(), whole.value());
  }
}

TEST(Recorder, WritesTheBytesThatTheFormatShows) {
  EXPECT_EQ(hexadecimal(small_trace()), documented_example());
}

TEST(Recorder, WritesPairsAsTheFormatShows) {
  EXPECT_EQ(hexadecimal(small_trace_with_pairs()), documented_example("## An example with pairs"));
}

TEST(Recorder, WritesDoublesAndThreeAxesAlike) {
  Tape<3, double> tape;
  EXPECT_EQ(tape.bytes.substr(12, 4), std::string("\x03\x08\0\0", 4));
  tape.set(0, {0, 0, 0, 1, 1, 1});
  EXPECT_EQ(tape.end_frame(), empty_frame + 4 + 6 * 8);
  EXPECT_EQ(hexadecimal(tape.bytes.substr(tape.bytes.size() - 12, 8)), "00 00 00 00 00 00 f0 3f ");
}

TEST(Recorder, StoresOnlyWhatChanged) {
  Tape<2> tape;
  tape.set(0, {0, 0, 1, 1});
  tape.set(1, {0, 0, 1, 1});
  EXPECT_EQ(tape.end_frame(), empty_frame + 2 * flat_box);
  EXPECT_EQ(tape.end_frame(), empty_frame) << "nothing was said";
  tape.set(0, {0, 0, 1, 1});
  EXPECT_EQ(tape.end_frame(), empty_frame) << "nothing moved";
  tape.set(0, {0, 0, 2, 2});
  tape.set(0, {0, 0, 1, 1});
  tape.recorder.remove(1);
  tape.set(1, {0, 0, 1, 1});
  EXPECT_EQ(tape.end_frame(), empty_frame) << "all came back to where it was";
  tape.set(1, {0, 0, 1, 2});
  EXPECT_EQ(tape.end_frame(), empty_frame + flat_box);
  tape.recorder.remove(1);
  EXPECT_EQ(tape.end_frame(), empty_frame + removal);
  tape.recorder.remove(1);
  tape.recorder.remove(77);
  EXPECT_EQ(tape.end_frame(), empty_frame) << "was gone already";
}

TEST(Recorder, StoresAsMuchOfAFrameWhateverTheNumberOfBoxes) {
  for (const std::uint32_t slots : {100U, 10'000U}) {
    Tape<2> tape;
    for (const bool is_later : {false, true}) {
      for (std::uint32_t slot = 0; slot < slots; ++slot) {
        const bool has_moved = is_later && (slot == 7 || slot == 50 || slot == 99);
        tape.set(slot, {0, 0, 1, has_moved ? 2.0F : 1.0F});
      }
      EXPECT_EQ(tape.end_frame(), empty_frame + (is_later ? 3 : slots) * flat_box) << slots << " slots";
    }
  }
}

TEST(Recorder, TellsMinusZeroFromZero) {
  Tape<2> tape;
  tape.set(0, {0, 0, 1, 1});
  tape.end_frame();
  tape.set(0, {-0.0F, 0, 1, 1});
  EXPECT_EQ(tape.end_frame(), empty_frame + flat_box);
}

TEST(Recorder, TakesTheAbsentBoxForARemoval) {
  Tape<2> removed;
  Tape<2> absent;
  for (Tape<2>* tape : {&removed, &absent}) {
    tape->set(0, {0, 0, 1, 1});
    tape->end_frame();
  }
  removed.recorder.remove(0);
  absent.set(0, {infinity, infinity, -infinity, -infinity});
  EXPECT_EQ(removed.end_frame(), absent.end_frame());
  EXPECT_EQ(removed.bytes, absent.bytes);
}

TEST(Recorder, WritesTheSameWhetherBoxesComeOneByOneOrAllAtOnce) {
  Tape<2> one_by_one;
  Tape<2> at_once;
  one_by_one.set(1, {5, 5, 6, 6});
  one_by_one.set(0, {0, 0, 1, 1});
  set_boxes(at_once, {0, 0, 1, 1, 5, 5, 6, 6});
  EXPECT_EQ(one_by_one.end_frame(), at_once.end_frame());

  one_by_one.recorder.resize(1);
  set_boxes(at_once, {0, 0, 1, 1});
  EXPECT_EQ(one_by_one.end_frame(), at_once.end_frame());

  one_by_one.recorder.resize(2);
  one_by_one.recorder.resize(3);
  one_by_one.set(0, {0, 0, 1, 3});
  set_boxes(at_once,
            {0, 0, 1, 3, infinity, infinity, -infinity, -infinity, infinity, infinity, -infinity, -infinity});
  EXPECT_EQ(one_by_one.end_frame(), empty_frame + 2 * removal + flat_box);
  at_once.end_frame();
  EXPECT_EQ(one_by_one.bytes, at_once.bytes);
}

TEST(Recorder, KnowsThatASlotCutOffAndBroughtBackInOneFrameIsEmpty) {
  Tape<2> tape;
  set_boxes(tape, {0, 0, 1, 1, 5, 5, 6, 6});
  tape.end_frame();
  tape.recorder.resize(0);
  tape.recorder.resize(2);
  tape.set(0, {0, 0, 1, 1});
  EXPECT_EQ(tape.end_frame(), empty_frame + removal);
}

TEST(Recorder, RefusesWhatIsNoBoxAndGoesOn) {
  const std::vector<std::pair<std::vector<float>, std::string>> wrong = {
      {{nan, 0, 1, 1}, "nan"},
      {{0, 0, 1, -nan}, "nan"},
      {{0, 2, 1, 1}, "min (0.000000, 2.000000)"},
      {{infinity, 0, -infinity, 1}, "max (-inf, 1.000000)"}};
  for (const auto& [box, found] : wrong) {
    Tape<2> tape;
    tape.set(3, {0, 0, 1, 1});
    tape.end_frame();
    EXPECT_FALSE(tape.set(3, box));
    EXPECT_FALSE(set_boxes(tape, box));
    EXPECT_FALSE(tape.set(9, box));
    EXPECT_EQ(tape.end_frame(), empty_frame) << "a refused box changes nothing, not even the number of slots";
    EXPECT_TRUE(tape.set(3, {0, 0, 1, 2}));
    EXPECT_EQ(tape.end_frame(), empty_frame + flat_box);
    EXPECT_THAT(tape.recorder.error(), AllOf(HasSubstr("slot 3"), HasSubstr(found), HasSubstr("min <= max")));
    EXPECT_FALSE(tape.recorder.close());
  }
}

TEST(Recorder, TakesInfiniteAndDegenerateBoxes) {
  Tape<2> tape;
  EXPECT_TRUE(tape.set(0, {-infinity, 0, infinity, 0}));
  EXPECT_TRUE(tape.set(1, {infinity, infinity, infinity, infinity}));
  EXPECT_TRUE(tape.set(2, {0.0F, 0, -0.0F, 0}));
  EXPECT_EQ(tape.end_frame(), empty_frame + 3 * flat_box);
  EXPECT_TRUE(tape.recorder.close());
}

TEST(Recorder, RefusesMoreSlotsThanTheFormatHas) {
  Tape<2> tape;
  const std::vector<float> box = {0, 0, 1, 1};
  EXPECT_FALSE(tape.set(0xffffffff, box));
  EXPECT_THAT(tape.recorder.error(), HasSubstr("slot 4294967295"));
  Tape<2> other;
  EXPECT_FALSE(other.recorder.resize(std::size_t{1} << 32));
  EXPECT_THAT(other.recorder.error(), HasSubstr("4294967296 slots"));
}

constexpr std::size_t empty_pairs_frame = empty_frame + trace::pair_count_bytes;

/// A tape of boxes in slots 0 to 2, all on the same place, and the pair (0, 1).
struct PairTape : Tape<2> {
  PairTape() : Tape<2>(0.0) {
    for (std::uint32_t slot = 0; slot < 3; ++slot) set(slot, {0, 0, 1, 1});
    recorder.add_pair(0, 1);
    end_frame();
  }
};

TEST(Recorder, StoresOnlyWhatChangedOfPairs) {
  PairTape tape;
  tape.recorder.add_pair(1, 0);
  EXPECT_EQ(tape.end_frame(), empty_pairs_frame) << "the same pair";
  tape.recorder.add_pair(0, 1);
  tape.recorder.add_pair(0, 1);
  EXPECT_EQ(tape.end_frame(), empty_pairs_frame + trace::pair_bytes) << "reported twice";
  EXPECT_EQ(tape.end_frame(), empty_pairs_frame + 2 * trace::pair_bytes) << "no longer reported";
  tape.recorder.ignore_pair(0, 1);
  tape.recorder.ignore_pair(1, 0);
  EXPECT_EQ(tape.end_frame(), empty_pairs_frame + trace::pair_bytes) << "ignored once";
  tape.recorder.set_filter(0, 1, ~std::uint64_t{0});
  tape.recorder.ignore_pair(0, 1);
  EXPECT_EQ(tape.end_frame(), empty_pairs_frame) << "the standard filter";
  tape.recorder.set_filter(0, 2, 4);
  tape.recorder.ignore_pair(0, 1);
  EXPECT_EQ(tape.end_frame(), empty_pairs_frame + trace::filter_bytes);
}

TEST(Recorder, ForgetsTheFilterOfABoxThatIsGone) {
  PairTape tape;
  tape.recorder.set_filter(2, 2, 4);
  tape.end_frame();
  tape.recorder.remove(2);
  tape.set(2, {0, 0, 1, 1});
  EXPECT_EQ(tape.end_frame(), empty_pairs_frame + trace::filter_bytes) << "back in the same frame";
  tape.recorder.set_filter(2, 2, 4);
  tape.recorder.remove(2);
  EXPECT_EQ(tape.end_frame(), empty_pairs_frame + removal);
  tape.set(2, {0, 0, 1, 1});
  EXPECT_EQ(tape.end_frame(), empty_pairs_frame + flat_box) << "back in the next one";
}

TEST(Recorder, RefusesWrongPairsAndGoesOn) {
  const auto refused = [](const auto& call) {
    PairTape tape;
    tape.recorder.add_pair(0, 1);
    EXPECT_FALSE(call(tape.recorder));
    EXPECT_EQ(tape.end_frame(), empty_pairs_frame) << "a refused call changes nothing";
    return tape.recorder.error();
  };
  EXPECT_THAT(refused([](Recorder2& recorder) { return recorder.add_pair(2, 2); }),
              names("pair (2, 2)", "different"));
  EXPECT_THAT(refused([](Recorder2& recorder) { return recorder.add_pair(7, 0); }),
              names("pair (7, 0)", "slot 7", "empty"));
  EXPECT_THAT(refused([](Recorder2& recorder) { return recorder.ignore_pair(0, 7); }),
              names("pair (0, 7)", "slot 7", "empty"));
  EXPECT_THAT(refused([](Recorder2& recorder) { return recorder.set_filter(7, 1, 1); }),
              names("filter", "slot 7", "empty"));
}

TEST(Recorder, LeavesOutAPairWhoseSlotIsEmptiedBeforeTheFrameEnds) {
  PairTape tape;
  tape.recorder.add_pair(0, 1);
  tape.recorder.remove(1);
  const std::size_t before = tape.bytes.size();
  EXPECT_FALSE(tape.recorder.end_frame());
  EXPECT_EQ(tape.bytes.size() - before, empty_pairs_frame + removal + trace::pair_bytes);
  EXPECT_THAT(tape.recorder.error(), names("pair (0, 1)", "slot 1"));
  EXPECT_EQ(tape.end_frame(), empty_pairs_frame);
}

TEST(Recorder, TakesPairsOnlyWhereItWasOpenedWithAMargin) {
  Tape<2> tape;
  tape.set(0, {0, 0, 1, 1});
  tape.set(1, {0, 0, 1, 1});
  EXPECT_FALSE(tape.recorder.add_pair(0, 1));
  EXPECT_FALSE(tape.recorder.ignore_pair(0, 1));
  EXPECT_FALSE(tape.recorder.set_filter(0, 1, 1));
  EXPECT_EQ(tape.end_frame(), empty_frame + 2 * flat_box);
  EXPECT_THAT(tape.recorder.error(),
              HasSubstr("add_pair() in a trace without pairs; expected open() with a margin first"));
}

TEST(Recorder, SaysThatNothingIsOpen) {
  Recorder2 recorder;
  EXPECT_FALSE(recorder.end_frame());
  EXPECT_THAT(recorder.error(), AllOf(HasSubstr("end_frame()"), HasSubstr("open()")));
}

TEST(Recorder, WritesNothingMoreAfterAFailedWrite) {
  std::size_t taken = 0;
  std::size_t calls = 0;
  Recorder2 recorder;
  recorder.open_with([&](const void*, std::size_t count) {
    taken += count;
    return ++calls < 2;
  });
  EXPECT_FALSE(recorder.end_frame());
  EXPECT_FALSE(recorder.end_frame());
  EXPECT_FALSE(recorder.close());
  EXPECT_EQ(calls, 2u);
  EXPECT_THAT(recorder.error(), HasSubstr("cannot be written"));
}

TEST(Recorder, HandsOnLongFramesInPieces) {
  std::vector<float> boxes(4 * 20000, 1);
  std::size_t most = 0;
  std::size_t total = 0;
  Recorder2 recorder;
  recorder.open_with([&](const void*, std::size_t count) {
    most = std::max(most, count);
    total += count;
    return true;
  });
  recorder.set_boxes(boxes.data(), boxes.size() / 4);
  recorder.end_frame();
  EXPECT_EQ(total, trace::header_bytes + empty_frame + 20000 * flat_box);
  EXPECT_LE(most, std::size_t{1} << 16);
}

TEST_F(RecorderFiles, HoldEachFrameAsSoonAsItHasEnded) {
  Recorder2 recorder;
  ASSERT_TRUE(recorder.open(path("a.btrace").string()));
  EXPECT_EQ(text_of("a.btrace").size(), trace::header_bytes);
  recorder.resize(1);
  EXPECT_EQ(text_of("a.btrace").size(), trace::header_bytes) << "a frame under way is not written";
  ASSERT_TRUE(recorder.end_frame());
  EXPECT_EQ(text_of("a.btrace").size(), trace::header_bytes + empty_frame + removal);
  recorder.resize(2);
  EXPECT_TRUE(recorder.close());
  EXPECT_EQ(text_of("a.btrace").size(), trace::header_bytes + empty_frame + removal)
      << "a frame that was not ended is not written";
}

TEST_F(RecorderFiles, AreNotMadeWhereTheMarginIsNone) {
  const std::vector<std::pair<double, std::string>> wrong = {
      {-0.5, "-0.5"}, {std::numeric_limits<double>::infinity(), "inf"}, {nan, "nan"}};
  for (const auto& [margin, found] : wrong) {
    Recorder2 recorder;
    EXPECT_FALSE(recorder.open(path("a.btrace").string(), margin));
    EXPECT_THAT(recorder.error(), AllOf(HasSubstr("a.btrace: margin " + found),
                                        HasSubstr("expected a finite number, 0 or more")));
    EXPECT_FALSE(recorder.end_frame());
  }
  EXPECT_EQ(count_files(), 0u);
  Recorder2 recorder;
  EXPECT_TRUE(recorder.open(path("a.btrace").string(), -0.0));
  EXPECT_EQ(text_of("a.btrace").substr(16, 8), std::string(8, '\0'));
}

TEST_F(RecorderFiles, StartAnewWithEachOpen) {
  Recorder2 recorder;
  for (const char* name : {"a.btrace", "b.btrace"}) {
    const std::vector<float> box = {0, 0, 1, 1};
    recorder.set(0, box.data() + 2, box.data());
    ASSERT_TRUE(recorder.open(path(name).string()));
    EXPECT_EQ(recorder.error(), "");
    recorder.set(0, box.data(), box.data() + 2);
    recorder.end_frame();
  }
  recorder.close();
  EXPECT_EQ(text_of("a.btrace").size(), trace::header_bytes + empty_frame + flat_box);
  EXPECT_EQ(text_of("a.btrace"), text_of("b.btrace"));
}

TEST_F(RecorderFiles, ThatCannotBeWrittenAreNamedWithTheReason) {
  Recorder2 recorder;
  EXPECT_FALSE(recorder.open(path("no/such/folder.btrace").string()));
  EXPECT_THAT(recorder.error(), AllOf(HasSubstr("no/such/folder.btrace"), HasSubstr("No such file")));
  EXPECT_FALSE(recorder.end_frame());
  EXPECT_THAT(recorder.error(), HasSubstr("No such file")) << "the first failure is the one to know";
  EXPECT_FALSE(recorder.open("/dev/full"));
  EXPECT_THAT(recorder.error(), AllOf(HasSubstr("/dev/full"), HasSubstr("No space left")));
}

TEST_F(RecorderFiles, FromAnEngineOfCxx11AreTheSameWhateverItIsCompiledWith) {
  const std::string script =
      "set 0 0 0 1 1\nset 2 2 0.5 4 3\nend_frame\nset 0 0.25 0 1.25 1\nremove 2\nend_frame\n";
  for (const char* engine : {PLAIN_ENGINE, FAST_ENGINE}) {
    EXPECT_EQ(run_engine(engine, "a.btrace", "2 4", script), "");
    EXPECT_EQ(hexadecimal(text_of("a.btrace")), documented_example()) << engine;
    EXPECT_THAT(run_engine(engine, "b.btrace", "2 8", "set 7 nan 0 1 1\n"),
                HasSubstr("slot 7 is given min (nan"))
        << "-ffast-math must not let a NaN through";
    EXPECT_EQ(run_engine(engine, "b.btrace", "3 8", "set 7 -inf -inf -inf inf inf inf\nend_frame\n"), "");
    EXPECT_THAT(run_engine(engine, "b.btrace", "3 4", "set 7 0 0 inf 1 1 -inf\n"), HasSubstr("slot 7"));
  }
}

TEST_F(RecorderFiles, WithPairsFromAnEngineOfCxx11AreTheSameWhateverItIsCompiledWith) {
  const std::string script =
      "set 0 0 0 1 1\nset 1 1 0 2 1\nset 2 1 1 3 2\nset_filter 0 2 5 -1 1\nadd_pair 2 1\nadd_pair 0 1\n"
      "ignore_pair 0 2\nend_frame\nset 1 2 0 3 1\nadd_pair 1 2\nadd_pair 1 2\nend_frame\n";
  for (const char* engine : {PLAIN_ENGINE, FAST_ENGINE}) {
    EXPECT_EQ(run_engine(engine, "a.btrace", "2 4 0.5", script), "");
    EXPECT_EQ(hexadecimal(text_of("a.btrace")), documented_example("## An example with pairs")) << engine;
    for (const char* margin : {"nan", "inf", "-1"})
      EXPECT_THAT(run_engine(engine, "b.btrace", std::string("2 4 ") + margin, ""),
                  HasSubstr("b.btrace: margin"));
  }
}

/// A history as a script for the engine. The hexadecimal form of a float says all its bits.
template <int D>
std::string script_of(const lab::History<D>& history) {
  std::string script;
  const auto set = [&](std::uint32_t slot, const Box<D>& box) {
    script += fmt::format("set {} {:a} {:a}\n", slot, fmt::join(box.min, " "), fmt::join(box.max, " "));
  };
  script += fmt::format("resize {}\n", history.boxes.size());
  for (std::uint32_t slot = 0; slot < history.boxes.size(); ++slot) set(slot, history.boxes[slot]);
  script += "end_frame\n";
  for (const lab::Step<D>& step : history.steps) {
    script += fmt::format("resize {}\n", step.size);
    for (std::size_t i = 0; i < step.changed.size(); ++i) {
      const std::uint32_t slot = index(step.changed[i]);
      if (is_absent(step.boxes[i]))
        script += fmt::format("remove {}\n", slot);
      else
        set(slot, step.boxes[i]);
    }
    script += "end_frame\n";
  }
  return script;
}

TEST_F(RecorderFiles, FromAnEngineAreThoseTheLabWritesByteForByte) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto flat = lab::random_history<2>({.boxes = 30, .frames = 20, .seed = seed});
    lab::write_scene(flat, path("lab.btrace"));
    EXPECT_EQ(run_engine(PLAIN_ENGINE, "engine.btrace", "2 4", script_of(flat)), "");
    EXPECT_EQ(text_of("engine.btrace"), text_of("lab.btrace"));

    const auto solid = lab::random_history<3>({.boxes = 30, .frames = 20, .seed = seed});
    lab::write_scene(solid, path("lab.btrace"));
    EXPECT_EQ(run_engine(FAST_ENGINE, "engine.btrace", "3 4", script_of(solid)), "");
    EXPECT_EQ(text_of("engine.btrace"), text_of("lab.btrace"));
  }
}

}  // namespace
}  // namespace broadside
