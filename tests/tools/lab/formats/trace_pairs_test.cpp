// The pairs of an engine in traces: they come back as they were recorded, through every reader and writer
// that keeps them; the others say that they leave them out; and what is wrong is refused.
#include <cstdint>
#include <filesystem>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lab/convert.hpp"
#include "lab/file_info.hpp"
#include "lab/formats/format.hpp"
#include "lab/formats/recording.hpp"
#include "lab/formats/trace/trace.hpp"
#include "lab/scenes/motion.hpp"
#include "lab/scenes/random.hpp"
#include "tests/fuzz/sealed_trace.hpp"
#include "tests/support/boxes.hpp"
#include "tests/support/files.hpp"
#include "tests/support/message.hpp"
#include "tests/support/recorded.hpp"
#include "tests/support/tape.hpp"

namespace broadside::lab {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;

using TracePairs = Files;

Recording<2, float> recording_in(const std::filesystem::path& path) {
  const BoxFile file = open_file(path);
  return read_recording(*std::get<std::unique_ptr<FrameReader<2, float>>>(file.frames));
}

/// What is wrong with a trace; empty if it is read.
std::string fault_of(const std::string& bytes) {
  std::istringstream stream(bytes);
  try {
    TraceReader reader(stream, "t");
    while (reader.next_frame()) continue;
    return reader.warning();
  } catch (const FileError& error) {
    return error.what();
  }
}

std::string fault_with(std::size_t at, const std::string& bytes) {
  return fault_of(sealed_trace(small_trace_with_pairs().replace(at, bytes.size(), bytes)));
}

/// The trace of boxes that come, move and go, and of an engine that reports, ignores and filters at random.
template <int D, typename Real>
std::string random_trace(std::uint64_t seed) {
  Tape<D, Real> tape(0.25);
  Random random(seed);
  std::vector<bool> has_box;
  const auto draw_frame = [&](std::size_t size, const auto& changed, const auto& boxes) {
    has_box.resize(size);
    tape.recorder.resize(size);
    for (std::size_t i = 0; i < changed.size(); ++i) {
      if (index(changed[i]) >= size) continue;
      has_box[index(changed[i])] = !is_absent(boxes[i]);
      std::vector<Real> bounds(boxes[i].min.begin(), boxes[i].min.end());
      bounds.insert(bounds.end(), boxes[i].max.begin(), boxes[i].max.end());
      tape.set(index(changed[i]), bounds);
    }
    for (std::uint32_t a = 0; a < size; ++a) {
      for (std::uint32_t b = 0; has_box[a] && b < size; ++b) {
        if (a == b || !has_box[b]) continue;
        if (random.chance(0.2)) tape.recorder.add_pair(a, b);
        if (random.chance(0.1)) tape.recorder.ignore_pair(a, b);
      }
      if (has_box[a] && random.chance(0.2)) tape.recorder.set_filter(a, random.below(3), random.below(3));
    }
    tape.end_frame();
  };
  const History<D> history = random_history<D>({.boxes = 12, .frames = 20, .seed = seed});
  std::vector<BoxId> all;
  for (std::size_t i = 0; i < history.boxes.size(); ++i) all.push_back(BoxId(i));
  draw_frame(history.boxes.size(), all, history.boxes);
  for (const Step<D>& step : history.steps) draw_frame(step.size, step.changed, step.boxes);
  EXPECT_EQ(tape.recorder.error(), "");
  return tape.bytes;
}

TEST_F(TracePairs, ComeBackAsTheyWereRecorded) {
  const Recording<2, float> recording = recording_in(put("a.btrace", small_trace_with_pairs()));
  ASSERT_EQ(recording.pairs.size(), 2u);
  const RecordedPairs& first = recording.pairs[0];
  EXPECT_EQ(first.margin, 0.5);
  const Filter filter{.category = 2, .mask = 5, .group = -1, .is_static = true};
  EXPECT_THAT(first.filters, ElementsAre(std::pair(BoxId{0}, filter)));
  EXPECT_EQ(first.begun, (Pairs{pair(0, 1), pair(1, 2)}));
  EXPECT_EQ(first.begun_ignored, Pairs{pair(0, 2)});
  const RecordedPairs& second = recording.pairs[1];
  EXPECT_EQ(second.ended, Pairs{pair(0, 1)});
  EXPECT_EQ(second.begun, Pairs{pair(1, 2)});
  EXPECT_EQ(second.ended_ignored, Pairs{pair(0, 2)});
}

TEST_F(TracePairs, AreWrittenAgainByteForByte) {
  const auto check = [this](const std::string& bytes) {
    const Format& format = writable_format(path("again.btrace"));
    const Converted converted = convert(open_file(put("a.btrace", bytes)), path("again.btrace"), format, {});
    EXPECT_EQ(text_of("again.btrace"), bytes);
    EXPECT_EQ(text_of_left_out(converted, format), "");
  };
  check(small_trace_with_pairs());
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    check(random_trace<2, float>(seed));
    check(random_trace<3, double>(seed));
  }
}

