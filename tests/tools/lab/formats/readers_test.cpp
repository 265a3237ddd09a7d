// Files: what is written is read back, and what is wrong is refused by name and place.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/error.hpp"

#include "lab/formats/format.hpp"
#include "lab/formats/write_file.hpp"
#include "lab/scenes/motion.hpp"
#include "lab/scenes/registry.hpp"
#include "tests/support/boxes.hpp"
#include "tests/support/files.hpp"
#include "tests/support/pipe.hpp"

namespace broadside::lab {
namespace {

using testing::AllOf;
using testing::HasSubstr;

using Csv = Files;
using Mesh = Files;
using WriteFile = Files;
using FileScene = Files;

/// The boxes of every frame, without the absent ones that stand at an array's end.
template <int D>
std::vector<std::vector<Box<D>>> frames_of(const History<D>& history) {
  std::vector<std::vector<Box<D>>> frames;
  std::vector<Box<D>> boxes = history.boxes;
  const auto add = [&] {
    frames.push_back(boxes);
    while (!frames.back().empty() && is_absent(frames.back().back())) frames.back().pop_back();
  };
  add();
  for (const Step<D>& step : history.steps) {
    lab::apply(step, boxes);
    add();
  }
  return frames;
}

TEST_F(Csv, GivesBackEveryFrameOfAnyHistory) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const History<2> flat = random_history<2>({.boxes = 20, .seed = seed});
    write_scene(flat, path("flat.csv"));
    EXPECT_EQ(frames_of(read_file(path("flat.csv")).in_2d.value()), frames_of(flat));
    EXPECT_FALSE(read_file(path("flat.csv")).in_3d);

    const History<3> solid = random_history<3>({.boxes = 20, .seed = seed});
    write_scene(solid, path("solid.csv"));
    EXPECT_EQ(frames_of(read_file(path("solid.csv")).in_3d.value()), frames_of(solid));
    EXPECT_FALSE(read_file(path("solid.csv")).in_2d);
  }
}

TEST_F(Csv, GivesBackEveryFloatExactly) {
  constexpr float largest = std::numeric_limits<float>::max();
  constexpr float smallest = std::numeric_limits<float>::denorm_min();
  const History<2> history{
      {{{-largest, smallest}, {0.1F, 1.0F / 3}}, {{-infinity, -infinity}, {16777216, infinity}}}, {}};
  write_scene(history, path("boxes.csv"));
  EXPECT_EQ(read_file(path("boxes.csv")).in_2d->boxes, history.boxes);
}

TEST_F(Csv, IsWrittenAsPeopleExpect) {
  const History<2> history{{{{0, 0.5F}, {1, 2}}, absent_box<2>()},
                           {{2, {BoxId{1}}, {{{-3, 0}, {-1, infinity}}}}, {2, {}, {}}, {1, {}, {}}}};
  write_scene(history, path("boxes.csv"));
  EXPECT_EQ(text_of("boxes.csv"),
            "frame,box,min_x,min_y,max_x,max_y\n"
            "0,0,0,0.5,1,2\n"
            "0,1,,,,\n"
            "1,1,-3,0,-1,inf\n"
            "2,,,,,\n"
            "3,1,,,,\n");
}

TEST_F(Csv, ReadsPlainColumnsWithWhateverLineEnds) {
  const std::vector<Box2> flat = {{{1, 2}, {3, 4}}, {{-1, -2}, {0, 1e10F}}};
  EXPECT_EQ(read_file(put("a.csv", "min_x,min_y,max_x,max_y\n1,2,3,4\n-1,-2,0,1e10\n")).in_2d->boxes, flat);
  EXPECT_EQ(
      read_file(put("b.csv", "\xEF\xBB\xBFmin_x,min_y,max_x,max_y\r\n1,2,3,4\r\n-1,-2,0,1e10")).in_2d->boxes,
      flat);
  EXPECT_EQ(read_file(put("c.csv", "min_x,min_y,min_z,max_x,max_y,max_z\n1,2,3,4,5,6\n")).in_3d->boxes,
            (std::vector<Box3>{{{1, 2, 3}, {4, 5, 6}}}));
  EXPECT_TRUE(read_file(put("d.csv", "min_x,min_y,max_x,max_y\n")).in_2d->boxes.empty());
  EXPECT_EQ(read_file(put("e.csv", "min_x,min_y,max_x,max_y\n1,2,3,4\n-1,-2,0,1e10\n\r\n\n")).in_2d->boxes,
            flat);
}

