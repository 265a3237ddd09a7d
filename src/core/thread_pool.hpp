// An executor on threads of the standard library, for a library built without oneTBB.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "broadside/executor.hpp"

namespace broadside::core {

/// Threads that sleep until there is something to run. run() may be called from several threads and from
/// within tasks: whoever calls it takes part, so that it needs no other thread to end. In a forked child of
/// the process that made the pool, where the threads are gone, the caller does all by itself; but a run()
/// that is under way in the forking thread does not end there.
class ThreadPool final : public Executor {
 public:
  /// `threads` counts the calling thread, and is at least 1. The others start with the first run() that can
  /// use them; those that the system refuses are done without.
  explicit ThreadPool(std::size_t threads);

  /// No run() may be under way.
  ~ThreadPool() override;

  std::size_t threads() const noexcept override { return threads_; }
  void run(std::size_t count, const std::function<void(std::size_t)>& task) override;

 private:
  struct Job;

  /// Does tasks of the job until all are taken.
  static void take_part(Job& job);

  void start_helpers();
  void help();

  std::size_t threads_;
  long process_;      // that made it
  std::mutex mutex_;  // guards all below, and a job's helpers
  std::condition_variable wake_;
  std::condition_variable done_;
  std::vector<std::thread> helpers_;
  std::vector<Job*> jobs_;  // with tasks that may not be taken yet, the innermost last
  bool has_started_ = false;
  bool stops_ = false;
};

}  // namespace broadside::core