TEST_F(TracePairs, AreThoseOfTheBoxesInTheFile) {
  Tape<3, double> tape(0.0);
  tape.set(0, {0, 0, 0, 0.1, 1, 1});
  tape.set(1, {0, 0, 0, 1, 1, 1});
  tape.recorder.add_pair(0, 1);
  tape.end_frame();
  put("a.btrace", tape.bytes);
  const auto left_out = [this](const char* to, std::optional<Precision> precision) {
    const Format& format = writable_format(path(to));
    const Converted converted = convert(open_file(path("a.btrace")), path(to), format, precision);
    EXPECT_FALSE(has_recorded_pairs(open_file(path(to)).frames));
    return text_of_left_out(converted, format);
  };
  EXPECT_EQ(left_out("a.csv", {}), "left out the recorded pairs: format csv holds boxes alone");
  EXPECT_EQ(left_out("float.btrace", Precision::float32),
            "left out the recorded pairs: they are those of the boxes in double");

  for (const ReadOptions& options :
       {ReadOptions{.dimension = 2}, ReadOptions{.precision = Precision::float32}}) {
    BoxFile file = open_file(path("a.btrace"), options);
    EXPECT_FALSE(has_recorded_pairs(file.frames));
    std::visit(
        [](const auto& frames) {
          frames->first();
          EXPECT_THAT(
              frames->warning(),
              EndsWith("a.btrace: left out the recorded pairs: they are those of boxes in 3D, in double"));
        },
        file.frames);
  }
  EXPECT_THAT(read_file(path("a.btrace")).warning,
              HasSubstr("a.btrace: left out the recorded pairs, which scenes do not have; `verify` and"));
}

TEST_F(TracePairs, AreCountedByInfo) {
  const std::string text = lab::text_of(file_info(put("a.btrace", falling_box(report_rightly)), {}));
  EXPECT_THAT(text,
              HasSubstr("\n  recorded pairs, margin 0.25: 0 in a frame (median; 0 to 1); in all, 1 begun, 1 "
                        "ended\n"));
  EXPECT_THAT(lab::text_of(file_info(put("b.btrace", small_trace_with_pairs()), {})),
              HasSubstr("1 begun, 1 ended; 1 filter; up to 1 ignored\n"));
}

TEST(TracePairsReader, FindsEveryWrongBit) {
  const std::string whole = small_trace_with_pairs();
  EXPECT_EQ(fault_of(whole), "");
  for (std::size_t byte = 0; byte < whole.size(); ++byte) {
    for (int bit = 0; bit < 8; ++bit) {
      std::string bytes = whole;
      bytes[byte] = static_cast<char>(bytes[byte] ^ 1 << bit);
      EXPECT_NE(fault_of(bytes), "") << "bit " << bit << " of byte " << byte;
    }
  }
}

TEST(TracePairsReader, SaysWhereATraceIsCutOff) {
  const std::string whole = small_trace_with_pairs();
  EXPECT_THAT(fault_of(whole.substr(0, 26)),
              EndsWith("byte 26: the file ends; expected a header of 28 bytes"));
  EXPECT_THAT(fault_of(whole.substr(0, 200)),
              EndsWith("frame 1, which begins at byte 184: has 16 of the 40 bytes of its header"));
  EXPECT_THAT(fault_of(whole.substr(0, 270)), EndsWith("begins at byte 184: has 86 of its 88 bytes"));
}

TEST(TracePairsReader, RefusesWhatCannotBe) {
  using namespace std::string_literals;
  EXPECT_THAT(fault_with(16, "\0\0\0\0\0\0\xe0\xbf"s),
              EndsWith("byte 16: margin -0.5; expected a finite number, 0 or more"));
  EXPECT_THAT(fault_with(22, "\xf0\x7f"), HasSubstr("byte 16: margin inf"));
  EXPECT_THAT(fault_with(22, "\xf8\x7f"), HasSubstr("byte 16: margin nan"));
  EXPECT_THAT(fault_with(128, "\x03"),
              HasSubstr("frame 0, byte 128: a filter of slot 3; expected slots below 3"));
  EXPECT_THAT(fault_with(152, "\x02"), EndsWith("frame 0, byte 152: static 2; expected 0 or 1"));
  EXPECT_THAT(fault_with(156, "\x01"),
              EndsWith("byte 156: pair (1, 1); expected two slots, the lesser one first"));
  EXPECT_THAT(fault_with(156, "\1\0\0\0\3"s),
              HasSubstr("byte 164: pair (1, 2) after pair (1, 3); expected pairs in ascending"));
  EXPECT_THAT(fault_with(168, "\x03"),
              HasSubstr("frame 0, byte 28: pair (1, 3) names slot 3, which is empty"));
  EXPECT_THAT(fault_with(248, "\x02"),
              EndsWith("byte 252: pair (0, 2) ends; expected one that the frame before had"));
  EXPECT_THAT(fault_with(264, "\x01"),
              EndsWith("byte 268: pair (0, 1) ends; expected one that the frame before had"));
}

TEST(TracePairsReader, RefusesPairsOfASlotThatWasEmptied) {
  Tape<2> tape(0.0);
  tape.set(0, {0, 0, 1, 1});
  tape.set(1, {0, 0, 1, 1});
  tape.recorder.add_pair(0, 1);
  tape.end_frame();
  tape.recorder.remove(1);
  tape.end_frame();
  EXPECT_EQ(fault_of(tape.bytes), "");
  const std::size_t frame = tape.ends[0];
  std::string bytes = tape.bytes.substr(0, frame + 44);
  put_trace_word(bytes, frame + 20, 0);
  bytes += std::string(4, '\0');
  EXPECT_THAT(fault_of(sealed_trace(bytes)),
              HasSubstr("frame 1, byte 120: pair (0, 1) names slot 1, which is empty"));
}

}  // namespace
}  // namespace broadside::lab