TEST_F(Csv, TakesInfinitiesForAnAbsentBox) {
  const auto file = put("a.csv", "min_x,min_y,max_x,max_y\ninf,inf,-inf,-inf\n,,,\n");
  EXPECT_EQ(read_file(file).in_2d->boxes, (std::vector<Box2>(2, absent_box<2>())));
}

TEST_F(Csv, OfDoublesSaysAsASceneHowManyCoordinatesAreRounded) {
  const Scene rounded = file_scene(put("a.csv",
                                       "frame,box,min_x,min_y,max_x,max_y\n"
                                       "0,0,0,0,16777217,1\n1,0,0,0,0.1,16777219\n"));
  EXPECT_THAT(rounded.warning,
              AllOf(HasSubstr("a.csv: 3 of 8 coordinates were rounded to float"), HasSubstr("`pairs`")));
  EXPECT_EQ(file_scene(put("b.csv", "min_x,min_y,max_x,max_y\n0,0,0.5,16777216\n")).warning, "");
  EXPECT_THAT(file_scene(put("c.csv", "0,1e-60,0.1,1e60\n")).warning,
              HasSubstr("3 of 4 coordinates were rounded to float, 2 of them to infinity or zero"));
}

TEST_F(Csv, IsRecognisedByItsFirstLineWhateverItIsCalled) {
  EXPECT_TRUE(read_file(put("boxes.txt", "frame,box,min_x,min_y,max_x,max_y\n0,0,1,1,2,2\n")).in_2d);
}

TEST_F(Csv, RefusesWhatIsWrongNamingFileAndLine) {
  const std::string plain = "min_x,min_y,max_x,max_y\n0,0,1,1\n";
  const std::string framed = "frame,box,min_x,min_y,max_x,max_y\n0,0,0,0,1,1\n0,1,0,0,1,1\n";
  const auto refusal_of = [&](const std::string& text) { return refusal(put("bad.csv", text)); };

  EXPECT_THAT(refusal_of(""), AllOf(HasSubstr("bad.csv"), HasSubstr("empty")));
  EXPECT_THAT(refusal_of("x,y,w,h\n"),
              AllOf(HasSubstr("bad.csv:1: 'x,y,w,h'"), HasSubstr("'min_x,min_y,max_x,max_y'")));
  EXPECT_THAT(refusal_of(plain + "0,0,1\n"),
              AllOf(HasSubstr("bad.csv:3: 3 columns"), HasSubstr("expected the 4")));
  EXPECT_THAT(refusal_of(plain + "0,0,1,1,\n"), HasSubstr("bad.csv:3: 5 columns"));
  EXPECT_EQ(refusal_of(plain + "\n1,2,3,4\n"), "was read");
  EXPECT_THAT(refusal_of(plain + "0,0,1,one\n"),
              AllOf(HasSubstr("bad.csv:3: column max_y is 'one'"), HasSubstr("expected a number")));
  EXPECT_THAT(refusal_of(plain + "0,nan,1,1\n"), HasSubstr("column min_y is 'nan'"));
  EXPECT_THAT(refusal_of(plain + "0,1e999,1,1\n"), HasSubstr("column min_y is '1e999'"));
  EXPECT_THAT(refusal_of(plain + "0,,1,1\n"), HasSubstr("column min_y is ''"));
  EXPECT_THAT(refusal_of(plain + "0,0 0,1,1\n"), HasSubstr("column min_y is '0 0'"));
  EXPECT_THAT(refusal_of(plain + "2,0,1,1\n"),
              AllOf(HasSubstr("bad.csv:3: min (2, 0) and max (1, 1)"), HasSubstr("min <= max")));

  EXPECT_THAT(refusal_of(framed + "1,-1,0,0,1,1\n"), HasSubstr("bad.csv:4: column box is '-1'"));
  EXPECT_THAT(refusal_of(framed + "1,1.5,0,0,1,1\n"), HasSubstr("column box is '1.5'"));
  EXPECT_THAT(refusal_of(framed + "1,4000000000,0,0,1,1\n"), HasSubstr("expected a box from 0 to 2"));
  EXPECT_THAT(refusal_of(framed + "0,1,0,0,1,1\n"), HasSubstr("expected each box once in a frame"));
  EXPECT_THAT(refusal_of(framed + "1,1,0,0,1,1\n1,1,0,0,1,1\n"),
              HasSubstr("bad.csv:5: box 1 is there again in frame 1"));
  EXPECT_THAT(refusal_of(framed + "2,0,0,0,1,1\n"),
              AllOf(HasSubstr("column frame is '2'"), HasSubstr("expected 0 or 1")));
  EXPECT_THAT(refusal_of(framed + "1,0,0,0,1,1\n0,0,0,0,1,1\n"), HasSubstr("expected 1 or 2"));
}

