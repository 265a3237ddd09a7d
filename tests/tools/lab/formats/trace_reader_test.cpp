// Traces: every history comes back bit for bit, a trace that was cut off is read up to there, and what is
// wrong is refused by frame and byte.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/recorder.hpp"

#include "lab/formats/format.hpp"
#include "lab/formats/trace/trace.hpp"
#include "lab/measure/memory.hpp"
#include "lab/scenes/motion.hpp"
#include "tests/fuzz/sealed_trace.hpp"
#include "tests/support/boxes.hpp"
#include "tests/support/files.hpp"
#include "tests/support/message.hpp"
#include "tests/support/tape.hpp"

namespace broadside::lab {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

using TraceFiles = Files;

/// A box as its bits: == takes -0.0 for 0.0.
template <int D>
using Bits = std::array<std::uint32_t, 2 * D>;

template <int D>
std::vector<std::vector<Bits<D>>> frame_bits(const History<D>& history) {
  std::vector<std::vector<Bits<D>>> frames;
  std::vector<Box<D>> boxes = history.boxes;
  const auto add = [&] {
    frames.emplace_back();
    for (const Box<D>& box : boxes) frames.back().push_back(std::bit_cast<Bits<D>>(box));
  };
  add();
  for (const Step<D>& step : history.steps) {
    lab::apply(step, boxes);
    add();
  }
  return frames;
}

template <int D>
std::optional<History<D>>& history_in(FileContent& content) {
  if constexpr (D == 2)
    return content.in_2d;
  else
    return content.in_3d;
}

/// How many frames of a trace are read, and what the reader says of its end.
std::pair<std::size_t, std::string> read_all(const std::string& bytes) {
  std::istringstream stream(bytes);
  TraceReader reader(stream, "t");
  while (reader.next_frame()) continue;
  EXPECT_FALSE(reader.next_frame()) << "the end is the end";
  return {reader.frames(), reader.warning()};
}

std::string trace_refusal(const std::string& bytes) {
  return message_of<FileError>([&] { read_all(bytes); });
}

/// The small trace with some bytes replaced, and the checksums made right again.
std::string small_trace_with(std::size_t at, const std::string& bytes) {
  return sealed_trace(small_trace().replace(at, bytes.size(), bytes));
}

template <int D>
void check_that_histories_come_back(const std::filesystem::path& path) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const History<D> history = random_history<D>({.boxes = 20, .seed = seed});
    write_scene(history, path);
    FileContent content = read_file(path);
    EXPECT_EQ(content.warning, "");
    EXPECT_FALSE(history_in<5 - D>(content));
    EXPECT_EQ(frame_bits(history_in<D>(content).value()), frame_bits(history)) << "seed " << seed;
  }
}

TEST_F(TraceFiles, GiveBackEveryFrameOfAnyHistoryBitForBit) {
  check_that_histories_come_back<2>(path("flat.btrace"));
  check_that_histories_come_back<3>(path("solid.btrace"));
}

TEST_F(TraceFiles, GiveBackHistoriesWithoutBoxesOrSteps) {
  for (const History<2>& history :
       {History<2>{}, History<2>{{absent_box<2>()}, {}}, History<2>{{}, {{0, {}, {}}, {1, {}, {}}}}}) {
    write_scene(history, path("a.btrace"));
    EXPECT_EQ(frame_bits(read_file(path("a.btrace")).in_2d.value()), frame_bits(history));
  }
}

TEST_F(TraceFiles, AreRecognisedByTheirFirstBytesWhateverTheyAreCalled) {
  EXPECT_TRUE(read_file(put("boxes.csv", small_trace())).in_2d);
  EXPECT_THAT(refusal(put("a.btrace", "mislaid\n")), HasSubstr("the first bytes are 6d 69"));
}

TEST_F(TraceFiles, AreScenesThatSayWhereTheyWereCutOff) {
  const Scene whole = file_scene(put("whole.btrace", small_trace()));
  EXPECT_EQ(whole.warning, "");
  EXPECT_EQ(make_history<2>(whole, Spec{"whole", {}}, {.frames = 9}).steps.size(), 1u);

  const Scene cut = file_scene(put("cut.btrace", small_trace().substr(0, 100)));
  EXPECT_THAT(cut.warning, HasSubstr("cut.btrace: is cut off in frame 1, which begins at byte 88"));
  EXPECT_EQ(make_history<2>(cut, Spec{"cut", {}}, {}).boxes.size(), 3u);
}

