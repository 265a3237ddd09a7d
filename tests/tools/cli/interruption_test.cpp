// What a signal, or a pipe that nothing reads any more, leaves of a file that is being written.
#include <atomic>
#include <chrono>
#include <csignal>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "process.hpp"

namespace broadside::cli {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// A pipe with a name that nothing reads: what is written to it waits once it is full.
class UnreadPipe {
 public:
  explicit UnreadPipe(std::string path) : path_(std::move(path)) {
    if (mkfifo(path_.c_str(), 0600) != 0) throw std::runtime_error(path_ + ": no pipe can be made");
    descriptor_ = open(path_.c_str(), O_RDWR | O_CLOEXEC);
  }
  ~UnreadPipe() { shut(); }
  UnreadPipe(const UnreadPipe&) = delete;
  UnreadPipe& operator=(const UnreadPipe&) = delete;

  const std::string& path() const { return path_; }

  bool is_full() const {
    constexpr int most = 65536;
    int bytes = 0;
    return ioctl(descriptor_, FIONREAD, &bytes) == 0 && bytes >= most;
  }

  /// From here on, a write to it fails.
  void shut() {
    if (const int descriptor = descriptor_.exchange(-1); descriptor >= 0) close(descriptor);
  }

 private:
  std::string path_;
  std::atomic<int> descriptor_ = -1;
};

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
    for (int i = 0; i < 60'000 && !process.has_open_file_in(folder); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    process.signal(SIGINT);
    const Ended ended = process.wait();
    EXPECT_EQ(ended.status, 130) << arguments[0];
    EXPECT_EQ(ended.errors, "broadside: interrupted\n") << arguments[0];
    EXPECT_THAT(folder.names(), ElementsAre("boxes.npy", "out.csv")) << arguments[0];
    EXPECT_EQ(text_of(output), "old\n") << arguments[0];
  }
}

TEST(Interruption, DoesNotWaitForTheEndOfAFrame) {
  const TemporaryFolder folder;
  UnreadPipe pipe(folder.file("pipe"));
  Process process({"scene", "uniform", "-n", "100k", "--to", "csv", "-o", pipe.path()});
  for (int i = 0; i < 60'000 && !pipe.is_full(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  process.signal(SIGINT);
  // A program that waits for the end of its write is let go, with another status.
  std::atomic<bool> has_ended = false;
  std::thread watch([&] {
    for (int i = 0; i < 500 && !has_ended; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    pipe.shut();
  });
  const Ended ended = process.wait();
  has_ended = true;
  watch.join();
  EXPECT_EQ(ended.status, 130);
  EXPECT_EQ(ended.errors, "broadside: interrupted\n");
}

TEST(Interruption, SaysHowToGoOnWithAJoinOnDisk) {
  const TemporaryFolder folder;
  const std::string boxes = folder.file("boxes.npy");
  ASSERT_EQ(run({"scene", "uniform", "-n", "50k", "-o", boxes}).status, 0);
  const std::vector<std::string> join = {"pairs", boxes, "--memory", "32M"};
  const Ended whole = run(join);
  EXPECT_THAT(whole.errors, Not(HasSubstr("resumes")));
  {
    UnreadPipe pipe(folder.file("pipe"));
    Process process({"pairs", boxes, "--memory", "32M", "--to", "csv", "-o", pipe.path()});
    for (int i = 0; i < 60'000 && !pipe.is_full(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    process.signal(SIGINT);
    const Ended ended = process.wait();
    EXPECT_EQ(ended.status, 130);
    EXPECT_EQ(ended.errors,
              "broadside: interrupted; " + boxes + ".work is left, and the same command resumes from it\n");
  }
  const Ended resumed = run(join);
  EXPECT_EQ(resumed.output, whole.output);
  EXPECT_THAT(resumed.errors, HasSubstr(boxes + ".work: resumes the join that was interrupted\n"));
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
  const std::string boxes = folder.put("boxes.csv", "min_x,min_y,max_x,max_y\n0,0,1,1\n1,1,2,2\n");
  const std::string gone = folder.file("gone");
  // The reader has closed the pipe before anything is written.
  for (const std::string& arguments : {std::string("list"), std::string("--help"), "info " + boxes,
                                       "pairs --count " + boxes, "verify " + boxes}) {
    const Ended ended =
        shell("rm -f " + gone + "; { while [ ! -e " + gone + " ]; do sleep 0.01; done; $BROADSIDE " +
              arguments + "; echo $? > " + status + "; } | { exec <&-; touch " + gone + "; }");
    EXPECT_EQ(text_of(status), "141\n") << arguments;
    EXPECT_EQ(ended.errors, "") << arguments;
  }
}

}  // namespace
}  // namespace broadside::cli