TEST_F(Mesh, IsTheBoundsOfItsTrianglesInOrder) {
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 -3\nf 1 2 3\nf 1 2 4\n";
  const FileContent content = read_file(put("a.obj", obj));
  EXPECT_EQ(content.in_3d->boxes, (std::vector<Box3>{{{0, 0, 0}, {1, 2, 0}}, {{0, 0, -3}, {1, 0, 0}}}));
  EXPECT_EQ(content.in_2d->boxes, (std::vector<Box2>{{{0, 0}, {1, 2}}, {{0, 0}, {1, 0}}}));

  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n1 1 0\n0 1 5\n4 0 1 2 3\n";
  EXPECT_EQ(read_file(put("a.ply", ply)).in_3d->boxes.size(), 2u) << "a quadrilateral is two triangles";
}

TEST_F(Mesh, RefusesWhatIsNone) {
  EXPECT_THAT(refusal(put("bad.ply", "ply\nnonsense")),
              AllOf(HasSubstr("bad.ply:2: 'nonsense'"), HasSubstr("expected 'format'")));
  EXPECT_THAT(refusal(put("bad.stl", "nonsense")), HasSubstr("bad.stl"));
  EXPECT_THAT(refusal(put("empty.obj", "")), HasSubstr("empty.obj"));
  EXPECT_THAT(refusal(put("points.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n")), HasSubstr("points.obj"));
  EXPECT_THAT(refusal(put("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")), HasSubstr("nan.obj"));
}

TEST_F(Files, InAFormatThatIsNotReadAreRefusedNamingItsConverter) {
  const auto part = put("rivers.dbf", "anything");
  EXPECT_THAT(refusal(part), AllOf(HasSubstr("rivers.dbf: is a part of a shapefile, which is not read here"),
                                   HasSubstr("ogr2ogr -f GeoJSON -lco SIGNIFICANT_FIGURES=17 out.geojson " +
                                             part.string())));
  EXPECT_THAT(refusal(put("a.xlsx", "PK")), HasSubstr("libreoffice --headless --convert-to csv "));
  EXPECT_THAT(refusal(put("a.laz", "?")), HasSubstr("pdal translate "));
  const auto intervals = put("a.bed", "chr1\t10\t20\n");
  EXPECT_THAT(refusal(intervals), AllOf(HasSubstr("awk -v OFS=, 'NR == 1 {print"),
                                        HasSubstr("' " + intervals.string() + " > out.csv")));
  // By its content, whatever it is called.
  EXPECT_THAT(refusal(put("a.csv", "PAR1\x15\x04")),
              AllOf(HasSubstr("a.csv: is Parquet"), HasSubstr("pandas.read_parquet('")));
  EXPECT_THAT(refusal(put("a.kml", "<?xml version=\"1.0\"?>\n<kml>")), HasSubstr("ogr2ogr"));
  EXPECT_THAT(refusal(put("by_its_content", std::string("SQLite format 3\0", 16))), HasSubstr("ogr2ogr"));
  EXPECT_THAT(refusal(put("a.aabbs", "?")), HasSubstr("import struct; d = open('"));
  EXPECT_THAT(refusal(put("rivers", "?"), {.format = "shp"}), HasSubstr("ogr2ogr"));
  EXPECT_THAT(refusal(put("b.dat", "\x89HDF\r\n\x1a\n")), HasSubstr("h5py"));
  EXPECT_THAT(refusal(put("c.dat", "ARROW1\n")), HasSubstr("no format known here"))
      << "has no zero behind it";
}

TEST_F(Files, ThatAreNotThereOrInNoFormatAreRefused) {
  EXPECT_THAT(refusal(path("nothing.csv")), AllOf(HasSubstr("nothing.csv"), HasSubstr("No such file")));
  EXPECT_THAT(refusal(path("")), HasSubstr("cannot be read"));
  EXPECT_THAT(refusal(put("a.xyzzy", "hello")),
              AllOf(HasSubstr("a.xyzzy"), HasSubstr("csv (.csv), npy (.npy), npz (.npz), map (.geojson ")));
  try {
    write_scene(History<2>{}, path("a.obj"));
    FAIL() << "wrote a format that is only read";
  } catch (const FileError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("extension '.obj'"),
                                    HasSubstr("expected one of: trace (.btrace), csv (.csv), ")));
  }
}

