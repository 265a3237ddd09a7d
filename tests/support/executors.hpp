// Executors with the behaviours of various engines, for tests.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>
#include <thread>
#include <vector>

#include "broadside/executor.hpp"

namespace broadside::laws {

/// Runs tasks one after another in the calling thread, in reverse order.
class ReverseExecutor final : public Executor {
 public:
  std::size_t threads() const noexcept override { return 3; }

  void run(std::size_t count, const std::function<void(std::size_t)>& task) override {
    ++runs;
    for (std::size_t i = count; i > 0; --i) task(i - 1);
  }

  std::size_t runs = 0;
};

/// Runs each task in a thread of its own, all concurrently, and none in the calling thread.
class ThreadExecutor final : public Executor {
 public:
  std::size_t threads() const noexcept override { return 4; }

  void run(std::size_t count, const std::function<void(std::size_t)>& task) override {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < count; ++i) threads.emplace_back([&task, i] { task(i); });
  }
};

/// Runs the first task in the calling thread, and the others concurrently in threads of their own.
class TeamExecutor final : public Executor {
 public:
  std::size_t threads() const noexcept override { return 2; }

  void run(std::size_t count, const std::function<void(std::size_t)>& task) override {
    std::vector<std::jthread> threads;
    for (std::size_t i = 1; i < count; ++i) threads.emplace_back([&task, i] { task(i); });
    if (count > 0) task(0);
  }
};

struct ExecutorIsClosed final : std::runtime_error {
  ExecutorIsClosed() : std::runtime_error("the executor is closed") {}
};

/// Runs nothing.
class ClosedExecutor final : public Executor {
 public:
  std::size_t threads() const noexcept override { return 2; }
  void run(std::size_t, const std::function<void(std::size_t)>&) override { throw ExecutorIsClosed(); }
};

/// An exception that is not a std::exception.
struct NotAnException {};

/// Runs tasks one after another in the calling thread; one of its runs throws, before its tasks or after half
/// of them.
class FailingExecutor final : public Executor {
 public:
  std::size_t threads() const noexcept override { return 3; }

  void run(std::size_t count, const std::function<void(std::size_t)>& task) override {
    const bool fails = runs++ == failing_run;
    if (fails) count = is_half_way ? count / 2 : 0;
    for (std::size_t i = 0; i < count; ++i) task(i);
    if (fails) throw NotAnException();
  }

  std::size_t runs = 0;
  std::size_t failing_run = std::numeric_limits<std::size_t>::max();  // counted from 0
  bool is_half_way = false;
};

/// Starts tasks in another order in each run, some in the calling thread and some in threads of their own.
class ShufflingExecutor final : public Executor {
 public:
  std::size_t threads() const noexcept override { return 4; }

  void run(std::size_t count, const std::function<void(std::size_t)>& task) override {
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::shuffle(order, random_);
    std::vector<std::jthread> threads;
    for (const std::size_t i : order) {
      if (random_() % 3 == 0)
        task(i);
      else
        threads.emplace_back([&task, i] { task(i); });
    }
  }

 private:
  std::minstd_rand random_;
};

/// Runs tasks one after another in the calling thread, and runs more of them when idle() is called inside a
/// task, as a thread of a job system picks up other work while it waits.
class NestingExecutor final : public Executor {
 public:
  std::size_t threads() const noexcept override { return 3; }

  void run(std::size_t count, const std::function<void(std::size_t)>& task) override {
    Job job{&task, count, job_};
    job_ = &job;
    while (job.left > 0) run_one(job);
    job_ = job.outer;
  }

  /// Runs one task of each run() that is active in this thread.
  void idle() {
    for (Job* job = job_; job != nullptr; job = job->outer) {
      if (job->left > 0) run_one(*job);
    }
  }

 private:
  struct Job {
    const std::function<void(std::size_t)>* task;
    std::size_t left;
    Job* outer;
  };

  static void run_one(Job& job) {
    const std::size_t i = --job.left;
    (*job.task)(i);
  }

  Job* job_ = nullptr;
};

/// `threads` workers of this executor; even a single box is shared out.
inline Workers with(Executor& executor, std::size_t threads) {
  return {.threads = threads, .executor = &executor, .boxes_per_thread = 1};
}

}  // namespace broadside::laws
