// What searches run on: threads, how many of them and whose (Executor is how an engine hands in its own), and
// the processor's instruction set.
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

/// Runs tasks on threads. An engine derives from it to have searches run by its own job system.
///
/// One executor may serve several finders, one after the other or, if its run() may be called from several
/// threads, at the same time.
class BROADSIDE_PUBLIC Executor {
 public:
  virtual ~Executor() = default;

  /// How many tasks it runs at the same time, at least 1: what `threads=0` in a spec stands for.
  virtual std::size_t threads() const noexcept = 0;

  /// Calls task(i) exactly once for each i < count, and returns when all these calls have returned.
  ///
  /// Called by the thread that called find(), several times in a search. Calls of `task` may be in any
  /// thread, in any order, one after another, at the same time or nested in each other; none waits for
  /// another one. It is faster if this thread takes part, since only there pairs can be delivered while
  /// others search. The library's tasks throw nothing: what goes wrong in one is thrown by find(), the first
  /// such in the order of the search. run() may throw anything, before its tasks or after some of them, but
  /// not while a task is running: find() lets it through and can be called again. An update of a World that
  /// throws it can be tried again; one that is only about to give memory back keeps the memory instead.
  virtual void run(std::size_t count, const std::function<void(std::size_t)>& task) = 0;

 protected:
  Executor() = default;
  Executor(const Executor&) = default;
  Executor& operator=(const Executor&) = default;
};

/// The executor used where none was handed in: that of oneTBB, in the arena of the calling thread; in a
/// library built without it, a pool of threads that starts with the first search that uses several and lasts
/// as long as the process. A null pointer if the library was built without threads; searches then run in the
/// calling thread, whatever `threads` is, and find the same pairs in the same order. Thread-safe.
BROADSIDE_PUBLIC Executor* standard_executor() noexcept;

/// Who does the work of a search.
struct Workers {
  /// The most threads a search uses, the calling one among them; 0: as many as the executor has. In a spec:
  /// `threads`.
  std::size_t threads = 1;

  /// Whose threads; null: the standard executor's. Must live as long as what uses it.
  Executor* executor = nullptr;

  /// Every thread must have at least this many boxes to look at, or fewer threads are used: waking one takes
  /// some microseconds.
  std::size_t boxes_per_thread = 4096;

  /// Called during a search by the thread that called find() or update(): after every few million pairs of
  /// boxes compared (see Checkpoint), and while that thread waits for other threads. It is not called while
  /// a structure is sorted or built, nor if the executor runs no task on the calling thread. An exception
  /// from it ends the search and leaves find() or update(). Without a checkpoint, a search by one thread is
  /// never interrupted.
  std::function<void()> checkpoint{};
};

/// One thread and no checkpoint.
inline const Workers default_workers{};

/// For algorithms: counts the pairs of boxes compared across loops and functions, and calls a checkpoint once
/// every few million. Each thread needs its own.
class BROADSIDE_PUBLIC Checkpoint {
 public:
  /// The maximum number of pairs compared between two calls, plus the comparisons of a few boxes with all
  /// others.
  static constexpr std::uint64_t max_tests = std::uint64_t{1} << 22;

  /// `call` may be empty, and must outlive the Checkpoint.
  explicit Checkpoint(const std::function<void()>& call) noexcept : call_(&call) {}

  /// Adds `tests` to the number of pairs compared. Throws what the checkpoint throws.
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
BROADSIDE_PUBLIC std::string instruction_set();

namespace detail {
BROADSIDE_PUBLIC std::span<const std::string> instruction_sets();
}  // namespace detail

/// Those that the library was compiled for and this processor has, the best first; the last one is plain C++.
/// Not changed by limit_instruction_set(). Thread-safe.
BROADSIDE_HIDDEN BROADSIDE_CALLERS_VECTOR inline std::vector<std::string> instruction_sets() {
  const std::span<const std::string> names = detail::instruction_sets();
  return {names.begin(), names.end()};
}

/// Has every search of this process use the instruction set `name`, one of instruction_sets(), or the best
/// one again if `name` is empty. For measurements and tests. Not to be called while another thread searches
/// or calls one of these three. Throws InvalidSpec, and changes nothing, if there is none of that name.
BROADSIDE_PUBLIC void limit_instruction_set(std::string_view name);

}  // namespace broadside