TEST_F(Files, AreToldByTheirContentBeforeTheirName) {
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  EXPECT_EQ(open_file(put("mesh.csv", ply)).format->name, "mesh");
  EXPECT_EQ(open_file(put("boxes.npy", "1,2,3,4\n")).format->name, "csv");
  EXPECT_THAT(refusal(put("cut.csv", "\x93NUMPY")), HasSubstr("NumPy"));
}

TEST_F(Files, AreShownInErrorsAsPrintableText) {
  using namespace std::string_literals;
  EXPECT_THAT(refusal(put("a.csv", "min_x,min_y,max_x,max_y\n0,0,\0\xff\x1b[1m,1\n"s)),
              AllOf(HasSubstr("a.csv:2: column max_x is '\?\?\?[1m'; expected a number")));
  EXPECT_THAT(refusal(put("b.csv", "\0\xffq,w\n"s)),
              AllOf(HasSubstr("'\?\?q,w'"), HasSubstr("expected columns")));
  EXPECT_THAT(refusal(put("c.npy", "\x93NUMPY\1\0\4\0{\0\xff}"s)), HasSubstr("'{\?\?}'; expected 'descr'"));
  EXPECT_THAT(refusal(put("d.csv", "\xff\xfem\0i\0n\0"s)), HasSubstr("UTF-16; expected UTF-8"));
}

TEST_F(Files, AreReadThroughAPipeAndToldByTheirContent) {
  const History<3> history{{{{1, 2, 3}, {4, 5, 6}}, {{-1, 0, 0.5F}, {0, 9, 0.5F}}}, {}};
  for (const Format& format : formats()) {
    if (!format.create) continue;
    const std::string name = "a" + format.extensions.front();
    write_scene(history, path(name));
    const Pipe pipe(text_of(name));
    ReadOptions options;
    options.precision = Precision::float32;
    const BoxFile file = open_file(pipe.path(), options);
    EXPECT_EQ(file.format->name, format.name);
    EXPECT_EQ((std::get<std::unique_ptr<FrameReader<3, float>>>(file.frames)->first()), history.boxes);
  }
}

