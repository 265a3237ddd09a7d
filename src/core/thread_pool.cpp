// ThreadPool: runs tasks on threads of the standard library.
#include "core/thread_pool.hpp"

#include <atomic>
#include <system_error>

#ifndef _WIN32
#include <unistd.h>
#endif

namespace broadside::core {
namespace {

/// A number that differs in a forked child.
long this_process() noexcept {
#ifdef _WIN32
  return 1;
#else
  return getpid();
#endif
}

}  // namespace

struct ThreadPool::Job {
  const std::function<void(std::size_t)>& task;
  std::size_t count;
  std::atomic<std::size_t> next{0};
  std::size_t helpers = 0;  // threads that take part, besides the caller's
};

ThreadPool::ThreadPool(std::size_t threads) : threads_(threads) {}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard lock(mutex_);
    stops_ = true;
  }
  wake_.notify_all();
  for (std::thread& helper : helpers_) helper.join();
}

void ThreadPool::run(std::size_t count, const std::function<void(std::size_t)>& task) {
  Job job{task, count};
  if (count < 2 || threads_ < 2 || !is_of_this_process()) return take_part(job);
  {
    const std::lock_guard lock(mutex_);
    start_helpers();
    jobs_.push_back(&job);
  }
  if (count > 2)
    wake_.notify_all();
  else
    wake_.notify_one();
  take_part(job);
  std::unique_lock lock(mutex_);
  std::erase(jobs_, &job);
  done_.wait(lock, [&] { return job.helpers == 0; });
}

bool ThreadPool::is_of_this_process() noexcept {
  long none = 0;
  return process_.compare_exchange_strong(none, this_process()) || none == this_process();
}

void ThreadPool::take_part(Job& job) {
  for (std::size_t i; (i = job.next.fetch_add(1, std::memory_order_relaxed)) < job.count;) job.task(i);
}

void ThreadPool::start_helpers() {
  if (has_started_) return;
  helpers_.reserve(threads_ - 1);
  has_started_ = true;
  try {
    while (helpers_.size() + 1 < threads_) helpers_.emplace_back([this] { help(); });
  } catch (const std::system_error&) {
    // Goes on with the threads that have started.
  }
}

void ThreadPool::help() {
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [&] { return stops_ || !jobs_.empty(); });
    if (stops_) return;
    Job& job = *jobs_.back();
    ++job.helpers;
    lock.unlock();
    take_part(job);
    lock.lock();
    std::erase(jobs_, &job);
    if (--job.helpers == 0) done_.notify_all();
  }
}

}  // namespace broadside::core
