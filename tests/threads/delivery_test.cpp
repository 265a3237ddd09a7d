// Pairs on their way from several lanes to one sink: their order, the room for them, and lanes that leave.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <thread>

#include <gtest/gtest.h>

#include "broadside/sinks.hpp"

#include "core/parallel.hpp"
#include "tests/support/executors.hpp"

namespace broadside::core {
namespace {

using laws::with;

constexpr std::uint32_t mebibyte_of_pairs = (1U << 20) / sizeof(Pair);

/// Runs one task after the other: the first, which is the last in turn, in the calling thread, all others in
/// threads of their own.
class OneByOne final : public Executor {
 public:
  std::size_t threads() const noexcept override { return 2; }
  void run(std::size_t count, const std::function<void(std::size_t)>& task) override {
    ++runs;
    for (std::size_t i = count; i > 1; --i) std::jthread([&task, i] { task(i - 1); });
    task(0);
  }
  int runs = 0;
};

/// So many pairs are written at once. The first of them is numbered: a thread sanitizer takes long over each
/// write.
constexpr std::uint32_t at_once = 512;

/// Writes a number of MiB for each part, of which those numbered are (part, part + 1), (part, part + 2) ...
template <typename Size>
auto search_of(const Size& mebibytes_of) {
  return [mebibytes_of](Range parts, std::size_t, PairSink& sink) {
    static const std::array<Pair, at_once> not_numbered{};
    Statistics done;
    for (std::size_t part = parts.begin; part < parts.end; ++part) {
      const auto first = static_cast<std::uint32_t>(part);
      for (std::uint32_t i = 0; i < mebibytes_of(part) * mebibyte_of_pairs / at_once; ++i) {
        Pair* const out = sink.room(at_once);
        std::memcpy(out, not_numbered.data(), sizeof not_numbered);
        *out = {BoxId{first}, BoxId{first + 1 + i}};
        sink.commit(at_once);
      }
      done.tests += 1;
      done.references += part;
    }
    return done;
  };
}

/// Keeps nothing, and checks that pairs of search_of() come in order.
class InOrder final : public PairSink {
 public:
  std::size_t count = 0;
  std::size_t out_of_order = 0;

 private:
  void consume(std::span<const Pair> pairs) override {
    for (std::size_t i = 0; i < pairs.size(); i += at_once) {
      const Pair pair = pairs[i];
      const bool is_next = pair.first == last_.first && index(pair.second) == index(last_.second) + 1;
      const bool begins_part = pair.first > last_.first && index(pair.second) == index(pair.first) + 1;
      out_of_order += static_cast<std::size_t>(count > 0 && !is_next && !begins_part);
      last_ = pair;
      count += std::min<std::size_t>(at_once, pairs.size() - i);
    }
  }

  Pair last_{};
};

/// Searches parts of these sizes.
template <typename Size>
void expect_in_order(Executor& executor, std::size_t threads, std::size_t parts, const Size& mebibytes_of) {
  Parallel parallel;
  parallel.start(with(executor, threads), 1000);
  std::size_t expected = 0;
  for (std::size_t part = 0; part < parts; ++part) expected += mebibytes_of(part) * mebibyte_of_pairs;
  InOrder sink;
  const Statistics done = parallel.search(parts, sink, search_of(mebibytes_of));
  sink.flush();
  EXPECT_EQ(sink.count, expected);
  EXPECT_EQ(sink.out_of_order, 0u);
  EXPECT_EQ(done.tests, parts);
  EXPECT_EQ(done.references, parts * (parts - 1) / 2);
}

TEST(Delivery, SearchesPiecesAgainThatOutgrowTheRoom) {
  laws::ThreadExecutor threads;
  laws::TeamExecutor team;
  OneByOne one_by_one;
  for (const std::size_t large : {0, 3}) {
    const auto mebibytes_of = [large](std::size_t part) { return part == large ? 65U : 9U; };
    expect_in_order(threads, 3, 6, mebibytes_of);
    expect_in_order(team, 3, 6, mebibytes_of);
    expect_in_order(one_by_one, 2, 6, mebibytes_of);
  }
}

TEST(Delivery, LetsLanesComeBackOnceThereIsRoom) {
  OneByOne executor;
  Parallel parallel;
  parallel.start(with(executor, 2), 1000);
  InOrder sink;
  std::size_t parts_elsewhere = 0;
  const auto search = search_of([](std::size_t) { return 2; });
  parallel.search(64, sink, [&](Range parts, std::size_t lane, PairSink& to) {
    parts_elsewhere += lane == 1 ? parts.end - parts.begin : 0;
    return search(parts, lane, to);
  });
  EXPECT_GT(executor.runs, 2);
  EXPECT_GT(parts_elsewhere, 32u);
}

TEST(Delivery, CanBeUsedAfterASinkThrewInAPieceThatWasSearchedAgain) {
  struct Full {};
  laws::ThreadExecutor executor;
  Parallel parallel;
  parallel.start(with(executor, 2), 1000);
  const auto search = search_of([](std::size_t) { return 65; });
  PairFunction full([chunks = 0](std::span<const Pair>) mutable {
    if (++chunks == 9000) throw Full();  // of 8320 a part
  });
  EXPECT_THROW(parallel.search(3, full, search), Full);
  InOrder sink;
  parallel.search(3, sink, search);
  sink.flush();
  EXPECT_EQ(sink.count, std::size_t{3} * 65 * mebibyte_of_pairs);
  EXPECT_EQ(sink.out_of_order, 0u);
}

}  // namespace
}  // namespace broadside::core