TEST_F(TraceFiles, WithoutOneWholeFrameAreNoScenes) {
  EXPECT_THAT(
      refusal(put("a.btrace", small_trace().substr(0, 80))),
      AllOf(HasSubstr("a.btrace: is cut off in frame 0"), HasSubstr("expected at least one whole frame")));
}

TEST_F(TraceFiles, OfDoublesAreExactAndRoundedToTheNearestWhereFloatsAreWanted) {
  Tape<2, double> tape;
  tape.set(0, {0.1, -0.1, 0.1, -0.1});
  tape.set(1, {-infinity, 1e300, infinity, 1e301});
  tape.set(3, {16777217, -0.5, 16777217, 1e-320});
  tape.end_frame();
  std::istringstream stream(tape.bytes);
  TraceReader reader(stream, "t");
  EXPECT_EQ(reader.coordinate_bytes(), 8);
  ASSERT_TRUE(reader.next_frame());
  EXPECT_THAT(reader.bounds(0), ElementsAre(0.1, -0.1, 0.1, -0.1));
  EXPECT_THAT(reader.bounds(1), ElementsAre(-infinity, 1e300, infinity, 1e301));
  EXPECT_THAT(reader.bounds(2), ElementsAre(infinity, infinity, -infinity, -infinity));

  constexpr float endless = std::numeric_limits<float>::infinity();
  const std::vector<Box2> nearest = {{{0.1F, -0.1F}, {0.1F, -0.1F}},
                                     {{-endless, endless}, {endless, endless}},
                                     absent_box<2>(),
                                     {{16777216, -0.5F}, {16777216, 0}}};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ((reader.box<2, float>(i)), nearest[i]);
  EXPECT_EQ(read_file(put("a.btrace", tape.bytes)).in_2d->boxes, nearest);

  const BoxFile file = open_file(path("a.btrace"));
  ASSERT_EQ(precision_of_frames(file.frames), Precision::float64);
  const std::vector<DoubleBox2> exact =
      std::get<std::unique_ptr<FrameReader<2, double>>>(file.frames)->first();
  EXPECT_EQ(exact[1], (DoubleBox2{{-infinity, 1e300}, {infinity, 1e301}}));
  EXPECT_EQ(exact[3], (DoubleBox2{{16777217, -0.5}, {16777217, 1e-320}}));
}

TEST(TraceReader, ReadsUpToTheLastWholeFrameWhereverATraceIsCutOff) {
  const std::string whole = small_trace();
  const std::vector<std::size_t> ends = {20, 88, whole.size()};
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    const std::string bytes = whole.substr(0, size);
    if (size < ends[0]) {
      EXPECT_THAT(trace_refusal(bytes), HasSubstr(size == 0 ? "empty" : "ends")) << "cut at byte " << size;
      continue;
    }
    const auto [frames, warning] = read_all(bytes);
    const auto ended = static_cast<std::size_t>(std::ranges::upper_bound(ends, size) - ends.begin()) - 1;
    EXPECT_EQ(frames, ended) << "cut at byte " << size;
    if (size == ends[ended])
      EXPECT_EQ(warning, "") << "cut at byte " << size;
    else
      EXPECT_THAT(warning, HasSubstr("t: is cut off in frame " + std::to_string(ended)))
          << "cut at byte " << size;
  }
}

TEST(TraceReader, SaysHowMuchOfAFrameIsThere) {
  EXPECT_THAT(read_all(small_trace().substr(0, 95)).second,
              EndsWith("frame 1, which begins at byte 88: has 7 of the 20 bytes of its header"));
  EXPECT_THAT(read_all(small_trace().substr(0, 110)).second,
              EndsWith("frame 1, which begins at byte 88: has 22 of its 48 bytes"));
}

TEST(TraceReader, FindsEveryWrongBit) {
  const std::string whole = small_trace();
  for (std::size_t byte = 0; byte < whole.size(); ++byte) {
    for (int bit = 0; bit < 8; ++bit) {
      std::string bytes = whole;
      bytes[byte] = static_cast<char>(bytes[byte] ^ 1 << bit);
      EXPECT_NE(trace_refusal(bytes), "") << "bit " << bit << " of byte " << byte;
    }
  }
}

