// Parallel: shares a search's work among threads. Pairs and their order do not depend on the thread count.
#include "core/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/filter_sink.hpp"
#include "core/float_environment.hpp"

namespace broadside {

void Checkpoint::pass() {
  tests_ = 0;
  if (!*call_) return;
  const core::CallersEnvironment environment;
  (*call_)();
}

}  // namespace broadside

namespace broadside::core {
namespace {

/// Thrown when there is no room for a piece's pairs.
struct NoRoom {};

/// Thrown by a worker's checkpoint after another worker has thrown.
struct OtherWorkerThrew {};

/// The time between two checkpoints of the waiting caller's thread.
constexpr std::chrono::milliseconds between_checkpoints{20};

/// Collects a piece's pairs.
class PieceSink final : public PairSink {
 public:
  explicit PieceSink(PairBlocks& blocks) : blocks_(&blocks) {}

  PairList take() {
    flush();
    return std::move(pairs_);
  }

  void clear() noexcept {
    discard();
    pairs_.clear();
  }

 private:
  void consume(std::span<const Pair> pairs) override {
    if (!pairs_.append(pairs, *blocks_)) throw NoRoom();
  }

  PairBlocks* blocks_;
  PairList pairs_;
};

/// The filters between an algorithm and its caller's sink, the algorithm's end first. Flushes them, because
/// the pairs of an earlier search come before those of this one.
std::vector<const FilterSink*> filters_before(PairSink& pairs) {
  std::vector<const FilterSink*> filters;
  for (FilterSink* filter = FilterSink::of(pairs); filter != nullptr;
       filter = FilterSink::of(filter->target())) {
    filter->flush();
    filters.push_back(filter);
  }
  return filters;
}

/// A worker's copies of the given filters, onto a target of its own.
class FilterChain {
 public:
  FilterChain(const std::vector<const FilterSink*>& filters, PairSink& target) : front_(&target) {
    for (auto filter = filters.rbegin(); filter != filters.rend(); ++filter) {
      chain_.push_back((*filter)->onto(*front_));
      front_ = chain_.back().get();
    }
  }

  PairSink& front() { return *front_; }

  /// Flushes the filters into the target, which is not flushed itself.
  void flush() {
    for (auto filter = chain_.rbegin(); filter != chain_.rend(); ++filter) (*filter)->flush();
  }

 private:
  std::vector<std::unique_ptr<FilterSink>> chain_;  // the target's end first
  PairSink* front_;
};

/// The range of parts in piece `number` when `parts` parts are cut into `pieces` pieces.
Range piece_of(std::size_t parts, std::size_t pieces, std::size_t number) noexcept {
  const auto begin = [&](std::size_t i) { return parts / pieces * i + std::min(i, parts % pieces); };
  return {begin(number), begin(number + 1)};
}

}  // namespace

/// Keeps one exception of concurrent tasks: the first in the tasks' order.
class Parallel::Errors {
 public:
  /// Call it in a handler: notes the exception being handled.
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

/// Makes the caller's thread wait for the workers on other threads, and call its checkpoint meanwhile. It
/// does not wait for workers on its own thread, because an executor may run one within another.
class Parallel::Waiting {
 public:
  void begin() {
    const std::lock_guard lock(mutex_);
    ++others_;
  }
  void end() {
    const std::lock_guard lock(mutex_);
    if (--others_ == 0) none_left_.notify_all();
  }

  void wait(const Parallel& parallel, Errors& errors) {
    std::unique_lock lock(mutex_);
    while (!none_left_.wait_for(lock, between_checkpoints, [this] { return others_ == 0; })) {
      lock.unlock();
      try {
        if (!errors.any()) parallel.pass_checkpoint();
      } catch (...) {
        errors.note(std::numeric_limits<std::size_t>::max() - 1);
      }
      lock.lock();
    }
  }

