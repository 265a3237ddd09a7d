// broadside pairs: what it finds, counts and writes, and what it says of input that it cannot use.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "process.hpp"
#include "refusal.hpp"

namespace broadside::cli {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

// Boxes 0 and 3 overlap; 1 touches 3 at a corner; 2 is alone.
const std::string four_boxes =
    "min_x,min_y,max_x,max_y\n"
    "0,0,2,2\n"
    "3,3,4,4\n"
    "10,10,11,11\n"
    "1,1,3,3\n";

TEST(PairsVerb, WritesThePairsAsCsvAndSaysWhatItDid) {
  const TemporaryFolder folder;
  const Ended ended = run({"pairs", folder.put("boxes.csv", four_boxes)});
  EXPECT_EQ(ended.status, 0);
  EXPECT_EQ(ended.output, "first,second\n0,3\n1,3\n");
  EXPECT_THAT(ended.errors, AllOf(HasSubstr("boxes.csv (4 boxes) in 2D: 2 pairs, exact in double; read in "),
                                  HasSubstr(", joined by auto in ")));
}

TEST(PairsVerb, OnlyCountsWhereThatIsAsked) {
  const TemporaryFolder folder;
  const Ended ended = run({"pairs", "--count", folder.put("boxes.csv", four_boxes)});
  EXPECT_EQ(ended.status, 0);
  EXPECT_EQ(ended.output, "2\n");
}

TEST(PairsVerb, WritesAnArrayIntoAPipe) {
  const TemporaryFolder folder;
  const std::string file = folder.put("boxes.csv", four_boxes);
  ASSERT_EQ(run({"pairs", file, "-o", folder.file("pairs.npy")}).status, 0);
  EXPECT_EQ(shell("$BROADSIDE pairs " + file + " --to npy | cat").output, text_of(folder.file("pairs.npy")));
}

const std::string keyed_boxes =
    "name,image,class,min_x,min_y,max_x,max_y\n"
    "a,left,cat,0,0,2,2\n"
    "b,right,cat,1,1,3,3\n"
    "c,left,dog,2,2,4,4\n"
    "d,right,dog,9,9,9,9\n";

TEST(PairsVerb, FindsOnlyPairsOfTheSameOrOfDifferentKeys) {
  const TemporaryFolder folder;
  const std::string file = folder.put("boxes.csv", keyed_boxes);
  EXPECT_EQ(run({"pairs", file, "--same", "image"}).output, "first,second\n0,2\n");
  EXPECT_EQ(run({"pairs", file, "--different", "image", "--ids", "name"}).output, "first,second\na,b\nb,c\n");
  EXPECT_EQ(run({"pairs", file, file, "--same", "image", "--count"}).output, "6\n");
  EXPECT_EQ(run({"pairs", file, "--same", "image", "--within", "6", "--count"}).output, "2\n");
  EXPECT_EQ(shell("cat " + file + " | $BROADSIDE pairs - --same image --count").output, "1\n");
  EXPECT_EQ(run({"pairs", file, "--same", "image", "--different", "class"}).output, "first,second\n0,2\n");
  EXPECT_EQ(run({"pairs", file, "--same", "class", "--different", "image", "--ids", "name"}).output,
            "first,second\na,b\n");
  EXPECT_EQ(run({"pairs", file, file, "--same", "image", "--different", "class", "--count"}).output, "2\n");
  EXPECT_EQ(run({"pairs", file, "--same", "image", "--different", "name", "--components"}).output,
            "box,component\n0,0\n1,1\n2,0\n3,3\n");
}

TEST(PairsVerb, WritesTheComponentOfEachBox) {
  const TemporaryFolder folder;
  const std::string file = folder.put("boxes.csv", keyed_boxes);
  const Ended ended = run({"pairs", file, "--components"});
  EXPECT_EQ(ended.output, "box,component\n0,0\n1,0\n2,0\n3,3\n");
  EXPECT_THAT(ended.errors, HasSubstr("(4 boxes) in 2D: 2 components, exact in double"));
  EXPECT_EQ(run({"pairs", file, "--components", "--ids", "name", "--same", "image"}).output,
            "box,component\na,a\nb,b\nc,a\nd,d\n");
}

TEST(PairsVerb, RefusesKeysAndComponentsThatItCannotUse) {
  const TemporaryFolder folder;
  const std::string file = folder.put("boxes.csv", keyed_boxes);
  const std::string no_key = folder.put("no.csv", "image,min_x,min_y,max_x,max_y\na,0,0,1,1\n,1,1,2,2\n");
  expect_refused(
      "pairs",
      {{{file, "--same", "image", "--different", "image"}, {"--same", "--different"}},
       {{file, "--same", "imag"}, {"no column 'imag'", "image"}},
       {{no_key, "--same", "image"}, {"no.csv: box 1 has no 'image'", "expected a key for each box"}},
       {{file, "--different", ""}, {"--different is ''"}},
       {{"-", "--same", "image", "--ids", "name"}, {"--same and --ids with '-'"}},
       {{"-", "--same", "image", "--different", "class"}, {"--different with '-'", "only once"}},
       {{file, file, "--components"}, {"--components with 2 files", "expected one"}},
       {{file, "--components", "--count"}, {"--components", "--count"}}});
}

std::string many_boxes(int count) {
  std::string rows = "min_x,min_y,max_x,max_y\n";
  for (std::int64_t i = 0; i < count; ++i) {
    const std::int64_t x = i * 7919 % 400;
    const std::int64_t y = i * 104729 % 397;
    rows += fmt::format("{},{},{},{}\n", x, y, x + 1 + i % 3, y + 1);
  }
  return rows;
}

TEST(PairsVerb, WritesTheSamePairsWithinALimitOfMemory) {
  const TemporaryFolder folder;
  const std::string csv = folder.put("boxes.csv", many_boxes(200'000));
  const std::string npy = folder.file("boxes.npy");
  ASSERT_EQ(run({"convert", csv, "-o", npy}).status, 0);
  const std::string expected = run({"pairs", csv}).output;
  for (const std::string& file : {csv, npy}) {
    const Ended ended = run({"pairs", file, "--memory", "32M", "--threads", "0"});
    EXPECT_EQ(ended.output, expected);
    EXPECT_THAT(ended.errors, AllOf(HasSubstr("(200,000 boxes) in 2D"), HasSubstr("in 32M of memory")));
    EXPECT_FALSE(std::filesystem::exists(file + ".work"));
    EXPECT_EQ(run({"pairs", file, "--memory", "32M", "--count"}).output,
              fmt::format("{}\n", std::ranges::count(expected, '\n') - 1));
  }
  const std::string few = folder.put("few.csv", many_boxes(3000));
  EXPECT_EQ(run({"pairs", npy, few, "--memory", "0.05G"}).output, run({"pairs", npy, few}).output);
}

TEST(PairsVerb, GoesOnWithAJoinThatWasKilled) {
  const TemporaryFolder folder;
  const std::string file = folder.put("boxes.csv", many_boxes(300'000));
  const std::string expected = run({"pairs", file}).output;
  const std::string work = folder.file("here");
  const std::vector<std::string> join = {"pairs", file, "--memory", "32M", "--work", work};
  {
    Process process(join);
    while (!std::filesystem::exists(work + "/manifest.json"))
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    process.signal(SIGKILL);
    process.wait();
  }
  EXPECT_EQ(run(join).output, expected);
  EXPECT_FALSE(std::filesystem::exists(work));
}

TEST(PairsVerb, LeavesOthersFilesInAWorkFolderAlone) {
  const TemporaryFolder folder;
  const std::string file = folder.put("scene.boxes", four_boxes);
  const std::string foreign = folder.put("my.pairs", "mine");
  const std::string folder_path = std::filesystem::path(file).parent_path();
  expect_refused("pairs", {{{file, "--format", "csv", "--memory", "1G", "--work", folder_path},
                            {"holds ", "expected an empty folder"}}});
  EXPECT_EQ(text_of(file), four_boxes);
  EXPECT_EQ(text_of(foreign), "mine");
  const std::string work = folder.file("work");
  std::filesystem::create_directory(work);
  expect_refused("pairs",
                 {{{file, "--format", "csv", "--memory", "1G", "--work", work, "-o", work + "/pairs.csv"},
                   {"lies in the work folder"}}});
}

TEST(PairsVerb, ReadsAFileWithinALimitOfMemoryWhateverItsNameIs) {
  const TemporaryFolder folder;
  const std::string file = folder.put("b\xff.csv", four_boxes);
  EXPECT_EQ(run({"pairs", file, "--memory", "1G"}).output, run({"pairs", file}).output);
}

TEST(PairsVerb, LeavesOutInvalidBoxesWithinALimitOfMemory) {
  const TemporaryFolder folder;
  const std::string file =
      folder.put("boxes.csv", "min_x,min_y,max_x,max_y\n0,0,1,1\n5,5,4,6\n1,1,2,2\nnan,0,1,1\n0,0,1,1\n");
  const std::string expected = run({"pairs", file, "--skip-invalid"}).output;
  EXPECT_EQ(std::ranges::count(expected, '\n'), 4);
  const Ended ended = run({"pairs", file, "--skip-invalid", "--memory", "1G"});
  EXPECT_EQ(ended.output, expected);
  // Once, although boxes are read twice.
  const std::size_t told = ended.errors.find("min <= max");
  EXPECT_NE(told, std::string::npos);
  EXPECT_EQ(ended.errors.find("min <= max", told + 1), std::string::npos);
}

TEST(PairsVerb, SaysWhatItRoundsWithinALimitOfMemory) {
  const TemporaryFolder folder;
  const std::string file = folder.put("boxes.csv", "0,0,1,1.1\n5,5,4,6\n");
  EXPECT_THAT(run({"pairs", file, "--precision", "float", "--skip-invalid", "--memory", "1G"}).errors,
              AllOf(HasSubstr("left out 1 invalid box\nbroadside: "),
                    HasSubstr("1 of 8 coordinates was rounded to float\n")));
}

TEST(PairsVerb, LeavesNoWorkFolderBehindWhereBoxesCannotBeRead) {
  const TemporaryFolder folder;
  const std::string file = folder.put("boxes.csv", four_boxes + "1,2,nan,3\n");
  EXPECT_NE(run({"pairs", file, "--memory", "1G"}).status, 0);
  EXPECT_FALSE(std::filesystem::exists(file + ".work"));
}

TEST(PairsVerb, SaysWhatALimitOfMemoryDoesNotGoWith) {
  const TemporaryFolder folder;
  const std::string file = folder.put("boxes.csv", four_boxes);
  expect_refused("pairs", {
                              {{file, "--memory", "many"}, {"--memory is 'many'", "such as 500M or 2G"}},
                              {{file, "--memory", "1M"}, {"--memory is '1M'", "too little", "32M or more"}},
                              {{file, "--work", folder.file("w")}, {"--work without --memory"}},
                              {{file, "--memory", "1G", "--within", "2"}, {"--within", "with --memory"}},
                              {{file, "--memory", "1G", "--work", file}, {"boxes.csv: is no folder"}},
                          });
  ASSERT_EQ(shell("gzip -k " + file).status, 0);
  expect_refused("pairs", {{{file + ".gz", "--memory", "1G"}, {"is compressed", "read again"}}});
  const std::string work = folder.file("w");
  std::filesystem::create_directory(work);
  EXPECT_EQ(shell("cd " + work + " && flock join.lock sh -c 'touch ../held; sleep 100' & while ! test -e " +
                  work + "/../held; do sleep 0.01; done; $BROADSIDE pairs " + file + " --memory 1G --work " +
                  work + "; status=$?; kill $!; exit $status")
                .status,
            2);
}

TEST(PairsVerb, LeavesItsInputAlone) {
  const TemporaryFolder folder;
  const std::string file = folder.put("boxes.csv", four_boxes);
  std::filesystem::create_symlink(file, folder.file("link.csv"));
  expect_refused("pairs", {
                              {{file, "-o", file}, {"-o is '" + file, "the input", "expected another file"}},
                              {{file, "-o", folder.file("link.csv")}, {"link.csv", "the input '" + file}},
                              {{file, "-o", folder.file("pairs.csv"), "--count"}, {"-o", "--count"}},
                              {{file, "--to", "csw"}, {"'csw'", "expected csv or npy"}},
                          });
  expect_refused("verify", {{{file, "--counterexample", file}, {"--counterexample", "the input"}}});
  EXPECT_EQ(text_of(file), four_boxes);
}

TEST(PairsVerb, SaysTheSameOfAnyOutputThatIsFull) {
  const TemporaryFolder folder;
  const std::string file = folder.put("boxes.csv", four_boxes);
  for (const std::string& arguments : {"pairs " + file, "pairs --count " + file, "info " + file,
                                       std::string("list"), std::string("--help")}) {
    const Ended ended = shell("$BROADSIDE " + arguments + " > /dev/full");
    EXPECT_EQ(ended.status, 2) << arguments;
    EXPECT_EQ(ended.errors, "broadside: standard output: cannot be written: No space left on device\n")
        << arguments;
  }
}

TEST(PairsVerb, JoinsTwoFilesAndFindsOnlyWhatIsBetweenThem) {
  const TemporaryFolder folder;
  const std::string right = folder.put("right.csv",
                                       "min_x,min_y,max_x,max_y\n"
                                       "2,2,2,2\n"
                                       "2,2,10,10\n");
  const Ended ended = run({"pairs", folder.put("left.csv", four_boxes), right});
  EXPECT_EQ(ended.status, 0);
  EXPECT_EQ(ended.output, "left,right\n0,0\n0,1\n1,1\n2,1\n3,0\n3,1\n");
  EXPECT_THAT(ended.errors, AllOf(HasSubstr("left.csv (4 boxes) with "), HasSubstr("right.csv (2 boxes)")));
}

TEST(PairsVerb, WritesTheUsersIds) {
  const TemporaryFolder folder;
  const std::string left = folder.put("left.csv",
                                      "name,min_x,min_y,max_x,max_y\n"
                                      "\"a, \"\"b\"\"\",0,0,2,2\n"
                                      "far off,9,9,9,9\n"
                                      "\" c\",1,1,3,3\n"
                                      ",,,,\n");
  const std::string right = folder.put("right.geojson", R"({"type": "FeatureCollection", "features": [
      {"type": "Feature", "id": 2.50, "properties": {"name": "line\nbreak"},
       "geometry": {"type": "Point", "coordinates": [2, 2]}},
      {"type": "Feature", "geometry": {"type": "Point", "coordinates": [9, 9]},
       "properties": {"other": 1, "name": "far"}, "id": "x"}]})");
  for (const std::string order : {"sorted", "found"}) {
    EXPECT_EQ(run({"pairs", left, "--ids", "name", "--order", order}).output,
              "first,second\n\"a, \"\"b\"\"\",\" c\"\n");
  }
  EXPECT_EQ(run({"pairs", "--ids", "name", left, right}).output,
            "left,right\n\"a, \"\"b\"\"\",\"line\nbreak\"\nfar off,far\n\" c\",\"line\nbreak\"\n");
  EXPECT_EQ(run({"pairs", "--ids", "name", "--ids", "id", left, right}).output,
            "left,right\n\"a, \"\"b\"\"\",2.50\nfar off,x\n\" c\",2.50\n");
  EXPECT_EQ(run({"convert", right, "--ids", "id", "--to", "csv", "-o", "-"}).output,
            "id,min_x,min_y,max_x,max_y\n2.50,2,2,2,2\nx,9,9,9,9\n");
  const std::string array = folder.file("left.npy");
  ASSERT_EQ(run({"convert", left, "-o", array}).status, 0);
  EXPECT_EQ(run({"convert", right, "--ids", "other", "--to", "csv", "-o", "-"}).output,
            "id,min_x,min_y,max_x,max_y\n,2,2,2,2\n1,9,9,9,9\n")
      << "a feature without the property has an empty id";
  const std::string no_ids = folder.put("no.csv", "id,min_x,min_y,max_x,max_y\n,0,0,1,1\nb,1,1,2,2\n");
  EXPECT_EQ(run({"pairs", no_ids, "--ids", "id"}).output, "first,second\n,b\n");
  expect_refused(
      "pairs",
      {
          {{left, "--ids", "nam"}, {"left.csv:1: no column 'nam'", "expected one of: name, min_x"}},
          {{left, "--ids", "min_x"}, {"column 'min_x' is read already"}},
          {{right, "--ids", "nme"}, {"right.geojson: no feature has a property 'nme'"}},
          {{left, "--ids", "name", "--ids", "name"}, {"--ids 2 times with 1 file"}},
          {{left, "--ids", "name", "--count"}, {"--ids with --count"}},
          {{left, "--ids", "name", "-o", folder.file("a.npy")}, {"--ids with an array", "expected CSV"}},
          {{array, "--ids", "name"}, {"format npy, which has no ids"}},
      });
}

TEST(PairsVerb, ReadsAPipeOnceAndNeverWaitsForASecondWriter) {
  const TemporaryFolder folder;
  const std::string pipe = folder.file("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string verb : {"pairs --count", "info", "draw -o -"}) {
    const Ended ended = shell("printf 'min_x,min_y,max_x,max_y\\n0,0,2,2\\n1,1,3,3\\n' > " + pipe +
                              " & $BROADSIDE " + verb + " " + pipe);
    EXPECT_EQ(ended.status, 0) << verb << ended.errors;
  }
  expect_refused("pairs", {{{pipe, pipe}, {"are one pipe; expected it once"}}});
}

TEST(PairsVerb, SaysHowASceneBecomesAFile) {
  for (const std::string verb : {"pairs", "convert"})
    expect_refused(verb, {{{"uniform", "-o", "out.csv"},
                           {"'uniform' is a scene; expected a file, such as `broadside scene uniform -o "
                            "uniform.csv` makes"}}});
}

TEST(PairsVerb, FindsWhatIsWithinADistance) {
  const TemporaryFolder folder;
  const std::string file = folder.put("points.csv", "name,lon,lat\na,0,0\nb,1,1\nc,0,2.5\n");
  const Ended ended = run({"pairs", file, "--within", "1", "--ids", "name"});
  EXPECT_EQ(ended.output, "first,second\na,b\n");
  EXPECT_THAT(ended.errors, HasSubstr("points.csv (3 boxes) in 2D: 1 pair within 1, exact in double"));
  EXPECT_EQ(run({"pairs", file, file, "--within", "1.5", "--count"}).output, "7\n");
  expect_refused("pairs", {
                              {{file, "--within", "-1"}, {"--within is '-1'", "a number of 0 or more"}},
                              {{file, "--within", "inf"}, {"--within is 'inf'"}},
                              {{file, "--within", "nan"}, {"--within is 'nan'"}},
                          });
}

TEST(PairsVerb, MeasuresADistanceInAStraightLineIfAsked) {
  const TemporaryFolder folder;
  const std::string file = folder.put("boxes.csv", "xmin,ymin,xmax,ymax\n0,0,1,1\n4,5,6,6\n4,1,4,1\n");
  EXPECT_EQ(run({"pairs", file, "--within", "4"}).output, "first,second\n0,1\n0,2\n1,2\n");
  const Ended ended = run({"pairs", file, "--within", "4.9", "--euclidean"});
  EXPECT_EQ(ended.output, "first,second\n0,2\n1,2\n");
  EXPECT_THAT(ended.errors, HasSubstr("2 pairs within 4.9 (Euclidean)"));
  EXPECT_EQ(run({"pairs", file, file, "--within", "5", "--euclidean", "--count"}).output, "9\n");
  expect_refused("pairs", {{{file, "--euclidean"}, {"--euclidean without --within"}}});
}

TEST(PairsVerb, PairsAroundTheEdgeIfSpaceRepeats) {
  const TemporaryFolder folder;
  const std::string file =
      folder.put("boxes.csv", "xmin,ymin,xmax,ymax\n170,0,190,1\n-180,0,-175,1\n0,0,1,1\n-10,358,-5,359\n");
  EXPECT_EQ(run({"pairs", file, "--period", "360,-"}).output, "first,second\n0,1\n");
  EXPECT_EQ(run({"pairs", file, "--period", "360,360", "--within", "6", "--euclidean"}).output,
            "first,second\n0,1\n2,3\n");
  EXPECT_EQ(run({"pairs", file, file, "--period", "360,-", "--count"}).output, "6\n");
  EXPECT_THAT(run({"pairs", file, "--period", "360,-"}).errors, HasSubstr("1 pair with period 360,-"));
  const std::string across = folder.put("across.csv", "xmin,ymin,xmax,ymax\n170,0,-170,1\n");
  expect_refused("pairs", {
                              {{across}, {"min (170, 0) and max (-170, 1)", "or --longitude of pairs"}},
                              {{file, "--period", "0,1"}, {"--period is '0,1'", "a number above 0"}},
                              {{file, "--period", "1,"}, {"--period is '1,'"}},
                              {{file, "--period", "360"}, {"1 period for boxes of 2 dimensions"}},
                              {{file, "--period", "1,1", "--within", "1"}, {"without --euclidean"}},
                              {{file, "--period", "1,1", "--no-touching"}, {"--no-touching with --period"}},
                              {{file, "--period", "1,1", "--algorithm", "karras_lbvh"},
                               {"--algorithm is 'karras_lbvh' with --period", "the library's own"}},
                          });
}

TEST(PairsVerb, TakesRowsFromEastToWestAsAcrossTheDateLine) {
  const TemporaryFolder folder;
  const std::string rows = "170,0,-170,1\n-175,0,-174,1\n179,1,180,2\n-180,2,-179,3\n0,0,1,1\n";
  const std::string plain = folder.put("plain.csv", "west,south,east,north\n" + rows);
  const std::string expected = "first,second\n0,1\n0,2\n2,3\n";
  EXPECT_EQ(run({"pairs", plain, "--longitude"}).output, expected);
  EXPECT_EQ(run({"pairs", plain, plain, "--longitude", "--count"}).output, "11\n");
  const std::string named = folder.put("named.csv", "min_lon,min_lat,max_lon,max_lat\n" + rows);
  const Ended ended = run({"pairs", named});
  EXPECT_EQ(ended.output, expected);
  EXPECT_THAT(ended.errors, HasSubstr("named.csv: 1 box is across the date line, so longitude repeats"));
  EXPECT_THAT(ended.errors, HasSubstr("3 pairs with period 360,-"));
  const std::string none =
      folder.put("none.csv", "min_lon,min_lat,max_lon,max_lat\n179,0,180,1\n-180,0,-179,1\n");
  EXPECT_EQ(run({"pairs", none, "--count"}).output, "0\n") << "no box is across";
  EXPECT_EQ(run({"pairs", none, "--longitude", "--count"}).output, "1\n");
  EXPECT_EQ(run({"pairs", named, "--within", "1", "--euclidean", "--count"}).output, "4\n");
  const std::string swapped = folder.put("swapped.csv", "min_lon,min_lat,max_lon,max_lat\n10,0,5,1\n");
  expect_refused("pairs", {{{swapped}, {"min (10, 0) and max (5, 1)"}},
                           {{plain}, {"min (170, 0) and max (-170, 1)", "or --longitude of pairs"}},
                           {{named, "--no-touching"}, {"min (170, 0) and max (-170, 1)"}},
                           {{named, "--longitude", "--no-touching"}, {"--no-touching with --longitude"}},
                           {{named, "--longitude", "--period", "360,-"}, {"--longitude with --period"}},
                           {{named, "--longitude", "--within", "1"}, {"--longitude and --within without"}}});
}

TEST(PairsVerb, LeavesOutWhatOnlyTouches) {
  const TemporaryFolder folder;
  const std::string file = folder.put("boxes.csv", four_boxes);
  const Ended ended = run({"pairs", file, "--no-touching"});
  EXPECT_EQ(ended.output, "first,second\n0,3\n");
  EXPECT_THAT(ended.errors, HasSubstr("in 2D: 1 pair, without pairs that only touch, exact in double"));
  EXPECT_EQ(run({"pairs", file, "--no-touching", "--memory", "32M"}).output, ended.output);
  EXPECT_EQ(run({"pairs", file, file, "--no-touching", "--count"}).output, "6\n");
  // The float below 1 and the double below 1 differ: both files are doubles first.
  const std::string narrow = folder.put("narrow.csv", "min_x,min_y,max_x,max_y\n0.99999999,0,2,2\n");
  const std::string floats = folder.file("floats.npy");
  const std::string tile = folder.put("tile.csv", "min_x,min_y,max_x,max_y\n0,0,1,1\n");
  ASSERT_EQ(run({"convert", tile, "-o", floats, "--precision", "float"}).status, 0);
  EXPECT_EQ(run({"pairs", floats, narrow, "--no-touching", "--count"}).output, "1\n");
  expect_refused("pairs", {{{file, "--no-touching", "--within", "1"}, {"--no-touching with --within"}}});
}

TEST(PairsVerb, LeavesOutWhatIsInvalidAndSaysWhich) {
  const TemporaryFolder folder;
  const std::string table = folder.put("boxes.csv", four_boxes + "1,1,x,1\n0,0,9,9\n");
  const Ended ended = run({"pairs", table, "--skip-invalid"});
  EXPECT_EQ(ended.output, "first,second\n0,3\n0,5\n1,3\n1,5\n3,5\n");
  EXPECT_THAT(ended.errors, AllOf(HasSubstr("boxes.csv:6: column max_x is 'x', text; expected a number"),
                                  HasSubstr("boxes.csv: left out 1 invalid box\n"),
                                  HasSubstr("(6 boxes, 1 of them absent)")));
  const std::string map = folder.put("map.geojson", R"({"type": "FeatureCollection", "features": [
      {"type": "Feature", "id": 1, "geometry": {"type": "LineString", "coordinates": [[0, 0], [1, "x"]]}},
      {"type": "Feature", "id": 2, "geometry": {"type": "Point", "coordinates": [1, 1]}},
      {"type": "Feature", "geometry": {"type": "Point", "coordinates": [1, 1]}},
      5,
      {"type": "Feature", "id": 3, "geometry": {"type": "Point", "coordinates": [1, 1]}}]})");
  const Ended mapped = run({"pairs", map, "--skip-invalid", "--ids", "id"});
  EXPECT_EQ(mapped.output, "first,second\n2,\n2,3\n,3\n");
  EXPECT_THAT(mapped.errors,
              AllOf(HasSubstr("feature 0: 'x'; expected a number"), HasSubstr("left out 2 invalid boxes")));
  EXPECT_EQ(run({"pairs", map, "--skip-invalid"}).output, "first,second\n1,2\n1,4\n2,4\n");
  const std::string array = folder.file("boxes.npy");
  ASSERT_EQ(run({"scene", "uniform", "-n", "5", "-o", array}).status, 0);
  expect_refused("pairs",
                 {{{array, "--skip-invalid"}, {"format npy", "--skip-invalid can leave nothing out"}}});
}

TEST(PairsVerb, IsExactInThePrecisionOfTheInput) {
  const TemporaryFolder folder;
  // A gap that a float does not see at this distance.
  const std::string file = folder.put("boxes.csv",
                                      "min_x,min_y,max_x,max_y\n"
                                      "5000000,0,5000000.001,1\n"
                                      "5000000.002,0,5000001,1\n");
  EXPECT_EQ(run({"pairs", "--count", file}).output, "0\n");
  const Ended rounded = run({"pairs", "--count", file, "--precision", "float"});
  EXPECT_EQ(rounded.output, "1\n");
  EXPECT_THAT(rounded.errors,
              HasSubstr("1 pair, in float, to which 2 of 8 coordinates were rounded; read in "));
}

TEST(PairsVerb, IsExactInThePrecisionOfAMesh) {
  const TemporaryFolder folder;
  // Two triangles with a gap between them that a float does not see at this distance.
  const std::vector<std::string> vertices = {"5000000 0 0",     "5000000.001 0 0", "5000000 1 0",
                                             "5000000.002 0 0", "5000001 0 0",     "5000001 1 0"};
  std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty double x\nproperty double y\nproperty double z\n"
      "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
  std::string obj;
  for (const std::string& vertex : vertices) {
    ply += vertex + '\n';
    obj += "v " + vertex + '\n';
  }
  const std::string off =
      folder.put("a.off", "OFF\n6 2 0\n" + ply.substr(ply.find("5000000")) + "3 0 1 2\n3 3 4 5\n");
  for (const std::string& file :
       {folder.put("a.ply", ply + "3 0 1 2\n3 3 4 5\n"), folder.put("a.obj", obj + "f 1 2 3\nf 4 5 6\n")}) {
    for (const bool is_swept : {false, true}) {
      const auto count = [&](const std::string& mesh, const std::string& precision) {
        std::vector<std::string> arguments = {"pairs", "--count", mesh};
        if (is_swept)
          arguments.insert(arguments.end(), {mesh, "--swept", "--left", "faces", "--right", "faces"});
        if (!precision.empty()) arguments.insert(arguments.end(), {"--precision", precision});
        return run(arguments);
      };
      for (const std::string precision : {"", "double"}) {
        const Ended exact = count(file, precision);
        EXPECT_EQ(exact.output, "0\n") << file;
        EXPECT_THAT(exact.errors, HasSubstr("0 pairs, exact in double; "));
      }
      const Ended rounded = count(file, "float");
      EXPECT_EQ(rounded.output, "1\n");
      EXPECT_THAT(rounded.errors,
                  HasSubstr("1 pair, in float, to which 2 of 12 coordinates were rounded; read in "));
      const Ended imported = count(off, "double");
      if (imported.status == 0) {  // with assimp
        EXPECT_EQ(imported.output, "1\n");
        EXPECT_THAT(imported.errors,
                    HasSubstr("1 pair, in double, of coordinates that assimp reads as floats; "));
      }
    }
  }
}

TEST(PairsVerb, JoinsFloatsWithDoublesAsDoubles) {
  const TemporaryFolder folder;
  const std::string doubles = folder.put("boxes.csv", four_boxes);
  const std::string floats = folder.file("boxes.btrace");
  ASSERT_EQ(run({"convert", doubles, "--precision", "float", "-o", floats}).status, 0);
  EXPECT_THAT(run({"pairs", "--count", floats}).errors, HasSubstr("exact in float"));
  const Ended ended = run({"pairs", "--count", floats, doubles});
  EXPECT_EQ(ended.output, "8\n");
  EXPECT_THAT(ended.errors, HasSubstr("exact in double"));
}

TEST(PairsVerb, SortsSoThatTheAlgorithmMakesNoDifference) {
  const TemporaryFolder folder;
  const std::string file = folder.file("boxes.csv");
  ASSERT_EQ(run({"scene", "clustered", "-n", "500", "-o", file}).status, 0);
  const std::string expected = run({"pairs", file}).output;
  std::istringstream lines(expected);
  std::vector<std::string> found;
  for (std::string line; std::getline(lines, line);) found.push_back(line);
  EXPECT_GT(found.size(), 100u);
  for (const std::string algorithm : {"brute_force", "quadtree", "sweep_and_prune", "paper_grid"}) {
    EXPECT_EQ(run({"pairs", file, "--algorithm", algorithm}).output, expected);
    // As they are found: the same pairs, and the same order again.
    const Ended streamed = run({"pairs", file, "--algorithm", algorithm, "--order", "found"});
    EXPECT_EQ(run({"pairs", file, "--algorithm", algorithm, "--order", "found"}).output, streamed.output);
    std::istringstream more(streamed.output);
    std::vector<std::string> unsorted;
    for (std::string line; std::getline(more, line);) unsorted.push_back(line);
    EXPECT_TRUE(std::ranges::is_permutation(unsorted, found));
  }
}

TEST(PairsVerb, TakesAFrameOfAFileThatMoves) {
  const TemporaryFolder folder;
  const std::string file = folder.put("boxes.csv",
                                      "frame,box,min_x,min_y,max_x,max_y\n"
                                      "0,0,0,0,1,1\n"
                                      "0,1,5,5,6,6\n"
                                      "1,1,1,1,2,2\n");
  const Ended first = run({"pairs", "--count", file});
  EXPECT_EQ(first.output, "0\n");
  EXPECT_THAT(first.errors, HasSubstr("holds several frames; these are the pairs of the first (--frame 0)"));
  EXPECT_EQ(run({"pairs", "--count", file, "--frame", "1"}).output, "1\n");
  const Ended beyond = run({"pairs", "--count", file, "--frame", "2"});
  EXPECT_EQ(beyond.status, 2);
  EXPECT_THAT(beyond.errors, HasSubstr("--frame is 2; expected 0 to 1, as the file has 2 frames"));
}

TEST(PairsVerb, TakesAllFramesOfAFileThatMoves) {
  const TemporaryFolder folder;
  const std::string file = folder.put("boxes.csv",
                                      "frame,box,min_x,min_y,max_x,max_y\n"
                                      "0,0,0,0,1,1\n"
                                      "0,1,5,5,6,6\n"
                                      "0,2,6,6,7,7\n"
                                      "1,0,4,4,8,8\n"
                                      "2,,,,,\n"
                                      "3,1,,,,\n");
  const std::string expected = "frame,first,second\n0,1,2\n1,0,1\n1,0,2\n1,1,2\n2,0,1\n2,0,2\n2,1,2\n3,0,2\n";
  const Ended all = run({"pairs", file, "--frame", "all"});
  EXPECT_EQ(all.output, expected);
  EXPECT_THAT(all.errors,
              HasSubstr("(12 boxes in 4 frames, 1 of them absent) in 2D: 8 pairs, exact in double"));
  EXPECT_EQ(run({"pairs", file, "--frame", "all", "--count"}).output, "8\n");
  EXPECT_EQ(run({"pairs", file, "--frame", "all", "--no-touching", "--count"}).output, "5\n");
  EXPECT_EQ(run({"pairs", file, "--frame", "all", "--precision", "float", "--algorithm", "grid"}).output,
            expected);
  ASSERT_EQ(run({"pairs", file, "--frame", "all", "-o", folder.file("pairs.npy")}).status, 0);
  EXPECT_THAT(text_of(folder.file("pairs.npy")), HasSubstr("(8, 3)"));
  expect_refused("pairs", {{{file, file, "--frame", "all"}, {"--frame all with 2 files", "expected one"}},
                           {{file, "--frame", "all", "--within", "1"}, {"--frame", "--within"}},
                           {{file, "--frame", "all", "--ids", "box"}, {"--frame", "--ids"}},
                           {{file, "--frame", "all", "--algorithm", "karras_lbvh"},
                            {"--algorithm is 'karras_lbvh' with --frame all", "the library's own"}},
                           {{file, "--frame", "every"}, {"--frame is 'every'"}}});
}

/// Two triangles with an edge in common, and one far above them that comes down onto them later.
std::string mesh_with_height(int height) {
  return "ply\nformat ascii 1.0\nelement vertex 7\nproperty float x\nproperty float y\nproperty float z\n"
         "element face 3\nproperty list uchar int vertex_indices\nend_header\n"
         "0 0 0\n1 0 0\n1 1 0\n0 1 0\n" +
         fmt::format("0 0 {0}\n1 0 {0}\n1 1 {0}\n", height) + "3 0 1 2\n3 0 2 3\n3 4 5 6\n";
}

TEST(PairsVerb, JoinsThePartsOfAMeshOverTwoTimes) {
  const TemporaryFolder folder;
  const std::string before = folder.put("before.ply", mesh_with_height(9));
  const std::string after = folder.put("after.ply", mesh_with_height(0));
  const auto pairs = [&](const std::string& later, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"pairs", "--swept", before, later};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  };
  const std::vector<std::string> faces = {"--left", "faces", "--right", "faces"};
  EXPECT_EQ(pairs(before, faces).output, "first,second\n0,1\n");
  EXPECT_EQ(pairs(after, faces).output, "first,second\n0,1\n0,2\n1,2\n");
  const std::vector<std::string> apart = {"--left", "vertices", "--right", "faces", "--exclude-shared"};
  // Bounds touch where triangles do not: vertex 1 is at a corner of face 1's box, and 3 of face 0's.
  EXPECT_EQ(pairs(before, apart).output, "left,right\n1,1\n3,0\n");
  const Ended ended = pairs(after, apart);
  EXPECT_THAT(ended.output, HasSubstr("\n4,0\n"));
  EXPECT_THAT(ended.errors, HasSubstr("after.ply: vertices (7 boxes) with faces (3 boxes) in 3D: "));
}

