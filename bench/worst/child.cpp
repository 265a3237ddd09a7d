// A call in a process of its own, which can be ended at any time.
#include "bench/worst/child.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>
#include <system_error>

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

namespace broadside::bench {
namespace {

/// A Run as it goes through a pipe: less than a pipe takes at once.
struct Message {
  Run::End end;
  double milliseconds;
  double worst_milliseconds;
  double tests;
  std::uint64_t pairs;
  std::uint64_t events;
  std::uint64_t hash;
  double peak_bytes;
  std::array<char, 256> fault;
};

[[noreturn]] void answer(int pipe, std::uint64_t most_bytes, const std::function<Run()>& run) {
  const rlimit limit{most_bytes, most_bytes};
  setrlimit(RLIMIT_AS, &limit);
  Run result;
  try {
    result = run();
  } catch (const std::bad_alloc&) {
    result = {.end = Run::End::out_of_memory};
  } catch (const std::exception& error) {
    result = {.end = Run::End::failed, .fault = error.what()};
  }
  Message message{.end = result.end,
                  .milliseconds = result.milliseconds,
                  .worst_milliseconds = result.worst_milliseconds,
                  .tests = result.tests,
                  .pairs = result.pairs,
                  .events = result.events,
                  .hash = result.hash,
                  .peak_bytes = result.peak_bytes,
                  .fault = {}};
  result.fault.copy(message.fault.data(), message.fault.size() - 1);
  const bool written = write(pipe, &message, sizeof message) == sizeof message;
  // Not exit(): what the parent has not yet written out is the parent's to write.
  _exit(written ? 0 : 1);
}

}  // namespace

Run in_child(double seconds, std::uint64_t most_bytes, const std::function<Run()>& run) {
  const auto refuse = [](const char* what) { throw std::system_error(errno, std::generic_category(), what); };
  std::array<int, 2> ends;
  if (pipe2(ends.data(), O_CLOEXEC) != 0) refuse("worst: a pipe");
  const pid_t child = fork();
  if (child < 0) refuse("worst: a process");
  if (child == 0) answer(ends[1], most_bytes, run);
  close(ends[1]);
  pollfd waiting{ends[0], POLLIN, 0};
  const auto limit = static_cast<int>(std::min(seconds * 1e3 + 1, 1e9));
  int ready = 0;
  do {
    ready = poll(&waiting, 1, limit);
  } while (ready < 0 && errno == EINTR);
  Message message;
  const bool answered = ready > 0 && read(ends[0], &message, sizeof message) == sizeof message;
  if (!answered) kill(child, SIGKILL);
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (ready == 0) return {.end = Run::End::too_slow};
  if (!answered) return {.end = Run::End::failed, .fault = "ended without a result"};
  return {.end = message.end,
          .milliseconds = message.milliseconds,
          .worst_milliseconds = message.worst_milliseconds,
          .tests = message.tests,
          .pairs = message.pairs,
          .events = message.events,
          .hash = message.hash,
          .peak_bytes = message.peak_bytes,
          .fault = message.fault.data()};
}

}  // namespace broadside::bench