 private:
  std::mutex mutex_;
  std::condition_variable none_left_;
  std::size_t others_ = 0;
};

/// A search cut into pieces of consecutive parts. One worker searches each piece.
class Parallel::SharedSearch {
 public:
  SharedSearch(Parallel& parallel, std::size_t parts, PairSink& pairs, const Search& search)
      : parallel_(parallel),
        search_(search),
        parts_(parts),
        pieces_(parallel.pieces_of(parts)),
        filters_(filters_before(pairs)),
        target_(filters_.empty() ? pairs : filters_.back()->target()),
        done_(parallel.workers_) {}

  Statistics run() {
    if (std::unique_ptr<PairSink> clone = target_.empty_clone())
      fill_clones(std::move(clone));
    else
      deliver();
    Statistics all;
    for (const Statistics& of_worker : done_) add(all, of_worker);
    return all;
  }

 private:
  Statistics search_piece(std::size_t piece, std::size_t worker, FilterChain& chain) {
    if (std::this_thread::get_id() == caller_) parallel_.pass_checkpoint();
    const Statistics statistics = search_(piece_of(parts_, pieces_, piece), worker, chain.front());
    chain.flush();
    return statistics;
  }

  void fill_clones(std::unique_ptr<PairSink> first) {
    std::vector<std::unique_ptr<PairSink>> clones;
    clones.push_back(std::move(first));
    while (clones.size() < parallel_.workers_) clones.push_back(target_.empty_clone());
    std::atomic<std::size_t> next = 0;
    parallel_.run_workers(errors_, [&](std::size_t worker) {
      std::size_t piece = 0;
      try {
        FilterChain chain(filters_, *clones[worker]);
        while (!errors_.any() && (piece = next.fetch_add(1, std::memory_order_relaxed)) < pieces_)
          add(done_[worker], search_piece(piece, worker, chain));
        clones[worker]->flush();
      } catch (const OtherWorkerThrew&) {
      } catch (...) {
        errors_.note(piece);
      }
    });
    errors_.rethrow();
    for (const std::unique_ptr<PairSink>& clone : clones) target_.merge(*clone);
  }

  void deliver() {
    Delivery delivery(parallel_.blocks_, pieces_, target_);
    while (!delivery.is_complete()) {
      const std::size_t delivered = delivery.delivered();
      delivery.begin_round();
      parallel_.run_workers(errors_, [&](std::size_t worker) { search_pieces(delivery, worker, false); });
      errors_.rethrow();
      while (delivery.deliver_next()) {
      }
      if (delivery.delivered() > delivered) continue;
      delivery.begin_round();
      search_pieces(delivery, 0, true);
      errors_.rethrow();
    }
  }

  /// Searches pieces, or only one, until the delivery hands out no other, room runs out or something throws.
  void search_pieces(Delivery& delivery, std::size_t worker, bool only_one) noexcept {
    std::size_t at = 0;
    try {
      PieceSink buffer(parallel_.blocks_);
      FilterChain buffered(filters_, buffer);
      FilterChain direct(filters_, target_);
      do {
        if (delivery.is_callers_thread()) {
          do {
            at = delivery.delivered();
          } while (delivery.deliver_next());
        }
        const std::optional<Delivery::Piece> piece = delivery.take();
        if (!piece) return;
        at = piece->number;
        try {
          const Statistics more = search_piece(at, worker, piece->is_direct ? direct : buffered);
          delivery.end(*piece, buffer.take());
          add(done_[worker], more);
        } catch (const NoRoom&) {
          buffer.clear();
          delivery.give_up(*piece);
          return;
        }
      } while (!only_one && !errors_.any());
    } catch (const OtherWorkerThrew&) {
    } catch (...) {
      errors_.note(at);
    }
  }

