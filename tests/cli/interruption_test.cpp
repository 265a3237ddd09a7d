// What a signal, or a pipe that nothing reads any more, leaves of a file that is being written.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "process.hpp"

namespace broadside::cli {
namespace {

using testing::ElementsAre;

bool is_being_written(const TemporaryFolder& folder) {
  return std::ranges::any_of(folder.names(), [](const std::string& name) { return name.ends_with(".part"); });
}

TEST(Interruption, EndsTheWritingOfOneLargeFrameAndKeepsTheOldFile) {
  const TemporaryFolder folder;
  const std::string boxes = folder.file("boxes.npy");
  ASSERT_EQ(run({"scene", "uniform", "-n", "1M", "-o", boxes}).status, 0);
  const std::string output = folder.put("out.csv", "old\n");
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"scene", "uniform", "-n", "1M", "-o", output},
        {"convert", boxes, "-o", output},
        {"pairs", boxes, "-o", output}}) {
    Process process(arguments);
    for (int i = 0; i < 60'000 && !is_being_written(folder); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    process.signal(SIGINT);
    const Ended ended = process.wait();
    EXPECT_EQ(ended.status, 130) << arguments[0];
    EXPECT_EQ(ended.errors, "broadside: interrupted\n") << arguments[0];
    EXPECT_THAT(folder.names(), ElementsAre("boxes.npy", "out.csv")) << arguments[0];
    EXPECT_EQ(text_of(output), "old\n") << arguments[0];
  }
}

TEST(ClosedPipe, EndsTheProgramWithoutAMessage) {
  const TemporaryFolder folder;
  const std::string boxes = folder.file("boxes.npy");
  ASSERT_EQ(run({"scene", "uniform", "-n", "100k", "-o", boxes}).status, 0);
  const std::string status = folder.file("status");
  for (const std::string& arguments :
       {"pairs " + boxes, "convert " + boxes + " --to csv -o -",
        std::string("scene uniform -n 100k --to csv -o /dev/stdout"), "draw " + boxes + " -n 20000 -o -"}) {
    const Ended ended = shell("{ $BROADSIDE " + arguments + "; echo $? > " + status + "; } | head -c 1");
    EXPECT_EQ(text_of(status), "141\n") << arguments;
    EXPECT_EQ(ended.errors, "") << arguments;
    EXPECT_EQ(ended.output.size(), 1u) << arguments;
  }
}

TEST(ClosedPipe, EndsEveryVerbThatPrints) {
  const TemporaryFolder folder;
  const std::string status = folder.file("status");
  const std::string boxes = folder.put("boxes.csv", "0,0,1,1\n1,1,2,2\n");
  // `true` has gone before anything is written.
  for (const std::string& arguments : {std::string("list"), std::string("--help"), "info " + boxes,
                                       "pairs --count " + boxes, "verify " + boxes}) {
    const Ended ended =
        shell("{ sleep 0.2; $BROADSIDE " + arguments + "; echo $? > " + status + "; } | true");
    EXPECT_EQ(text_of(status), "141\n") << arguments;
    EXPECT_EQ(ended.errors, "") << arguments;
  }
}

}  // namespace
}  // namespace broadside::cli