TEST(PairsVerb, ReadsStandardInputAndFollowsAPipe) {
  const TemporaryFolder folder;
  const std::string file = folder.put("boxes.csv", four_boxes);
  const Ended piped = shell("cat " + file + " | $BROADSIDE pairs - | cat");
  EXPECT_EQ(piped.output, "first,second\n0,3\n1,3\n");
  EXPECT_THAT(piped.errors, HasSubstr("standard input (4 boxes)"));
  EXPECT_EQ(shell("$BROADSIDE pairs --count - " + file + " < " + file).output, "8\n");
}

TEST(PairsVerb, WritesAFileWholeOrNotAtAll) {
  const TemporaryFolder folder;
  const std::string file = folder.put("boxes.csv", four_boxes);
  const Ended ended = run({"pairs", file, "-o", folder.file("pairs.csv")});
  EXPECT_EQ(ended.status, 0);
  EXPECT_EQ(ended.output, "");
  EXPECT_EQ(text_of(folder.file("pairs.csv")), "first,second\n0,3\n1,3\n");
  const std::string array = folder.file("pairs.npy");
  for (const std::string order : {"sorted", "found"}) {
    ASSERT_EQ(run({"pairs", file, "-o", array, "--order", order}).status, 0);
    const std::string text = text_of(array);
    EXPECT_THAT(text, AllOf(StartsWith("\x93NUMPY"), HasSubstr("'<u4'"), HasSubstr("(2, 2)")));
    EXPECT_THAT(text, EndsWith(std::string("\0\0\0\0\3\0\0\0\1\0\0\0\3\0\0\0", 16)));
  }
  EXPECT_EQ(run({"pairs", folder.put("bad.csv", "min_x\n"), "-o", folder.file("none.csv")}).status, 2);
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"bad.csv", "boxes.csv", "pairs.csv", "pairs.npy"}));
  const Ended full = run({"pairs", file, "-o", "/dev/full"});
  EXPECT_EQ(full.status, 2);
  EXPECT_THAT(full.errors, HasSubstr("/dev/full: cannot be written: No space left on device"));
  const Ended no_room = shell("$BROADSIDE pairs " + file + " > /dev/full");
  EXPECT_EQ(no_room.status, 2);
  EXPECT_THAT(no_room.errors, HasSubstr("standard output: cannot be written"));
}