TEST_F(Files, TellHowFarTheyHaveBeenRead) {
  // Some 20 MB in each format: there is a report every 8 MB.
  const History<3> history{std::vector<Box3>(800'000, Box3{{1.5, 2.5, 3.5}, {4.5, 5.5, 6.5}}), {}};
  for (const std::string name : {"a.csv", "a.npy"}) {
    write_scene(history, path(name));
    std::vector<std::uint64_t> reports;
    ReadOptions options;
    options.precision = Precision::float32;
    options.progress = [&](std::uint64_t done, std::uint64_t total) {
      EXPECT_LE(done, total) << name;
      EXPECT_EQ(total, std::filesystem::file_size(path(name))) << name;
      reports.push_back(done);
    };
    const BoxFile file = open_file(path(name), options);
    EXPECT_EQ((std::get<std::unique_ptr<FrameReader<3, float>>>(file.frames)->first()), history.boxes);
    EXPECT_GE(reports.size(), 2u) << name;
    EXPECT_TRUE(std::ranges::is_sorted(reports)) << name;
  }
}

TEST_F(WriteFile, LeavesTheOldFileAndNothingElseWhereWritingFails) {
  put("a.txt", "old");
  EXPECT_THROW(write_file(path("a.txt"),
                          [](std::ostream& stream) {
                            stream << "half";
                            throw std::runtime_error("stop");
                          }),
               std::runtime_error);
  EXPECT_EQ(text_of("a.txt"), "old");
  EXPECT_EQ(count_files(), 1u);
  write_file(path("a.txt"), [](std::ostream& stream) { stream << "new"; });
  EXPECT_EQ(text_of("a.txt"), "new");
  EXPECT_EQ(count_files(), 1u);
}

TEST_F(WriteFile, WritesThroughALink) {
  put("a.txt", "old");
  std::filesystem::create_symlink(path("a.txt"), path("link.txt"));
  write_file(path("link.txt"), [](std::ostream& stream) { stream << "new"; });
  EXPECT_TRUE(std::filesystem::is_symlink(path("link.txt")));
  EXPECT_EQ(text_of("a.txt"), "new");
}

TEST_F(WriteFile, WritesWhereALinkPointsThatPointsNowhereYet) {
  std::filesystem::create_symlink("a.txt", path("link.txt"));
  write_file(path("link.txt"), [](std::ostream& stream) { stream << "new"; });
  EXPECT_TRUE(std::filesystem::is_symlink(path("link.txt")));
  EXPECT_EQ(text_of("a.txt"), "new");
}

TEST_F(WriteFile, KeepsThePermissionsOfTheOldFile) {
  put("a.txt", "old");
  for (const auto wanted : {std::filesystem::perms(0600), std::filesystem::perms(0664)}) {
    std::filesystem::permissions(path("a.txt"), wanted);
    write_file(path("a.txt"), [](std::ostream& stream) { stream << "new"; });
    EXPECT_EQ(std::filesystem::status(path("a.txt")).permissions(), wanted);
  }
}

TEST_F(WriteFile, SaysWhatWentWrong) {
  const auto refusal_of = [](const std::filesystem::path& file) -> std::string {
    try {
      write_file(file, [](std::ostream& stream) { stream << std::string(1 << 20, 'x'); });
    } catch (const FileError& error) {
      return error.what();
    }
    return "was written";
  };
  EXPECT_THAT(refusal_of(path("no/such/folder.txt")),
              AllOf(HasSubstr("folder.txt"), HasSubstr("No such file")));
  EXPECT_THAT(refusal_of("/dev/full"), AllOf(HasSubstr("/dev/full"), HasSubstr("No space left")));
}

TEST_F(FileScene, TakesAFileThatDoesNotMoveForAStillSceneThatCanBeSetMoving) {
  const std::string file = put("odd:name.csv", "min_x,min_y,max_x,max_y\n0,0,1,1\n5,5,6,6\n").string();
  const NamedScene named = find_scene(file);
  EXPECT_EQ(named.scene.kind, SceneKind::file);
  EXPECT_EQ(named.scene.name, file);
  EXPECT_TRUE(named.scene.fixed_count);
  EXPECT_TRUE(named.scene.has_dimension(2));
  EXPECT_FALSE(named.scene.has_dimension(3));
  EXPECT_EQ(make_history<2>(named.scene, named.spec, {.boxes = 100}).boxes.size(), 2u);
  EXPECT_EQ(make_history<2>(named.scene, named.spec, {.frames = 3, .moving = 1}).steps.size(), 3u);
  EXPECT_THROW(make_history<3>(named.scene, named.spec, {}), InvalidSpec);
}

TEST_F(FileScene, PlaysAFileThatMovesForAsManyFramesAsAskedForAndThere) {
  write_scene(random_history<3>({.frames = 10}), path("moving.csv"));
  const NamedScene named = find_scene(path("moving.csv").string());
  EXPECT_TRUE(make_history<3>(named.scene, named.spec, {}).steps.empty());
  EXPECT_EQ(make_history<3>(named.scene, named.spec, {.frames = 4}).steps.size(), 4u);
  EXPECT_EQ(make_history<3>(named.scene, named.spec, {.frames = 40}).steps.size(), 10u);
}

TEST_F(FileScene, SaysOfAPathThatTheFileIsMissingAndNotTheScene) {
  EXPECT_THROW(find_scene(path("nothing.csv").string()), FileError);
  EXPECT_THROW(find_scene("nothing.btrace"), FileError);
  EXPECT_THROW(find_scene("nothing"), InvalidSpec);
  EXPECT_THROW(find_scene(put("a.csv", "min_x,min_y,max_x,max_y\n").string() + ":colour=red"), InvalidSpec);
}

TEST_F(Files, OfTheBunnyAreFoundWhereTheEnvironmentSays) {
  setenv("BROADSIDE_DATA", path("").c_str(), 1);
  EXPECT_THAT(generated::bunny().missing, AllOf(HasSubstr("bunny.obj"), HasSubstr("tools/setup/setup")));
  put("bunny.obj", "v 0 0 0\nv 1 0 0\nv 0 2 3\nf 1 2 3\n");
  const Scene scene = generated::bunny();
  unsetenv("BROADSIDE_DATA");
  EXPECT_EQ(scene.missing, "");
  EXPECT_EQ(make_history<2>(scene, Spec{"bunny", {}}, {}).boxes, (std::vector<Box2>{{{0, 0}, {1, 2}}}));
  EXPECT_EQ(make_history<3>(scene, Spec{"bunny", {}}, {}).boxes, (std::vector<Box3>{{{0, 0, 0}, {1, 2, 3}}}));
}

}  // namespace
}  // namespace broadside::lab
