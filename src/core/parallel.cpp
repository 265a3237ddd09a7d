// Parallel: a search's work shared among threads, so that neither the pairs nor their order show how many.
#include "core/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "core/filter_sink.hpp"
#include "core/float_environment.hpp"

namespace broadside::core {
namespace {

/// No new task is begun while so many pairs wait for one before them: 64 MiB.
constexpr std::size_t most_waiting = std::size_t{1} << 23;

/// Collects a task's pairs.
class BufferSink final : public PairSink {
 public:
  std::vector<Pair>* buffer = nullptr;

 private:
  void consume(std::span<const Pair> pairs) override {
    buffer->insert(buffer->end(), pairs.begin(), pairs.end());
  }
};

/// The filters between an algorithm and its caller's sink, the algorithm's end first. What they hold of an
/// earlier search is handed on: its pairs come before those of this one.
std::vector<const FilterSink*> filters_before(PairSink& pairs) {
  std::vector<const FilterSink*> filters;
  for (auto* filter = dynamic_cast<FilterSink*>(&pairs); filter != nullptr;
       filter = dynamic_cast<FilterSink*>(&filter->target())) {
    filter->flush();
    filters.push_back(filter);
  }
  return filters;
}

/// Filters of a lane's own, like those given, onto a target of its own.
class FilterChain {
 public:
  FilterChain(const std::vector<const FilterSink*>& filters, PairSink& target) : front_(&target) {
    for (auto filter = filters.rbegin(); filter != filters.rend(); ++filter) {
      chain_.push_back((*filter)->onto(*front_));
      front_ = chain_.back().get();
    }
  }

  PairSink& front() { return *front_; }

  /// Hands on what the filters hold, up to the target and not beyond.
  void flush() {
    for (auto filter = chain_.rbegin(); filter != chain_.rend(); ++filter) (*filter)->flush();
  }

 private:
  std::vector<std::unique_ptr<FilterSink>> chain_;  // the target's end first
  PairSink* front_;
};

}  // namespace

Tunable threads_tunable() {
  return {.name = "threads",
          .summary = "most threads of a search; 0: as many as there are",
          .standard = "1",
          .type = Tunable::Type::integer,
          .least = 0,
          .most = 1024};
}

/// What went wrong in tasks that run at the same time: the first in their order is kept.
class Parallel::Errors {
 public:
  /// In a handler, for the exception handled.
  void note(std::size_t task) noexcept {
    const std::lock_guard lock(mutex_);
    if (task < task_) {
      task_ = task;
      error_ = std::current_exception();
    }
    any_.store(true, std::memory_order_relaxed);
  }

  bool any() const noexcept { return any_.load(std::memory_order_relaxed); }

  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  std::mutex mutex_;
  std::size_t task_ = std::numeric_limits<std::size_t>::max();
  std::exception_ptr error_;
  std::atomic<bool> any_ = false;
};

/// Tasks are taken in order and end in any; their pairs go to the sink in order, in the caller's thread. That
/// thread writes straight to the sink where nothing waits before its task.
class Parallel::Delivery {
 public:
  Delivery(Parallel& parallel, std::size_t tasks, PairSink& target)
      : parallel_(&parallel), target_(&target), results_(tasks) {}

  ~Delivery() {
    for (Result& result : results_) {
      if (result.pairs) parallel_->buffers_.push_back(std::move(result.pairs));
    }
  }

  Delivery(const Delivery&) = delete;
  Delivery& operator=(const Delivery&) = delete;

  struct Task {
    std::size_t number;
    std::vector<Pair>* buffer;  // null: write to the target
  };

  bool is_callers_thread() const { return std::this_thread::get_id() == caller_; }

  bool is_complete() const { return delivered_ == results_.size(); }

  /// The next task; none if there is no other, or if too many pairs wait.
  std::optional<Task> take() {
    const std::lock_guard lock(mutex_);
    if (taken_ == results_.size() || waiting_ > most_waiting) return std::nullopt;
    const std::size_t number = taken_++;
    if (number == delivered_ && is_callers_thread() && !delivering_) {
      delivering_ = true;  // by this very task
      return Task{number, nullptr};
    }
    std::unique_ptr<std::vector<Pair>>& pairs = results_[number].pairs;
    if (parallel_->buffers_.empty()) {
      pairs = std::make_unique<std::vector<Pair>>();
    } else {
      pairs = std::move(parallel_->buffers_.back());
      parallel_->buffers_.pop_back();
      pairs->clear();
    }
    return Task{number, pairs.get()};
  }

  /// Says that a task has ended.
  void end(const Task& task) {
    const std::lock_guard lock(mutex_);
    results_[task.number].ended = true;
    if (task.buffer != nullptr) {
      waiting_ += task.buffer->size();
    } else {
      delivering_ = false;
      ++delivered_;
    }
  }

  /// Delivers what can be. In the caller's thread alone; where the sink itself came here, what it called goes
  /// on when it returns.
  void deliver() {
    std::unique_lock lock(mutex_);
    if (delivering_) return;
    delivering_ = true;
    while (delivered_ < results_.size() && results_[delivered_].ended) {
      const std::vector<Pair>& pairs = *results_[delivered_].pairs;
      lock.unlock();
      target_->put(pairs);
      lock.lock();
      waiting_ -= pairs.size();
      parallel_->buffers_.push_back(std::move(results_[delivered_].pairs));
      ++delivered_;
    }
    delivering_ = false;
  }

 private:
  struct Result {
    std::unique_ptr<std::vector<Pair>> pairs;
    bool ended = false;
  };