TEST(PairsVerb, LeavesNothingHalfDoneWheneverItIsInterrupted) {
  const TemporaryFolder folder;
  const std::string file = folder.file("boxes.npy");
  ASSERT_EQ(run({"scene", "one_point", "-n", "4000", "-o", file}).status, 0);
  for (const std::string order : {"sorted", "found"}) {
    for (const int milliseconds : {1, 50, 150}) {
      const std::string output = folder.file("pairs.npy");
      Process process({"pairs", file, "--order", order, "-o", output});
      std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
      process.signal(SIGINT);
      const int status = process.wait().status;
      if (folder.names() == std::vector<std::string>{"boxes.npy"}) {
        EXPECT_EQ(status, 130);
      } else {
        EXPECT_EQ(folder.names(), (std::vector<std::string>{"boxes.npy", "pairs.npy"}));
        EXPECT_GT(std::filesystem::file_size(output), 8u * 4000 * 3999 / 2);
        std::filesystem::remove(output);
      }
    }
  }
}

TEST(PairsVerb, RefusesWhatItCannotUseAndSaysWhy) {
  const TemporaryFolder folder;
  const std::string file = folder.put("boxes.csv", four_boxes);
  const std::string solid = folder.put("solid.csv", "min_x,min_y,min_z,max_x,max_y,max_z\n0,0,0,1,1,1\n");
  const std::vector<Refusal> refusals = {
      {{}, {"files"}},
      {{file, file, file}, {"3 files", "expected one"}},
      {{"-", "-"}, {"standard input twice"}},
      {{folder.file("missing.csv")}, {"missing.csv", "No such file"}},
      {{"/"}, {"/: cannot be read: Is a directory"}},
      {{folder.put("empty.csv", "")}, {"empty.csv", "empty"}},
      {{folder.put("words.csv", "min_x,min_y,max_x,max_y\n0,0,much,1\n")}, {"words.csv:2", "'much'"}},
      {{folder.put("bad.csv", "min_x,min_y,max_x,max_y\n0,0,\x1b[2J,1\n")}, {"bad.csv:2", "'?[2J'"}},
      {{file, solid}, {"in 2D", "in 3D", "--dimension 2"}},
      {{file, "--order", "any"}, {"--order is 'any'", "expected sorted or found"}},
      {{"--swept", file, "--left", "faces", "--right", "faces"}, {"--swept with 1 file", "expected two"}},
      {{"--swept", file, file, "--left", "faces"}, {"--right is ''", "expected vertices, edges or faces"}},
      {{"--swept", file, file, "--left", "faces", "--right", "faces", "--frame", "1"}, {"with --swept"}},
      {{file, "--exclude-shared"}, {"without --swept"}},
      {{file, "--frame", "-1"}, {"--frame is '-1'", "expected a whole number from 0"}},
      {{file, "--precision", "half"}, {"--precision is 'half'", "expected float or double"}},
      {{file, "--dimension", "4"}, {"--dimension is 4"}},
      {{file, "--format", "csw"}, {"unknown format 'csw'", "csv"}},
      {{file, "--boxes", "triangles"}, {"boxes of 'triangles' in format csv"}},
      {{file, "--algorithm", "gird"}, {"'gird'", "grid"}},
      {{file, "--algorithm", "own"}, {"--algorithm is 'own'", "expected one"}},
      {{file, "-o", folder.file("pairs.txt")}, {"'.txt'", "expected .csv or .npy"}},
      {{file, "-o", "/nowhere/pairs.csv"}, {"no folder '/nowhere'"}},
  };
  expect_refused("pairs", refusals);
}

}  // namespace
}  // namespace broadside::cli
