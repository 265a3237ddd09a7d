// The pool of threads: every task once, from wherever it is called, and searches on it.
#include "core/thread_pool.hpp"

#include <atomic>
#include <chrono>
#include <cstddef>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#if defined(__unix__)
#include <sys/wait.h>
#include <unistd.h>
#endif

#include <gtest/gtest.h>

#include "broadside/finder.hpp"

#include "law_case.hpp"
#include "searches.hpp"

namespace broadside::laws {
namespace {

using core::ThreadPool;

/// How often run(count) called each task.
std::vector<int> calls_of(ThreadPool& pool, std::size_t count) {
  std::vector<std::atomic<int>> calls(count);
  pool.run(count, [&](std::size_t i) { ++calls[i]; });
  return {calls.begin(), calls.end()};
}

TEST(ThreadPool, CallsEachTaskOnceForAnyNumberOfThreads) {
  for (const std::size_t threads : {1, 2, 5}) {
    ThreadPool pool(threads);
    EXPECT_EQ(pool.threads(), threads);
    for (const std::size_t count : {0, 1, 2, 3, 100, 1000})
      EXPECT_EQ(calls_of(pool, count), std::vector<int>(count, 1)) << threads << " threads";
  }
}

/// The number of threads that run two tasks. Each task waits for the other one to begin, at most 20 seconds.
std::size_t threads_of_two_tasks(ThreadPool& pool) {
  std::mutex mutex;
  std::set<std::thread::id> threads;
  pool.run(2, [&](std::size_t) {
    const auto latest = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    for (bool both = false; !both && std::chrono::steady_clock::now() < latest; std::this_thread::yield()) {
      const std::lock_guard lock(mutex);
      threads.insert(std::this_thread::get_id());
      both = threads.size() == 2;
    }
  });
  return threads.size();
}

TEST(ThreadPool, RunsTasksInOtherThreadsAtTheSameTime) {
  ThreadPool pool(2);
  EXPECT_EQ(threads_of_two_tasks(pool), 2u);
}

#if defined(__unix__) && !defined(__SANITIZE_THREAD__)
TEST(ThreadPool, StartsItsThreadsInTheProcessThatUsesItFirst) {
  ThreadPool pool(2);
  const pid_t child = fork();
  if (child == 0) _exit(threads_of_two_tasks(pool) == 2 ? 0 : 1);
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
}
#endif

TEST(ThreadPool, RunsTasksWithinTasksAndForSeveralCallersAtOnce) {
  ThreadPool pool(3);
  std::atomic<int> inner{0};
  const auto call = [&] {
    for (int i = 0; i < 50; ++i)
      pool.run(4, [&](std::size_t) { pool.run(5, [&](std::size_t) { ++inner; }); });
  };
  std::thread other(call);
  call();
  other.join();
  EXPECT_EQ(inner, 2 * 50 * 4 * 5);
}

class PoolLaw : public Law {};

TEST_P(PoolLaw, FindsThePairsOfOneThread) {
  in_dimension([&]<int D>() {
    ThreadPool pool(3);
    const std::vector<Box<D>> boxes = scattered_boxes<D>(3000, D == 2 ? 40 : 12);
    Finder<D> alone(algorithm(), spec());
    const std::vector<Pair> expected = found(alone, boxes);
    const auto search = [&] {
      Finder<D> finder(algorithm(), spec());
      finder.set_workers(workers(3, &pool));
      for (int i = 0; i < 5; ++i) EXPECT_EQ(found(finder, boxes), expected);
    };
    std::thread other(search);
    search();
    other.join();
  });
}

INSTANTIATE_TEST_SUITE_P(Own, PoolLaw, testing::ValuesIn(threaded_cases()), case_name);

}  // namespace
}  // namespace broadside::laws