  Parallel* parallel_;
  PairSink* target_;
  std::thread::id caller_ = std::this_thread::get_id();
  std::mutex mutex_;  // for all that follows, and the buffers
  std::vector<Result> results_;
  std::size_t taken_ = 0;
  std::size_t delivered_ = 0;
  std::size_t waiting_ = 0;  // pairs in the results
  bool delivering_ = false;
};

Parallel::Parallel() = default;
Parallel::~Parallel() = default;

void Parallel::start(const Workers& workers, std::size_t boxes) {
  lanes_ = 1;
  if (workers.threads == 1) return;
  const CallersEnvironment environment;
  executor_ = workers.executor != nullptr ? workers.executor : standard_executor();
  if (executor_ == nullptr) return;
  const std::size_t threads = workers.threads == 0 ? executor_->threads() : workers.threads;
  const std::size_t worth = boxes / std::max<std::size_t>(workers.boxes_per_thread, 1);
  lanes_ = std::clamp<std::size_t>(worth, 1, std::max<std::size_t>(threads, 1));
}

Range Parallel::range(std::size_t number, std::size_t count) const noexcept {
  const std::size_t ranges = range_count();
  const auto at = [&](std::size_t i) { return count / ranges * i + std::min(i, count % ranges); };
  return {at(number), at(number + 1)};
}

void Parallel::share_ranges(std::size_t count, const RangeBody& body) {
  std::atomic<std::size_t> next = 0;
  Errors errors;
  run_lanes([&](std::size_t lane) {
    while (!errors.any()) {
      const std::size_t number = next.fetch_add(1, std::memory_order_relaxed);
      if (number >= range_count()) return;
      try {
        body(number, range(number, count), lane);
      } catch (...) {
        errors.note(number);
      }
    }
  });
  errors.rethrow();
}

Statistics Parallel::share_search(std::size_t parts, PairSink& pairs, const Search& search) {
  const std::vector<const FilterSink*> filters = filters_before(pairs);
  PairSink& target = filters.empty() ? pairs : filters.back()->target();
  const std::size_t tasks = std::min(parts, tasks_per_lane * lanes_);
  const auto parts_of = [&](std::size_t task) {
    const auto at = [&](std::size_t i) { return parts / tasks * i + std::min(i, parts % tasks); };
    return Range{at(task), at(task + 1)};
  };
  std::vector<Statistics> done(lanes_);
  Errors errors;
  const auto add = [&done](std::size_t lane, const Statistics& more) {
    done[lane].tests += more.tests;
    done[lane].references += more.references;
  };

  std::vector<std::unique_ptr<PairSink>> clones;
  if (std::unique_ptr<PairSink> clone = target.empty_clone()) {
    clones.push_back(std::move(clone));
    while (clones.size() < lanes_) clones.push_back(target.empty_clone());
  }
  if (!clones.empty()) {
    std::atomic<std::size_t> next = 0;
    run_lanes([&](std::size_t lane) {
      std::size_t task = 0;
      try {
        FilterChain chain(filters, *clones[lane]);
        while (!errors.any() && (task = next.fetch_add(1, std::memory_order_relaxed)) < tasks)
          add(lane, search(parts_of(task), lane, chain.front()));
        chain.flush();
        clones[lane]->flush();
      } catch (...) {
        errors.note(task);
      }
    });
    errors.rethrow();
    for (const std::unique_ptr<PairSink>& clone : clones) target.merge(*clone);
  } else {
    Delivery delivery(*this, tasks, target);
    while (!delivery.is_complete()) {
      run_lanes([&](std::size_t lane) {
        std::optional<Delivery::Task> task;
        try {
          BufferSink buffer;
          FilterChain buffered(filters, buffer);
          FilterChain direct(filters, target);
          while (!errors.any() && (task = delivery.take())) {
            buffer.buffer = task->buffer;
            FilterChain& chain = task->buffer != nullptr ? buffered : direct;
            add(lane, search(parts_of(task->number), lane, chain.front()));
            chain.flush();
            if (task->buffer != nullptr) buffer.flush();
            delivery.end(*task);
            if (delivery.is_callers_thread()) delivery.deliver();
          }
        } catch (...) {
          errors.note(task ? task->number : 0);
        }
      });
      errors.rethrow();
      delivery.deliver();
    }
  }

  Statistics all;
  for (const Statistics& of_lane : done) {
    all.tests += of_lane.tests;
    all.references += of_lane.references;
  }
  return all;
}

void Parallel::run_lanes(const std::function<void(std::size_t)>& body) {
  // An executor brings the tasks' writes to this thread by means of its own, which need not be of a kind that
  // a thread sanitizer sees. These two are.
  std::atomic<bool> begun = false;
  std::atomic<std::size_t> ended = 0;
  begun.store(true, std::memory_order_release);
  // oneTBB's threads have the environment in which it was called first, and in a task this one has as well.
  const FloatControl control = CallersEnvironment::control();
  const CallersEnvironment callers;
  executor_->run(lanes_, [&](std::size_t lane) {
    const DefaultEnvironment environment(control);
    static_cast<void>(begun.load(std::memory_order_acquire));
    body(lane);
    ended.fetch_add(1, std::memory_order_release);
  });
  if (const std::size_t count = ended.load(std::memory_order_acquire); count != lanes_)
    throw std::logic_error("the executor returned after " + std::to_string(count) + " of " +
                           std::to_string(lanes_) + " tasks; expected all of them");
}

}  // namespace broadside::core
