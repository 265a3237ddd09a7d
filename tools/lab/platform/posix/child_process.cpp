// Child processes on POSIX.
#include "lab/platform/child_process.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include "lab/platform/descriptor.hpp"

namespace broadside::lab::platform {
namespace {

/// Both ends of a pipe; an end that was closed is -1.
struct Pipe {
  Pipe() {
    if (::pipe(ends.data()) != 0) ends = {-1, -1};
    for (const int end : ends) fcntl(end, F_SETFD, FD_CLOEXEC);
  }
  ~Pipe() {
    close_end(0);
    close_end(1);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  void close_end(std::size_t end) {
    if (ends[end] >= 0) close(ends[end]);
    ends[end] = -1;
  }

  /// Appends what can be read now. Closes the end at the end of the file.
  void read_into(std::string& text) {
    std::array<char, 65536> bytes;
    const std::int64_t count = read(ends[0], bytes.data(), bytes.size());
    if (count > 0)
      text.append(bytes.data(), static_cast<std::size_t>(count));
    else
      close_end(0);
  }

  std::array<int, 2> ends{};
};

/// A note in memory that child processes share.
struct SharedNote {
  SharedNote()
      : memory(mmap(nullptr, sizeof(ChildNote), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)),
        note(memory == MAP_FAILED ? nullptr : ::new (memory) ChildNote) {}
  ~SharedNote() {
    if (note != nullptr) munmap(memory, sizeof(ChildNote));
  }
  SharedNote(const SharedNote&) = delete;
  SharedNote& operator=(const SharedNote&) = delete;

  void* memory;
  ChildNote* note;
};

/// Kills the process unless it was waited for.
struct Child {
  explicit Child(pid_t process) : id(process) {}
  ~Child() {
    if (id <= 0) return;
    kill(id, SIGKILL);
    wait();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  int wait() {
    int status = 0;
    while (waitpid(id, &status, 0) < 0 && errno == EINTR) {
    }
    id = -1;
    return status;
  }

  pid_t id;
};

/// Ends the process if `work` throws: it must not unwind into the parent's code.
[[noreturn]] void be_child(pid_t parent, Pipe& results, Pipe& output, ChildNote& note,
                           const std::function<std::string(ChildNote&)>& work) noexcept {
  results.close_end(0);  // so that writing ends this process once the parent is gone
  output.close_end(0);
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) {
    if (std::signal(number, SIG_DFL) == SIG_IGN) std::signal(number, SIG_IGN);
  }
#ifdef __linux__
  prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
  if (getppid() != parent) _exit(1);
  dup2(output.ends[1], standard_output);
  dup2(output.ends[1], standard_error);
  const std::string result = work(note);
  std::fflush(nullptr);
  for (std::size_t done = 0; done < result.size();) {
    const std::int64_t count = write(results.ends[1], result.data() + done, result.size() - done);
    if (count <= 0) _exit(1);
    done += static_cast<std::size_t>(count);
  }
  // Not exit(): what is registered to run at exit belongs to the parent.
  _exit(0);
}

std::string how_ended(int status) {
  if (WIFSIGNALED(status))
    return "signal " + std::to_string(WTERMSIG(status)) + ", " + strsignal(WTERMSIG(status));
  return "exit status " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

void ChildNote::write(std::string_view text) {
  ++changes_;
  text_[text.copy(text_.data(), text_.size() - 1)] = '\0';
  ++changes_;
}

std::string ChildNote::text() const {
  const std::uint32_t before = changes_;
  std::string text = text_.data();
  return before % 2 == 0 && changes_ == before ? text : "";
}

std::optional<ChildEnd> run_in_child(const std::function<std::string(ChildNote&)>& work,
                                     const std::function<bool(const ChildNote&)>& goes_on) {
  using std::chrono::milliseconds, std::chrono::steady_clock;
  constexpr milliseconds tick(100);
  constexpr std::size_t max_output = 4096;
  const SharedNote shared;
  Pipe results;
  Pipe output;
  if (shared.note == nullptr || results.ends[0] < 0 || output.ends[0] < 0) return std::nullopt;
  std::fflush(nullptr);  // otherwise the child would write it as well
  const pid_t parent = getpid();
  Child child(fork());
  if (child.id < 0) return std::nullopt;
  if (child.id == 0) be_child(parent, results, output, *shared.note, work);
  results.close_end(1);
  output.close_end(1);
  ChildEnd end;
  std::string result;
  auto next = steady_clock::now() + tick;
  while (results.ends[0] >= 0 || output.ends[0] >= 0) {
    std::array<pollfd, 2> waiting{pollfd{results.ends[0], POLLIN, 0}, pollfd{output.ends[0], POLLIN, 0}};
    const bool any = poll(waiting.data(), waiting.size(), static_cast<int>(tick.count())) > 0;
    if (any && waiting[0].revents != 0) results.read_into(result);
    if (any && waiting[1].revents != 0) {
      output.read_into(end.output);
      if (end.output.size() > max_output) end.output.erase(0, end.output.size() - max_output);
    }
    if (steady_clock::now() < next) continue;
    next = steady_clock::now() + tick;
    if (!goes_on(*shared.note)) kill(child.id, SIGKILL);
  }
  const int status = child.wait();
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0 && !result.empty()) end.result = std::move(result);
  end.how = how_ended(status);
  end.last_step = shared.note->text();
  return end;
}

double processor_seconds() {
  double seconds = 0;
  for (const int whose : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage used{};
    getrusage(whose, &used);
    for (const timeval& time : {used.ru_utime, used.ru_stime})
      seconds += static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) / 1e6;
  }
  return seconds;
}

}  // namespace broadside::lab::platform
