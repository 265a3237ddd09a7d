// ThreadPool: an executor on threads of the standard library, for a library built without oneTBB.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "broadside/executor.hpp"

namespace broadside::core {

/// Threads that sleep until there is something to run. run() may be called from several threads and from
/// within tasks. The calling thread takes part, so run() needs no other thread to end. The threads
/// belong to the process that first calls run(). A forked child of that process does not have them: there,
/// the calling thread runs all tasks itself. A run() that is in progress in the forking thread does not end
/// in the child.
class ThreadPool final : public Executor {
 public:
  /// `threads` includes the calling thread, and is at least 1. The others start with the first run() that can
  /// use them. The pool does without threads that the system refuses.
  explicit ThreadPool(std::size_t threads);

  /// No run() may be in progress.
  ~ThreadPool() override;

  std::size_t threads() const noexcept override { return threads_; }
  void run(std::size_t count, const std::function<void(std::size_t)>& task) override;

 private:
  struct Job;

  /// Runs tasks of the job until all are taken.
  static void take_part(Job& job);

  /// Whether this process owns the threads; the first process that asks becomes their owner. A forked child
  /// of the owner must not lock the mutex: a thread of the parent may have held it, and then it stays locked.
  bool is_of_this_process() noexcept;

  void start_helpers();
  void help();

  std::size_t threads_;
  std::atomic<long> process_ = 0;  // this_process() of the owner of the threads; 0: no owner yet
  std::mutex mutex_;               // guards all below, and a job's helpers
  std::condition_variable wake_;
  std::condition_variable done_;
  std::vector<std::thread> helpers_;
  std::vector<Job*> jobs_;  // jobs that may have tasks left, the innermost last
  bool has_started_ = false;
  bool stops_ = false;
};

}  // namespace broadside::core
