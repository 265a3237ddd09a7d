// Bad input: every reader refuses every fault by name and place, and no writer leaves half a file behind.
//
// A format is held to all faults as soon as it has a row in bad_files(); another one is another function
// there.
#include <algorithm>
#include <array>
#include <bit>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <ostream>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include "lab/formats/format.hpp"
#include "lab/measure/allocation.hpp"
#include "tests/support/boxes.hpp"
#include "tests/support/files.hpp"
#include "tests/support/message.hpp"

namespace broadside::lab {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// What can be wrong with the bytes of a file. What a format makes of a fault that it cannot have as such is
/// the nearest to it.
constexpr auto faults = std::to_array<std::string_view>({
    "truncated",
    "wrong_magic",
    "absurd_count",
    "nan",
    "inverted",
    "text_for_numbers",
    "missing_columns",
    "empty",
});

struct BadFile {
  std::string format;
  std::string fault;
  std::string bytes;
  std::vector<std::string> says;  ///< what the error has to say; that it names the file goes without saying
};

void PrintTo(const BadFile& file, std::ostream* stream) { *stream << file.format << ' ' << file.fault; }

std::vector<BadFile> bad_tables() {
  const std::string columns = "min_x,min_y,max_x,max_y\n0,0,1,1\n";
  return {
      {"csv", "truncated", columns + "1,2,3", {":3: 3 columns", "the 4 columns min_x,min_y,max_x,max_y"}},
      {"csv",
       "wrong_magic",
       {"\x7f"
        "ELF\x02\x01\x01",
        7},
       {":1: ", "columns such as 'min_x,min_y,max_x,max_y'"}},
      {"csv",
       "absurd_count",
       "frame,box,min_x,min_y,max_x,max_y\n0,4294967295,0,0,1,1\n",
       {":2: column box is '4294967295'", "a box from 0 to 0"}},
      {"csv", "nan", columns + "0,nan,1,1\n", {":3: column min_y is 'nan'", "a number"}},
      {"csv", "inverted", columns + "0,2,1,1\n", {":3: min (0, 2) and max (1, 1)", "min <= max"}},
      {"csv", "text_for_numbers", columns + "0,0,1,one\n", {":3: column max_y is 'one'", "a number"}},
      {"csv", "missing_columns", "min_x,min_y,max_x\n0,0,1\n", {":1: ", "column 'min_y' alone"}},
      {"csv", "empty", "", {"is empty", "a table"}},
  };
}

std::string npy_bytes(const std::string& type, const std::string& shape, std::vector<float> numbers) {
  std::string text = "{'descr': '" + type + "', 'fortran_order': False, 'shape': (" + shape + "), }\n";
  std::string bytes("\x93NUMPY\x01\0", 8);
  bytes += static_cast<char>(text.size());
  bytes += '\0';
  bytes += text;
  return bytes.append(reinterpret_cast<const char*>(numbers.data()), sizeof(float) * numbers.size());
}

std::vector<BadFile> bad_arrays() {
  const std::string type = std::endian::native == std::endian::little ? "<f4" : ">f4";
  return {
      {"npy",
       "truncated",
       npy_bytes(type, "2, 4", {0, 0, 1, 1, 0, 0, 1}),
       {"has 28 bytes behind its header and claims 2 rows of 4", "16 bytes a row"}},
      {"npy", "wrong_magic", "\x93NUMPX and more", {"byte 0: 93 4e 55 4d 50 58", "93 4e 55 4d 50 59"}},
      {"npy",
       "absurd_count",
       npy_bytes(type, "2147483648, 4", std::vector<float>(60, 0)),
       {"has 240 bytes behind its header and claims 2147483648 rows"}},
      {"npy", "nan", npy_bytes(type, "1, 4", {0, nan, 1, 1}), {"row 0 has min (0, nan)", "min <= max"}},
      {"npy", "inverted", npy_bytes(type, "1, 4", {0, 2, 1, 1}), {"row 0 has min (0, 2) and max (1, 1)"}},
      {"npy",
       "text_for_numbers",
       npy_bytes("<U4", "1, 4", {0, 0, 0, 0}),
       {"numbers of type '<U4'", "floats"}},
      {"npy", "missing_columns", npy_bytes(type, "1, 3", {0, 0, 1}), {"shape (1, 3)", "(n, 4)"}},
      {"npy", "empty", "", {"is empty", "a NumPy array"}},
  };
}

std::vector<BadFile> bad_archives() {
  return {
      {"npz", "truncated", corpus("npz/cut_off.npz"), {"expected a zip archive"}},
      {"npz", "wrong_magic", "PKZ and more, but no archive behind it", {"expected a zip archive"}},
      {"npz",
       "absurd_count",
       corpus("npz/claims_2_to_the_31.npz"),
       {"array 'boxes': has 16 bytes behind its header and claims 2147483648 rows"}},
      {"npz", "nan", corpus("npz/nan.npz"), {"array 'boxes': row 0 has min (0, nan)", "min <= max"}},
      {"npz", "inverted", corpus("npz/inverted.npz"), {"array 'boxes': row 0 has min (0, 2)"}},
      {"npz", "text_for_numbers", corpus("npz/text.npz"), {"numbers of type '<U1'", "floats"}},
      {"npz", "missing_columns", corpus("npz/three_columns.npz"), {"shape (1, 3)", "(n, 4)"}},
      {"npz", "empty", "", {"is empty", "an .npz file"}},
  };
}

std::vector<BadFile> bad_broadmark() {
  const std::string text(400, 'x');
  return {
      {"broadmark",
       "truncated",
       corpus("broadmark/cut_off_in_a_box.aabbs"),
       {"has 353 bytes and claims 2 boxes"}},
      {"broadmark", "wrong_magic", text, {"claims 2021161080 boxes and 2021161080 steps"}},
      {"broadmark",
       "absurd_count",
       corpus("broadmark/claims_2_to_the_31.aabbs"),
       {"has 304 bytes and claims 2147483647 boxes", "304 + 32 x boxes x (steps + 1) bytes"}},
      {"broadmark",
       "nan",
       corpus("broadmark/nan.aabbs"),
       {"frame 0, box 0 has min (1, 2, nan)", "min <= max"}},
      {"broadmark", "inverted", corpus("broadmark/inverted.aabbs"), {"frame 0, box 0 has min (1, 2, 9)"}},
      {"broadmark",
       "text_for_numbers",
       "min_x,min_y,max_x,max_y\n0,0,1,1\n",
       {"has 32 bytes", "a header of 304"}},
      {"broadmark", "missing_columns", corpus("broadmark/one_frame.aabbs") + "12345678", {"claims 2 boxes"}},
      {"broadmark", "empty", "", {"has 0 bytes", "a header of 304"}},
  };
}

std::vector<BadFile> bad_traces() {
  return {
      {"trace",
       "truncated",
       corpus("trace/cut_off_in_the_header.btrace"),
       {"the file ends", "a header of 20 bytes"}},
      {"trace", "wrong_magic", corpus("trace/transferred_as_text.btrace"), {"byte 0: the first bytes are"}},
      {"trace", "absurd_count", corpus("trace/claims_everything.btrace"), {"is cut off in frame 0"}},
      {"trace", "nan", corpus("trace/nan.btrace"), {"frame 0, byte", "nan", "min <= max"}},
      {"trace", "inverted", corpus("trace/inverted.btrace"), {"frame 0, byte", "min <= max"}},
      {"trace", "text_for_numbers", "min_x,min_y,max_x,max_y\n0,0,1,1\n", {"byte 0: the first bytes are"}},
      {"trace",
       "missing_columns",
       corpus("trace/four_dimensions.btrace"),
       {"byte 12: dimension 4", "2 or 3"}},
      {"trace", "empty", "", {"is empty", "a trace"}},
  };
}

std::vector<BadFile> bad_maps() {
  const auto point = [](const std::string& coordinates) {
    return R"({"type":"Point","coordinates":)" + coordinates + "}";
  };
  const std::string arcs =
      R"({"type":"Topology","arcs":[[[0,0],[1,1]]],"objects":{"a":{"type":"LineString","arcs":)";
  return {
      {"map",
       "truncated",
       R"({"type":"Point","coordinates":[1,2])",
       {"byte 35: the text ends", "',' or '}'"}},
      {"map", "wrong_magic", "PK\x03\x04 and more", {"byte 0: 'PK", "is no JSON here", "a value"}},
      {"map", "absurd_count", arcs + "[2147483648]}}}", {"feature 0: arc 2147483648", "one of 1"}},
      {"map", "nan", point("[NaN,1]"), {"byte 31: 'NaN' is no JSON", "a value"}},
      {"map", "inverted", arcs + "[-2]}}}", {"feature 0: arc -2", "one of 1"}},
      {"map", "text_for_numbers", point("[\"one\",1]"), {"byte 31, feature 0: '\"one\"'", "a number"}},
      {"map", "missing_columns", point("[1]"), {"feature 0: a position of 1 number", "at least 2"}},
      {"map", "empty", "", {"byte 0: the text ends", "a value"}},
  };
}

std::vector<BadFile> bad_meshes() {
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 5\n3 0 1 2\n";
  const auto with = [&](const std::string& old, const std::string& now) {
    std::string text = ply;
    return text.replace(text.find(old), old.size(), now);
  };
  return {
      {"mesh", "truncated", ply.substr(0, ply.size() - 3), {"byte ", "the file ends", "a whole number"}},
      {"mesh", "wrong_magic", "plz" + ply.substr(3), {":1: 'plz'", "'ply'"}},
      {"mesh",
       "absurd_count",
       with("vertex 3", "vertex 2147483648"),
       {":3: claims 2147483648 of the element 'vertex'", "at most"}},
      {"mesh", "nan", with("0 1 5", "0 1 nan"), {"face 0 has a vertex at (0, 1, nan)", "finite"}},
      {"mesh", "inverted", with("3 0 1 2", "3 0 1 -2"), {"face 0 names the vertex -2", "one from 0"}},
      {"mesh", "text_for_numbers", with("0 1 5", "0 one 5"), {"byte ", "'one'", "a number"}},
      {"mesh", "missing_columns", with("property float z\n", ""), {"no z", "x, y and z"}},
      {"mesh", "empty", "", {":1: the file ends in its header", "'end_header'"}},
  };
}

std::vector<BadFile> bad_files() {
  std::vector<BadFile> all;
  for (const auto& some :
       {bad_tables(), bad_arrays(), bad_archives(), bad_broadmark(), bad_traces(), bad_maps(), bad_meshes()})
    all.insert(all.end(), some.begin(), some.end());
  return all;
}

const Format& format_of_name(const std::string& name) {
  return *std::ranges::find(formats(), name, &Format::name);
}

class BadFileTest : public Files, public testing::WithParamInterface<BadFile> {};

TEST_P(BadFileTest, IsRefusedByNameAndPlaceInLittleMemory) {
  const Format& format = format_of_name(GetParam().format);
  if (!format.missing.empty()) GTEST_SKIP() << format.missing;
  const std::filesystem::path file = put("bad" + format.extensions.front(), GetParam().bytes);
  formats();  // which is made once and kept
  const AllocationMeter meter;
  const std::string text = message_of<FileError>([&] {
    ReadOptions options;
    options.format = format.name;
    read_file(file, options);
  });
  if (const std::optional<Allocation> allocation = meter.read()) {
    EXPECT_LE(allocation->peak, 1'000'000) << "for " << GetParam().bytes.size() << " bytes";
  }
  EXPECT_THAT(text, AllOf(HasSubstr(file.string()), HasSubstr("expected")));
  for (const std::string& part : GetParam().says) EXPECT_THAT(text, HasSubstr(part));
}

std::string name_of(const testing::TestParamInfo<BadFile>& info) {
  return info.param.format + "_" + info.param.fault;
}

INSTANTIATE_TEST_SUITE_P(All, BadFileTest, testing::ValuesIn(bad_files()), name_of);

TEST(BadFiles, AreTriedWithEveryFaultInEachFormatThatHasOne) {
  std::set<std::pair<std::string, std::string>> tried;
  std::set<std::string> tried_formats;
  for (const BadFile& file : bad_files()) {
    tried.emplace(file.format, file.fault);
    tried_formats.insert(file.format);
  }
  for (const std::string& format : tried_formats) {
    for (const std::string_view fault : faults)
      EXPECT_TRUE(tried.contains({format, std::string(fault)})) << format << ' ' << fault;
  }
}

/// Tests of every format by its extension.
class BadPlace : public Files, public testing::WithParamInterface<std::string> {
 protected:
  std::string extension() const { return GetParam(); }
};

TEST_P(BadPlace, IsRefusedWhereThereIsNoFile) {
  EXPECT_THAT(refusal(path("none" + extension())),
              AllOf(HasSubstr("none" + extension()), HasSubstr("No such file")));
}

TEST_P(BadPlace, IsRefusedWhereItIsAFolder) {
  std::filesystem::create_directory(path("folder" + extension()));
  EXPECT_THAT(refusal(path("folder" + extension())),
              AllOf(HasSubstr("folder" + extension()), HasSubstr("Is a directory")));
}

TEST_P(BadPlace, IsRefusedWhereReadingIsForbidden) {
  if (geteuid() == 0) GTEST_SKIP() << "root may read everything";
  const std::filesystem::path file = put("secret" + extension(), "1");
  std::filesystem::permissions(file, std::filesystem::perms::none);
  EXPECT_THAT(refusal(file), AllOf(HasSubstr("secret" + extension()), HasSubstr("Permission denied")));
}

TEST_P(BadPlace, IsRefusedWhereTheFileIsEmpty) {
  EXPECT_THAT(refusal(put("empty" + extension(), "")), HasSubstr("empty" + extension()));
}

std::vector<std::string> extensions(bool written) {
  std::vector<std::string> list;
  for (const Format& format : formats()) {
    if (format.missing.empty() && (!written || format.create)) list.push_back(format.extensions.front());
  }
  return list;
}

INSTANTIATE_TEST_SUITE_P(All, BadPlace, testing::ValuesIn(extensions(false)), without_dot);

/// Tests of every format that is written.
class BadTarget : public BadPlace {
 protected:
  static History<3> history() { return {std::vector<Box3>(5000, Box3{{1, 2, 3}, {4, 5, 6}}), {}}; }