  Parallel& parallel_;
  const Search& search_;
  std::size_t parts_;
  std::size_t pieces_;
  std::vector<const FilterSink*> filters_;
  PairSink& target_;
  std::vector<Statistics> done_;  // by worker
  std::thread::id caller_ = std::this_thread::get_id();
  Errors errors_;
};

Parallel::Parallel() = default;
Parallel::~Parallel() = default;

void Parallel::start(const Workers& workers, std::size_t boxes) {
  workers_ = 1;
  boxes_ = boxes;
  checkpoint_ = workers.checkpoint;
  caller_ = std::this_thread::get_id();
  choose_workers(workers);
  checkpoints_.clear();
  if (checkpoint_) checkpoints_.resize(workers_, {Checkpoint(workers_checkpoint_)});
}

void Parallel::choose_workers(const Workers& workers) {
  if (workers.threads == 1) return;
  const CallersEnvironment environment;
  executor_ = workers.executor != nullptr ? workers.executor : standard_executor();
  if (executor_ == nullptr) return;
  const std::size_t threads = workers.threads == 0 ? executor_->threads() : workers.threads;
  const std::size_t worth = boxes_ / std::max<std::size_t>(workers.boxes_per_thread, 1);
  workers_ = std::clamp<std::size_t>(worth, 1, std::max<std::size_t>(threads, 1));
}

Range Parallel::range(std::size_t number, std::size_t count) const noexcept {
  return piece_of(count, range_count(), number);
}

void Parallel::share_ranges(std::size_t count, const RangeBody& body) {
  std::atomic<std::size_t> next = 0;
  Errors errors;
  run_workers(errors, [&](std::size_t worker) {
    while (!errors.any()) {
      const std::size_t number = next.fetch_add(1, std::memory_order_relaxed);
      if (number >= range_count()) return;
      try {
        body(number, range(number, count), worker);
      } catch (const OtherWorkerThrew&) {
      } catch (...) {
        errors.note(number);
      }
    }
  });
  errors.rethrow();
}

Statistics Parallel::share_search(std::size_t parts, PairSink& pairs, const Search& search) {
  return SharedSearch(*this, parts, pairs, search).run();
}

Statistics Parallel::search_by_pieces(std::size_t parts, PairSink& pairs, const Search& search) {
  Statistics all;
  const std::size_t pieces = pieces_of(parts);
  for (std::size_t piece = 0; piece < pieces; ++piece) {
    pass_checkpoint();
    add(all, search(piece_of(parts, pieces, piece), 0, pairs));
  }
  return all;
}

std::size_t Parallel::pieces_of(std::size_t parts) const noexcept {
  const std::size_t for_workers = workers_ == 1 ? 1 : pieces_per_worker * workers_;
  const std::size_t for_checkpoints = checkpoint_ ? boxes_ / boxes_between_checkpoints : 0;
  return std::min(parts, std::max(for_workers, for_checkpoints));
}

void Parallel::pass_checkpoint() const {
  if (!checkpoint_) return;
  const CallersEnvironment callers;
  checkpoint_();
}

void Parallel::pass_workers_checkpoint() const {
  if (std::this_thread::get_id() == caller_)
    pass_checkpoint();
  else if (errors_->any())
    throw OtherWorkerThrew();
}

void Parallel::run_workers(Errors& errors, const std::function<void(std::size_t)>& body) {
  errors_ = &errors;
  Waiting others;
  // An executor synchronizes its tasks with this thread by means that a thread sanitizer may not see. It
  // does see these two.
  std::atomic<bool> begun = false;
  std::atomic<std::size_t> ended = 0;
  begun.store(true, std::memory_order_release);
  // oneTBB's threads have the environment of its first caller, and so does this thread within a task.
  const FloatControl control = CallersEnvironment::control();
  const CallersEnvironment callers;
  try {
    executor_->run(workers_, [&](std::size_t worker) {
      const DefaultEnvironment environment(control);
      static_cast<void>(begun.load(std::memory_order_acquire));
      const bool is_other = checkpoint_ && std::this_thread::get_id() != caller_;
      if (is_other) others.begin();
      body(worker);
      if (is_other)
        others.end();
      else if (checkpoint_)
        others.wait(*this, errors);
      ended.fetch_add(1, std::memory_order_release);
    });
  } catch (...) {
    static_cast<void>(ended.load(std::memory_order_acquire));
    throw;
  }
  if (const std::size_t count = ended.load(std::memory_order_acquire); count != workers_)
    throw std::logic_error("the executor returned after " + std::to_string(count) + " of " +
                           std::to_string(workers_) + " tasks; expected all of them");
}

}  // namespace broadside::core
