// Files that mean harm: inputs without an end, and what is planted where an output is written.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "process.hpp"

namespace broadside::cli {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string two_boxes = "0,0,1,1\n1,1,2,2\n";

const std::vector<std::string> formats = {"trace", "csv", "npy", "npz", "map", "mesh", "ply", "obj"};

TEST(InputWithoutEnd, IsRefusedInEveryFormatBeforeItTakesMemory) {
  for (const std::string& format : formats) {
    // The mesh format's extensions are names for it.
    const Ended zero = run({"info", "--format", format, "/dev/zero"});
    EXPECT_EQ(zero.status, 2) << format;
    EXPECT_EQ(zero.errors,
              "broadside: /dev/zero: begins with 512 zero bytes, as no format does; expected boxes\n");
    const Ended random = run({"info", "--format", format, "/dev/urandom"});
    EXPECT_EQ(random.status, 2) << format;
    EXPECT_THAT(random.errors, AllOf(HasSubstr("/dev/urandom: "), HasSubstr("; expected "))) << format;
  }
}

TEST(InputWithoutEnd, ThroughAPipeIsRefusedOnceMemoryIsShort) {
  // Under a sanitizer the program needs more memory than it can be given here.
  if (BROADSIDE_SANITIZED != 0) GTEST_SKIP() << "a sanitizer takes terabytes of addresses";
  const Ended ended = shell("ulimit -v 300000; yes 0,0,1,1, | tr -d '\\n' | $BROADSIDE info --format csv -");
  EXPECT_EQ(ended.status, 2);
  EXPECT_THAT(ended.errors,
              AllOf(HasSubstr("standard input: goes on after "), HasSubstr("; expected an end, or a file")));
}

TEST(InputThatClaimsMore, ThanItHoldsIsRefusedBeforeMemoryIsTakenForIt) {
  const TemporaryFolder folder;
  const std::string off = folder.put("a.off", "OFF\n# a comment\n4000000000 1 0\n0 0 0\n");
  const Ended ended = run({"info", off});
  EXPECT_EQ(ended.status, 2);
  EXPECT_EQ(ended.errors, "broadside: " + off +
                              ": claims 4000000000 vertices or faces and has 37 bytes; expected no more than "
                              "there is room for\n");
}

TEST(Output, FollowsNoLinkThatIsPlantedBesideIt) {
  const TemporaryFolder folder;
  const std::string boxes = folder.put("boxes.csv", two_boxes);
  const std::string precious = folder.put("precious", "kept\n");
  const std::string output = folder.file("out.npy");
  // An attacker may know the next process's number. Here exec keeps the shell's.
  const Ended ended = shell("ln -s " + precious + " " + output + ".$$.part; exec $BROADSIDE convert " +
                            boxes + " -o " + output);
  EXPECT_EQ(ended.status, 0) << ended.errors;
  EXPECT_EQ(text_of(precious), "kept\n");
  EXPECT_FALSE(fs::is_symlink(output));
}

TEST(Output, LeavesNothingWhereTheProgramIsKilled) {
  const TemporaryFolder folder;
  const std::string output = folder.put("out.csv", "old\n");
  Process process({"scene", "uniform", "-n", "1M", "-o", output});
  for (int i = 0; i < 60'000 && !process.has_open_file_in(folder); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  process.signal(SIGKILL);
  EXPECT_EQ(process.wait().status, 128 + SIGKILL);
  EXPECT_EQ(text_of(output), "old\n");
  const std::vector<std::string> names = folder.names();
  // A file system without files that have no name keeps one, of a name that says what it is.
  const bool has_unnamed = names.size() == 1;
  EXPECT_TRUE(has_unnamed || std::ranges::any_of(names, [](const std::string& name) {
                return name.starts_with(".broadside-") && name.ends_with(".part");
              }));
}

TEST(Output, HasThePermissionsOfItsUmaskOrOfTheOldFile) {
  const TemporaryFolder folder;
  const std::string boxes = folder.put("boxes.csv", two_boxes);
  const auto mode_of = [](const std::string& path) {
    struct stat status {};
    stat(path.c_str(), &status);
    return status.st_mode & 07777;
  };
  ASSERT_EQ(shell("umask 027; $BROADSIDE convert " + boxes + " -o " + folder.file("new.npy")).status, 0);
  EXPECT_EQ(mode_of(folder.file("new.npy")), 0640u);
  // But not the bits that run it as its owner.
  chmod(folder.put("old.npy", "old").c_str(), 06604);
  ASSERT_EQ(run({"convert", boxes, "-o", folder.file("old.npy")}).status, 0);
  EXPECT_EQ(mode_of(folder.file("old.npy")), 0604u);
  EXPECT_THAT(folder.names(), ElementsAre("boxes.csv", "new.npy", "old.npy"));
}

TEST(Output, ThatIsReadOnlyIsNotReplaced) {
  const TemporaryFolder folder;
  const std::string boxes = folder.put("boxes.csv", two_boxes);
  const std::string output = folder.put("out.csv", "old\n");
  chmod(output.c_str(), 0444);
  fs::create_symlink(output, folder.file("link.csv"));
  for (const std::string& path : {output, folder.file("link.csv")}) {
    const Ended ended = run({"convert", boxes, "-o", path});
    EXPECT_EQ(ended.status, 2);
    EXPECT_THAT(ended.output, IsEmpty());
    EXPECT_THAT(ended.errors,
                AllOf(HasSubstr(path), HasSubstr("is read-only; expected a file that may be written")));
  }
  EXPECT_EQ(text_of(output), "old\n");
}

TEST(Output, OfTheLongestNameThatThereCanBeIsWritten) {
  const TemporaryFolder folder;
  const std::string boxes = folder.put("boxes.csv", two_boxes);
  const std::string output = folder.file(std::string(251, 'a') + ".csv");
  const Ended ended = run({"convert", boxes, "-o", output});
  EXPECT_EQ(ended.status, 0) << ended.errors;
  EXPECT_TRUE(fs::exists(output));
}

}  // namespace
}  // namespace broadside::cli