  std::string refusal_to_write(const std::filesystem::path& file) const {
    const Format& format = writable_format(path("a" + extension()));
    return message_of<FileError>(
        [&] { write_frames(std::make_unique<HistoryReader<3, float>>(history()), file, format); });
  }
};

/// While it exists, no file can become longer than this.
class ShortFiles {
 public:
  explicit ShortFiles(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~ShortFiles() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  ShortFiles(const ShortFiles&) = delete;
  ShortFiles& operator=(const ShortFiles&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int) = SIG_DFL;
};

TEST_P(BadTarget, IsRefusedWhereTheDiskIsFull) {
  EXPECT_THAT(refusal_to_write("/dev/full"), AllOf(HasSubstr("/dev/full"), HasSubstr("No space left")));
}

TEST_P(BadTarget, LeavesNothingPartialWhereTheDiskFillsUp) {
  for (const rlim_t bytes : {0, 100, 10'000}) {
    const ShortFiles limit(bytes);
    EXPECT_THAT(refusal_to_write(path("new" + extension())),
                AllOf(HasSubstr("new" + extension()), HasSubstr("too large")));
    EXPECT_EQ(count_files(), 0u) << bytes;
  }
  put("old" + extension(), "old");
  {
    const ShortFiles limit(10'000);
    EXPECT_THAT(refusal_to_write(path("old" + extension())), HasSubstr("too large"));
  }
  EXPECT_EQ(text_of("old" + extension()), "old");
  EXPECT_EQ(count_files(), 1u);
}

TEST_P(BadTarget, IsRefusedWhereItIsAFolderOrInNone) {
  std::filesystem::create_directory(path("folder" + extension()));
  EXPECT_THAT(refusal_to_write(path("folder" + extension())),
              AllOf(HasSubstr("folder"), HasSubstr("Is a directory")));
  EXPECT_THAT(refusal_to_write(path("none/a" + extension())),
              AllOf(HasSubstr("none/a"), HasSubstr("No such file")));
  EXPECT_EQ(count_files(), 1u);
}

INSTANTIATE_TEST_SUITE_P(All, BadTarget, testing::ValuesIn(extensions(true)), without_dot);

}  // namespace
}  // namespace broadside::lab