TEST(TraceReader, FindsFramesThatAreMissingRepeatedOrSwapped) {
  Tape<2> tape;
  for (const float x : {0.0F, 1.0F, 2.0F}) {
    tape.set(0, {x, x, x, x});
    tape.end_frame();
  }
  const std::size_t size = tape.ends[1] - tape.ends[0];
  const std::string before = tape.bytes.substr(0, tape.ends[0]);
  const std::string second = tape.bytes.substr(tape.ends[0], size);
  const std::string third = tape.bytes.substr(tape.ends[1], size);
  EXPECT_EQ(read_all(before + second + third).first, 3u);
  EXPECT_THAT(trace_refusal(before + third), HasSubstr("t: frame 1, byte 80: checksum"));
  EXPECT_THAT(trace_refusal(before + second + second), HasSubstr("t: frame 2, byte"));
  EXPECT_THAT(trace_refusal(before + third + second), HasSubstr("t: frame 1, byte"));
}

TEST(TraceReader, GivesTheFramesBeforeTheOneThatIsWrong) {
  std::istringstream stream(small_trace_with(112, std::string(4, '\x05')));
  TraceReader reader(stream, "t");
  EXPECT_TRUE(reader.next_frame());
  EXPECT_THROW(reader.next_frame(), FileError);
  EXPECT_FALSE(reader.next_frame());
  EXPECT_EQ(reader.frames(), 1u);
}

TEST(TraceReader, RefusesWrongHeaders) {
  EXPECT_THAT(trace_refusal(""), names("empty", "20 bytes"));
  EXPECT_THAT(trace_refusal("\x89"
                            "BTx"),
              names("byte 0", "89 42 54 78", "89 42 54 52 0d 0a 1a 0a"));
  EXPECT_THAT(trace_refusal(small_trace().substr(0, 9)), names("byte 9", "20 bytes"));
  EXPECT_THAT(trace_refusal(small_trace_with(8, "\x03")), names("byte 8", "version 3", "1, or 2"));
  EXPECT_THAT(trace_refusal(small_trace_with(12, "\x04")), names("byte 12", "dimension 4", "2 or 3"));
  EXPECT_THAT(trace_refusal(small_trace_with(13, "\x02")), names("byte 13", "2 bytes", "4 or 8"));
  EXPECT_THAT(trace_refusal(small_trace_with(15, "\x01")), names("byte 14", "00 01", "00 00"));
  EXPECT_THAT(trace_refusal(small_trace().replace(16, 1, "\x02")),
              names("byte 16", "checksum 6c967902", "6c9679a1"));
}

TEST(TraceReader, RefusesWrongFrames) {
  using namespace std::string_literals;
  const auto refusal_with = [](std::size_t at, const std::string& bytes) {
    return trace_refusal(small_trace_with(at, bytes));
  };
  const std::string nan = "\0\0\xc0\x7f"s;
  const std::string infinite = "\0\0\x80\x7f"s;

  EXPECT_THAT(refusal_with(88, "fram"), names("frame 1", "byte 88", "66 72 61 6d", "46 52 41 4d"));
  EXPECT_THAT(trace_refusal(small_trace() + "x"),
              HasSubstr("t: frame 2, byte 136: 78; expected 46 52 41 4d"));
  EXPECT_THAT(trace_refusal(small_trace() + std::string(512, '\0')),
              HasSubstr("byte 136: 00 00 00 00; expected"));
  EXPECT_THAT(trace_refusal(small_trace().replace(104, 1, "\x01")),
              HasSubstr("t: frame 1, byte 104: checksum 5b076101; expected 5b07619f"));
  EXPECT_THAT(trace_refusal(small_trace().replace(134, 1, "\x01")),
              HasSubstr("t: frame 1, byte 132: checksum"));

  EXPECT_THAT(refusal_with(108, "\x03"), names("frame 1", "byte 108", "slot 3", "below 3"));
  EXPECT_THAT(refusal_with(112, "\xff\xff\xff\xff"),
              names("frame 1", "byte 112", "slot 4294967295", "below 3"));
  EXPECT_THAT(refusal_with(112, "\x02"), names("frame 1", "byte 112", "slot 2", "ascending"));
  EXPECT_THAT(refusal_with(64, "\0"s), names("frame 0", "byte 64", "slot 0", "ascending"));
  EXPECT_THAT(refusal_with(24, "\x04"), names("frame 0", "byte 24", "4 slots", "3 new"));
  EXPECT_THAT(refusal_with(92, "\xff\xff\xff\xff"), names("frame 1", "byte 92", "4294967295 slots", "0 new"));

  EXPECT_THAT(refusal_with(120, nan),
              names("frame 1", "byte 116", "slot 0", "(0.25, nan)", "(1.25, 1)", "min <= max"));
  EXPECT_THAT(refusal_with(128, nan), HasSubstr("max (1.25, nan)"));
  EXPECT_THAT(refusal_with(116, infinite), HasSubstr("slot 0 gets min (inf, 0) and max (1.25, 1)"));
  const std::string empty_slot = infinite + infinite + "\0\0\x80\xff\0\0\x80\xff"s;
  EXPECT_THAT(refusal_with(116, empty_slot), HasSubstr("slot 0 gets min (inf, inf) and max (-inf, -inf)"))
      << "an empty slot has a form of its own";
}

