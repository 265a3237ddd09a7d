// Measures the speedup of several threads: the same work by one thread and by several, in turns. As many
// single-threaded copies at once show how much the machine can give. All runs must find the same pairs.
//
// The speedup with 8 and 16 cores is also computed: one thread does all the work, and the time in parallel
// tasks is divided by the number of cores.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "broadside/broadside.hpp"

#include "lab/measure/benchmark.hpp"
#include "lab/measure/samples.hpp"
#include "lab/numbers.hpp"
#include "lab/report/aligned_columns.hpp"

namespace broadside::bench {

/// Runs all tasks in the calling thread, reports sixteen workers, and measures the time in tasks.
class Accountant final : public Executor {
 public:
  std::size_t threads() const noexcept override { return 16; }
  void run(std::size_t count, const std::function<void(std::size_t)>& task) override {
    const lab::Stopwatch watch;
    for (std::size_t i = 0; i < count; ++i) task(i);
    shared_ms_ += watch.milliseconds();
  }

  /// Time in tasks since the last call.
  double take_shared_ms() { return std::exchange(shared_ms_, 0); }

 private:
  double shared_ms_ = 0;
};

/// Repeatable work.
class Work {
 public:
  virtual ~Work() = default;

  /// Prepares a round. Not timed.
  virtual void prepare(std::size_t round) = 0;

  virtual void run() = 0;

  /// Hash of the results of the last run().
  virtual std::uint64_t hash() const = 0;
};

inline std::uint64_t hash_of(std::span<const Pair> pairs) {
  PairHasher hasher;
  hasher.put(pairs);
  hasher.flush();
  return hasher.hash();
}

inline double milliseconds_of(const std::function<void()>& run) {
  const lab::Stopwatch watch;
  run();
  return watch.milliseconds();
}

/// Adds a row. `make(workers)` creates the same work for these workers.
inline void add_gain(const std::string& name,
                     const std::function<std::unique_ptr<Work>(const Workers&)>& make, std::size_t threads,
                     std::size_t rounds, lab::AlignedColumns& columns) {
  Accountant accountant;
  const auto one = make({});
  const auto several = make({.threads = threads});
  const auto accounted = make({.threads = 16, .executor = &accountant});
  std::vector<std::unique_ptr<Work>> copies;
  std::vector<Work*> all = {one.get(), several.get(), accounted.get()};
  for (std::size_t copy = 0; copy < threads; ++copy) {
    copies.push_back(make({}));
    all.push_back(copies.back().get());
  }
  accountant.take_shared_ms();  // a tracker's first frame
  std::vector<double> ones;
  std::vector<double> gains;
  std::vector<double> copies_gain;
  std::vector<double> shared;
  for (std::size_t round = 0; round < rounds; ++round) {
    for (Work* const work : all) work->prepare(round);
    const double one_ms = milliseconds_of([&] { one->run(); });
    const double several_ms = milliseconds_of([&] { several->run(); });
    const double copies_ms = milliseconds_of([&] {
      std::vector<std::future<void>> others;
      for (std::size_t copy = 1; copy < threads; ++copy)
        others.push_back(std::async(std::launch::async, [&work = *copies[copy]] { work.run(); }));
      copies[0]->run();
      for (std::future<void>& other : others) other.get();
    });
    const double accounted_ms = milliseconds_of([&] { accounted->run(); });
    for (const Work* const work : all) {
      if (work->hash() != one->hash())
        throw std::runtime_error(
            fmt::format("{}: found other pairs than one thread; expected the same", name));
    }
    if (round == 0) continue;  // the first round allocates memory
    ones.push_back(one_ms);
    gains.push_back(one_ms / several_ms);
    copies_gain.push_back(static_cast<double>(threads) * one_ms / copies_ms);
    shared.push_back(accountant.take_shared_ms() / accounted_ms);
  }
  const double gain = lab::median(gains);
  const double max_gain = lab::median(copies_gain);
  const double part = lab::median(shared);
  const auto with = [part](double cores) { return fmt::format("{:.1f}", 1 / (1 - part + part / cores)); };
  columns.add({name, lab::rounded(lab::median(ones)), fmt::format("{:.2f}", gain),
               fmt::format("{:.2f}", max_gain), fmt::format("{:.2f}", gain / max_gain),
               fmt::format("{:.0f} %", part * 100), with(8), with(16)});
}

inline lab::AlignedColumns gain_columns(std::size_t threads) {
  lab::AlignedColumns columns("<>>>>>>>");
  columns.add({"", "one thread, ms", fmt::format("{} threads", threads), fmt::format("{} copies", threads),
               "of these", "shared", "8", "16"});
  return columns;
}

inline std::string text_of_gains(const lab::AlignedColumns& columns) {
  return columns.text("  ") + "(how many times as fast as one thread; 8 and 16 by the part that is shared)\n";
}

}  // namespace broadside::bench
