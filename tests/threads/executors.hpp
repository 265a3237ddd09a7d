// Executors as engines may have them, for tests.
#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <thread>
#include <vector>

#include "broadside/executor.hpp"

namespace broadside::laws {

/// Runs tasks one after the other in the calling thread, the last one first.
class ReverseExecutor final : public Executor {
 public:
  std::size_t threads() const noexcept override { return 3; }

  void run(std::size_t count, const std::function<void(std::size_t)>& task) override {
    ++runs;
    for (std::size_t i = count; i > 0; --i) task(i - 1);
  }

  std::size_t runs = 0;
};

/// Runs each task in a thread of its own, all at the same time, and none in the calling one.
class ThreadExecutor final : public Executor {
 public:
  std::size_t threads() const noexcept override { return 4; }

  void run(std::size_t count, const std::function<void(std::size_t)>& task) override {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < count; ++i) threads.emplace_back([&task, i] { task(i); });
  }
};

/// Runs the first task in the calling thread, and the others in threads of their own meanwhile.
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

}  // namespace broadside::laws
