// Threads: whose they are, how many of them a search may use, and Executor, by which an engine hands in its
// own.
#pragma once

#include <cstddef>
#include <functional>

#include "broadside/cpp_version.hpp"

namespace broadside {

/// Runs tasks on threads. An engine derives from it to have searches run by its own job system.
///
/// One executor may serve several finders, one after the other or, if its run() may be called from several
/// threads, at the same time.
class Executor {
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

/// The executor used where none was handed in: that of oneTBB, in the arena of the calling thread. A null
/// pointer if the library was built without it; searches then run in the calling thread, whatever `threads`
/// is, and find the same pairs in the same order. Thread-safe.
Executor* standard_executor() noexcept;

/// Who does the work of a search.
struct Workers {
  /// The most threads a search uses, the calling one among them; 0: as many as the executor has. In a spec:
  /// `threads`.
  std::size_t threads = 1;

  /// Whose threads; null: the standard executor's. Must live as long as what uses it.
  Executor* executor = nullptr;

  /// Every thread must have so many boxes to look at, or fewer threads are used: waking one takes some
  /// microseconds.
  std::size_t boxes_per_thread = 4096;
};

}  // namespace broadside
