// Parallel: work shared among workers gives what one worker gives.
#include "core/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <functional>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/sinks.hpp"

#include "core/filter_sink.hpp"
#include "tests/support/executors.hpp"
#include "tests/support/message.hpp"

namespace broadside::core {
namespace {

using laws::with;

/// A thread for each task but the first, which stays in the calling thread.
class Team final : public Executor {
 public:
  std::size_t threads() const noexcept override { return 3; }

  void run(std::size_t count, const std::function<void(std::size_t)>& task) override {
    ++runs;
    std::vector<std::jthread> threads;
    for (std::size_t i = 1; i < count; ++i) threads.emplace_back([&task, i] { task(i); });
    task(0);
  }

  int runs = 0;
};

/// Leaves the last task out.
class Sloth final : public Executor {
 public:
  std::size_t threads() const noexcept override { return 2; }
  void run(std::size_t count, const std::function<void(std::size_t)>& task) override {
    for (std::size_t i = 0; i + 1 < count; ++i) task(i);
  }
};

TEST(Parallel, HasALaneForEachThreadThatIsWorthIt) {
  Team team;
  Parallel parallel;
  const auto workers = [&](std::size_t threads, std::size_t boxes) {
    parallel.start({.threads = threads, .executor = &team, .boxes_per_thread = 100}, boxes);
    return parallel.workers();
  };
  EXPECT_EQ(workers(1, 1'000'000), 1u);
  EXPECT_EQ(workers(4, 1'000'000), 4u);
  EXPECT_EQ(workers(0, 1'000'000), team.threads());
  EXPECT_EQ(workers(4, 399), 3u);
  EXPECT_EQ(workers(4, 199), 1u);
  EXPECT_EQ(workers(4, 0), 1u);
}

TEST(Parallel, CoversARangeOnce) {
  Team team;
  Parallel parallel;
  for (const std::size_t threads : {1, 2, 5}) {
    parallel.start(with(team, threads), 1000);
    for (const std::size_t count : {0, 1, 3, 17, 1000}) {
      std::vector<std::atomic<int>> visits(count);
      parallel.for_ranges(count, [&](Range range, std::size_t worker) {
        EXPECT_LT(worker, parallel.workers());
        for (std::size_t i = range.begin; i < range.end; ++i) ++visits[i];
      });
      for (const std::atomic<int>& visit : visits) EXPECT_EQ(visit, 1);
    }
  }
}

TEST(Parallel, GivesARangeTheSameNumberEachTime) {
  Team team;
  Parallel parallel;
  parallel.start(with(team, 3), 1000);
  std::vector<Range> ranges(parallel.range_count());
  parallel.for_numbered_ranges(777,
                               [&](std::size_t number, Range range, std::size_t) { ranges[number] = range; });
  std::size_t end = 0;
  for (std::size_t number = 0; number < ranges.size(); ++number) {
    EXPECT_EQ(ranges[number].begin, end);
    EXPECT_EQ(parallel.range(number, 777).begin, ranges[number].begin);
    EXPECT_EQ(parallel.range(number, 777).end, ranges[number].end);
    end = ranges[number].end;
  }
  EXPECT_EQ(end, 777u);
}

TEST(Parallel, ThrowsWhatTheFirstRangeThrew) {
  Team team;
  Parallel parallel;
  parallel.start(with(team, 4), 1000);
  const auto fail = [&] {
    parallel.for_numbered_ranges(100, [](std::size_t number, Range, std::size_t) {
      if (number >= 2) throw std::runtime_error("range " + std::to_string(number));
    });
  };
  for (int round = 0; round < 20; ++round) EXPECT_EQ(message_of<std::runtime_error>(fail), "range 2");
}

/// Part p has the pairs (p, p + 1), (p, p + 2) ... as many as p modulo 100.
Statistics search_parts(Range parts, std::size_t, PairSink& sink) {
  Statistics done;
  for (std::size_t part = parts.begin; part < parts.end; ++part) {
    for (std::size_t other = 1; other <= part % 100; ++other) sink.add(BoxId(part), BoxId(part + other));
    done.tests += 2;
    done.references += part;
  }
  return done;
}

std::vector<Pair> pairs_of_parts(std::size_t parts) {
  std::vector<Pair> pairs;
  PairCollector collector(pairs);
  search_parts({0, parts}, 0, collector);
  collector.flush();
  return pairs;
}

TEST(Parallel, DeliversPairsPartByPart) {
  Team team;
  Parallel parallel;
  for (const std::size_t threads : {1, 2, 7}) {
    parallel.start(with(team, threads), 1000);
    for (const std::size_t parts : {0, 1, 5, 10'000}) {
      std::vector<Pair> pairs;
      PairCollector collector(pairs);
      const Statistics done = parallel.search(parts, collector, search_parts);
      collector.flush();
      EXPECT_EQ(pairs, pairs_of_parts(parts));
      EXPECT_EQ(done.tests, 2 * parts);
      EXPECT_EQ(done.references, parts == 0 ? 0 : parts * (parts - 1) / 2);
    }
  }
}

/// Lets pairs through whose second is even.
class EvenSink final : public FilterSink {
 public:
  explicit EvenSink(PairSink& target) : FilterSink(target) {}

  std::unique_ptr<FilterSink> onto(PairSink& target) const override {
    return std::make_unique<EvenSink>(target);
  }

 private:
  void consume(std::span<const Pair> pairs) override {
    for (const Pair pair : pairs) {
      if (index(pair.second) % 2 == 0) target().add(pair.first, pair.second);
    }
  }
};

TEST(Parallel, FiltersInEachLane) {
  Team team;
  Parallel parallel;
  std::vector<Pair> expected = pairs_of_parts(5000);
  std::erase_if(expected, [](Pair pair) { return index(pair.second) % 2 != 0; });
  for (const std::size_t threads : {1, 2, 7}) {
    parallel.start(with(team, threads), 1000);
    std::vector<Pair> pairs;
    PairCollector collector(pairs);
    EvenSink even(collector);
    EvenSink twice(even);
    parallel.search(5000, twice, search_parts);
    twice.flush();
    even.flush();
    collector.flush();
    EXPECT_EQ(pairs, expected);

    PairCounter counter;
    EvenSink counted(counter);
    parallel.search(5000, counted, search_parts);
    counted.flush();
    counter.flush();
    EXPECT_EQ(counter.count(), expected.size());
  }
}

/// Counts how many of its kind there are at once.
class ClonedSink final : public PairSink {
 public:
  explicit ClonedSink(std::atomic<int>& clones) : clones_(&clones) {}

  std::unique_ptr<PairSink> empty_clone() const override {
    ++*clones_;
    return std::make_unique<ClonedSink>(*clones_);
  }
  void merge(PairSink& clone) override { count_ += static_cast<ClonedSink&>(clone).count_; }

  std::size_t count() const { return count_; }

 private:
  void consume(std::span<const Pair> pairs) override { count_ += pairs.size(); }

  std::atomic<int>* clones_;
  std::size_t count_ = 0;
};

TEST(Parallel, ClonesASinkThatCanBeOnceALane) {
  Team team;
  Parallel parallel;
  std::atomic<int> clones = 0;
  ClonedSink sink(clones);
  parallel.start(with(team, 3), 1000);
  parallel.search(1000, sink, search_parts);
  EXPECT_EQ(clones, 3);
  EXPECT_EQ(sink.count(), pairs_of_parts(1000).size());
}

TEST(Parallel, TellsOfASinkThatHasClonesAndNoMerge) {
  class Half final : public PairSink {
   public:
    std::unique_ptr<PairSink> empty_clone() const override { return std::make_unique<Half>(); }

   private:
    void consume(std::span<const Pair>) override {}
  };
  Team team;
  Parallel parallel;
  parallel.start(with(team, 2), 1000);
  Half sink;
  EXPECT_THROW(parallel.search(1000, sink, search_parts), std::logic_error);
}

TEST(Parallel, TellsOfAnExecutorThatLeavesATaskOut) {
  Sloth sloth;
  Parallel parallel;
  parallel.start(with(sloth, 3), 1000);
  EXPECT_EQ(message_of<std::logic_error>([&] { parallel.for_ranges(10, [](Range, std::size_t) {}); }),
            "the executor returned after 2 of 3 tasks; expected all of them");
}

TEST(Parallel, ThrowsWhatASearchThrowsAndCanBeUsedAfter) {
  Team team;
  Parallel parallel;
  parallel.start(with(team, 3), 1000);
  const auto fail = [&] {
    PairCounter counter;
    std::vector<Pair> pairs;
    PairCollector collector(pairs);
    const auto search = [](Range parts, std::size_t, PairSink&) -> Statistics {
      if (parts.end > 500) throw std::runtime_error("part 500");
      return {};
    };
    EXPECT_THROW(parallel.search(1000, counter, search), std::runtime_error);
    parallel.search(1000, collector, search);
  };
  EXPECT_EQ(message_of<std::runtime_error>(fail), "part 500");
  std::vector<Pair> pairs;
  PairCollector collector(pairs);
  parallel.search(1000, collector, search_parts);
  collector.flush();
  EXPECT_EQ(pairs, pairs_of_parts(1000));
}

TEST(Parallel, KeepsABoundedNumberOfPairs) {
  // No task runs in this thread, so nothing can be delivered while others run; they must stop and start
  // again.
  class Elsewhere final : public Executor {
   public:
    std::size_t threads() const noexcept override { return 2; }
    void run(std::size_t count, const std::function<void(std::size_t)>& task) override {
      ++runs;
      std::jthread([&] {
        for (std::size_t i = 0; i < count; ++i) task(i);
      });
    }
    int runs = 0;
  };
  Elsewhere elsewhere;
  Parallel parallel;
  parallel.start(with(elsewhere, 2), 1000);
  std::uint64_t pairs = 0;
  PairFunction count([&pairs](std::span<const Pair> chunk) { pairs += chunk.size(); });
  constexpr std::size_t pairs_per_part = std::size_t{1} << 20;  // 8 MiB
  parallel.search(24, count, [](Range parts, std::size_t, PairSink& sink) {
    for (std::size_t i = 0; i < (parts.end - parts.begin) * pairs_per_part / 512; ++i) {
      Pair* const out = sink.room(512);
      std::fill_n(out, 512, Pair{BoxId{0}, BoxId{1}});
      sink.commit(512);
    }
    return Statistics{};
  });
  count.flush();
  EXPECT_EQ(pairs, 24 * pairs_per_part);
  EXPECT_GT(elsewhere.runs, 1);
}

}  // namespace
}  // namespace broadside::core