TEST(TraceReader, TakesSlotsThatAreNamedWithoutHavingChanged) {
  const std::string before = small_trace();
  const std::string same = small_trace_with(112, before.substr(44, 20));
  EXPECT_EQ(read_all(same).first, 2u);
}

TEST(TraceReader, TakesNoMemoryForBoxesThatAreOnlyClaimed) {
  std::string bytes = small_trace().substr(0, 300);
  put_trace_word(bytes, 92, 0x80000000);
  put_trace_word(bytes, 100, 0x80000000);
  bytes = sealed_trace(bytes);
  std::istringstream stream(bytes);
  const AllocationMeter meter;
  TraceReader reader(stream, "t");
  EXPECT_TRUE(reader.next_frame());
  EXPECT_FALSE(reader.next_frame());
  EXPECT_THAT(reader.warning(), HasSubstr("has 48 of its 42949672988 bytes"));
  EXPECT_LT(meter.read().value_or(Allocation{}).peak, 1 << 20);
}

TEST(TraceReader, KeepsOneFrameInMemoryHoweverLongTheTrace) {
  Tape<3> tape;
  for (int frame = 0; frame < 2000; ++frame) {
    const auto x = static_cast<float>(frame);
    for (std::uint32_t slot = 0; slot < 100; ++slot) tape.set(slot, {x, x, x, x, x, x});
    tape.end_frame();
  }
  ASSERT_GT(tape.bytes.size(), 5'000'000u);
  std::istringstream stream(tape.bytes);
  const AllocationMeter meter;
  TraceReader reader(stream, "t");
  while (reader.next_frame()) continue;
  EXPECT_EQ(reader.frames(), 2000u);
  EXPECT_LT(meter.read().value_or(Allocation{}).peak, 1 << 20);
}

TEST_F(TraceFiles, ThatCannotBeReadAreNamedWithTheReason) {
  EXPECT_THAT(refusal(path("no.btrace")),
              AllOf(HasSubstr("no.btrace: cannot be read"), HasSubstr("No such file")));
  EXPECT_THAT(refusal(path("")), HasSubstr("Is a directory"));
  EXPECT_THAT(refusal(put("empty.btrace", "")), HasSubstr("empty.btrace: is empty"));
}

TEST_F(TraceFiles, AreWrittenWholeOrNotAtAll) {
  put("a.btrace", "old");
  EXPECT_THAT(message_of<FileError>([&] {
                write_scene(History<2>{{{{nan, 0}, {1, 1}}}, {}}, path("a.btrace"));
              }),
              AllOf(HasSubstr("a.btrace"), HasSubstr("slot 0 is given min (nan"), Not(HasSubstr("written"))));
  EXPECT_EQ(text_of("a.btrace"), "old");
  EXPECT_EQ(count_files(), 1u);

  std::filesystem::create_symlink("/dev/full", path("full.btrace"));
  const History<3> long_history = random_history<3>({.boxes = 1000, .frames = 100});
  EXPECT_THAT(message_of<FileError>([&] { write_scene(long_history, path("full.btrace")); }),
              AllOf(HasSubstr("full.btrace: cannot be written"), HasSubstr("No space left")));
}

}  // namespace
}  // namespace broadside::lab
