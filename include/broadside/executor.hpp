// Executor and Workers: thread settings, and how an engine provides its own threads. Also the processor's
// instruction set.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "broadside/export.hpp"

namespace broadside {

/// Runs tasks on threads. An engine derives from it to run searches on its own job system.
///
/// One executor may serve several finders: one after another, or at the same time if run() may be called from
/// several threads.
class BROADSIDE_PUBLIC Executor {
 public:
  virtual ~Executor() = default;

  /// The number of tasks that it runs at the same time, at least 1. `threads=0` in a spec means this number.
  [[nodiscard]] virtual std::size_t threads() const noexcept = 0;

  /// Calls task(i) exactly once for each i < count, and returns when all these calls have returned.
  ///
  /// The thread that called find() calls run(), several times per search. run() may call `task` in any thread
  /// and in any order, one call after another, at the same time or nested: no call waits for another. The
  /// search is faster if the calling thread takes part, because only it can deliver pairs while other threads
  /// search.
  ///
  /// The library's tasks do not throw: find() throws the exception of the first task, in order of the search,
  /// that failed. run() may throw anything before its tasks or between them, but not while a task is running.
  /// find() lets the exception through and can be called again. The same holds for a World's update, except
  /// while it releases memory: it then ignores the exception and keeps the memory.
  virtual void run(std::size_t count, const std::function<void(std::size_t)>& task) = 0;

 protected:
  Executor() = default;
  Executor(const Executor&) = default;
  Executor& operator=(const Executor&) = default;
};

/// The executor that is used by default. It uses oneTBB when available, in the arena of the calling thread.
/// Otherwise it is a pool of threads that starts with the first search on several threads and lasts until the
/// process ends. Null if the library was built without threads: every search then runs in the calling thread,
/// whatever `threads` is, and finds the same pairs in the same order. Thread-safe.
[[nodiscard]] BROADSIDE_PUBLIC Executor* standard_executor() noexcept;

/// Threading options of a search.
struct Workers {
  /// The maximum number of threads, including the calling one; 0 means as many as the executor has. In a
  /// spec: `threads`.
  std::size_t threads = 1;

  /// Executor to use; null selects standard_executor(). It must outlive the objects that use it.
  Executor* executor = nullptr;

  /// The minimum number of boxes per thread. Fewer boxes use fewer threads, because waking a thread takes
  /// some microseconds.
  std::size_t boxes_per_thread = 4096;

  /// Called during a search, in the thread that called find() or update(): after every few million
  /// comparisons of boxes (see Checkpoint), and while that thread waits for other threads. It is not called
  /// while a structure is sorted or built, nor if the executor runs no task in the calling thread. An
  /// exception from it ends the search and leaves find() or update(). Without a checkpoint, nothing
  /// interrupts a search by one thread.
  std::function<void()> checkpoint{};
};

/// One thread and no checkpoint.
inline const Workers default_workers{};

/// For algorithms: counts comparisons of boxes across loops and functions, and calls a checkpoint after every
/// few million. Each thread needs its own.
class BROADSIDE_PUBLIC Checkpoint {
 public:
  /// The maximum number of comparisons between two calls, plus those of a few boxes with all others.
  static constexpr std::uint64_t max_tests = std::uint64_t{1} << 22;

  /// `call` may be empty, and must outlive the Checkpoint.
  explicit Checkpoint(const std::function<void()>& call) noexcept : call_(&call) {}

  /// Counts `tests` comparisons. Exceptions from the checkpoint pass through.
  void count(std::uint64_t tests) {
    tests_ += tests;
    if (tests_ >= max_tests) pass();
  }

 private:
  void pass();

  const std::function<void()>* call_;
  std::uint64_t tests_ = 0;
};

/// The name of the instruction set that searches use on this processor, such as "AVX-512", "AVX2", "SSE4" or
/// "NEON". Pairs and their order do not depend on it. Thread-safe.
[[nodiscard]] BROADSIDE_PUBLIC std::string instruction_set();

namespace detail {
BROADSIDE_PUBLIC std::span<const std::string> instruction_sets();
}  // namespace detail

/// The instruction sets that the library was compiled for and this processor has, best first; the last one is
/// plain C++. limit_instruction_set() does not change them. Thread-safe.
[[nodiscard]] BROADSIDE_HIDDEN BROADSIDE_CALLERS_VECTOR inline std::vector<std::string> instruction_sets() {
  const std::span<const std::string> names = detail::instruction_sets();
  return {names.begin(), names.end()};
}

/// Makes every search of this process use the instruction set `name`, one of instruction_sets(), or the best
/// one again if `name` is empty. For measurements and tests. Do not call it while another thread searches or
/// calls one of these three functions. Throws InvalidSpec, and changes nothing, if the name is unknown.
BROADSIDE_PUBLIC void limit_instruction_set(std::string_view name);

}  // namespace broadside
