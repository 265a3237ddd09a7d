// The kernels of the sweep on every instruction set there is: the pairs of their definition, in its order,
// and its count of tests.
#include "kernels/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/box.hpp"
#include "broadside/error.hpp"
#include "broadside/executor.hpp"
#include "broadside/sinks.hpp"

#include "tests/support/message.hpp"
#include "tests/support/model.hpp"

namespace broadside::kernels {
namespace {

template <int D>
struct Entry {
  Box<D> box;
  Box<D, double> exact;  ///< what decides: the same, or doubles near it
  BoxId id;
  std::uint32_t dedup_mask;
};

template <int D>
using Entries = std::vector<Entry<D>>;

struct Result {
  std::vector<Pair> pairs;
  std::uint64_t tests = 0;

  friend bool operator==(const Result&, const Result&) = default;

  friend void PrintTo(const Result& result, std::ostream* out) {
    *out << testing::PrintToString(result.pairs) << ", by " << result.tests << " tests";
  }
};

/// Compares two entries as a kernel does. Whether `a` and `b` were a test is returned.
template <int D>
bool test(const Entry<D>& a, const Entry<D>& b, bool looks_at_mask, Result& result) {
  if (b.box.min[0] > a.box.max[0]) return false;
  if (overlap(a.exact, b.exact) && (!looks_at_mask || (a.dedup_mask & b.dedup_mask) == 0))
    result.pairs.push_back({std::min(a.id, b.id), std::max(a.id, b.id)});
  return true;
}

/// The same with the pairs in order: a run's sweep takes boxes in groups, in an order that the golden hashes
/// hold fast.
Result sorted(Result result) {
  std::ranges::sort(result.pairs);
  return result;
}

template <int D>
Result swept(const Entries<D>& run) {
  Result result;
  for (std::size_t i = 0; i < run.size(); ++i) {
    for (std::size_t j = i + 1; j < run.size(); ++j)
      result.tests += test(run[i], run[j], true, result) ? 1 : 0;
  }
  return result;
}

template <int D>
Result swept(const Entries<D>& a, const Entries<D>& b) {
  Result result;
  const auto test_from = [&](const Entry<D>& entry, const Entries<D>& others, std::size_t at) {
    for (; at < others.size(); ++at) result.tests += test(entry, others[at], true, result) ? 1 : 0;
  };
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (a[i].box.min[0] <= b[j].box.min[0])
      test_from(a[i++], b, j);
    else
      test_from(b[j++], a, i);
  }
  return result;
}

template <int D>
Result compared(const Entries<D>& run) {
  Result result;
  for (std::size_t i = 0; i < run.size(); ++i) {
    for (std::size_t j = i + 1; j < run.size(); ++j) test(run[i], run[j], false, result);
  }
  result.tests = run.size() * (run.size() - 1) / 2;
  return result;
}

template <int D>
Result compared(const Entries<D>& a, const Entries<D>& b) {
  Result result;
  for (const Entry<D>& one : a) {
    for (const Entry<D>& other : b) test(one, other, false, result);
  }
  result.tests = a.size() * b.size();
  return result;
}

/// What a kernel called by `search` finds.
template <typename Search>
Result found(Search search) {
  Result result;
  result.pairs = written_pairs([&](PairSink& pairs) { result.tests = search(pairs); });
  return result;
}

/// A run of `entries` in the memory of others before it, whose boxes then lie behind its end.
template <int D>
Run<D> fill(RunBuffer<D>& buffer, const Entries<D>& entries, const Box<D, double>* doubles, float slack = 0) {
  buffer.clear();
  buffer.reserve(entries.size());
  for (const Entry<D>& entry : entries) buffer.append(entry.box, entry.id, entry.dedup_mask);
  return buffer.view(doubles, nullptr, slack);
}

/// How boxes are drawn.
struct Kind {
  std::string name;
  int values;  ///< coordinates are whole numbers below this one: where they are few, many are equal
  int max_extent;
  bool infinite;             ///< some reach to infinity, on either side or both
  std::uint32_t dedup_mask;  ///< these bits of `dedup_mask` are set at random
  bool doubles = false;      ///< boxes that touch as floats may be apart
};

const std::vector<Kind> kinds = {
    {"sparse", 4000, 60, false, 0},
    {"ties", 12, 3, false, 0},
    {"points on one another", 2, 0, false, 0},
    {"infinite", 60, 10, true, 0},
    {"apart", 40, 20, false, 7U},
    {"two sets", 60, 30, false, 3U << 30},
    {"everything overlaps", 1, 0, true, 0},
    {"doubles", 40, 10, true, 7U, true},
    {"doubles that all touch", 2, 1, false, 0, true},
};

template <int D>
Entries<D> entries_of(const Kind& kind, std::size_t count, std::size_t first_id, Rng& rng) {
  Entries<D> entries(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (int axis = 0; axis < D; ++axis) {
      float& min = entries[i].box.min[axis];
      float& max = entries[i].box.max[axis];
      min = static_cast<float>(rng.whole(0, kind.values - 1));
      max = min + static_cast<float>(rng.whole(0, kind.max_extent));
      if (!kind.infinite || !rng.one_in(4)) continue;
      const int sides = rng.whole(0, 4);  // one of them: a box at an infinite point
      if (sides != 0) max = infinity;
      if (sides != 1) min = sides == 2 ? infinity : -infinity;
    }
    entries[i].exact = near_double(rng, entries[i].box);
    for (int axis = 0; axis < D && !kind.doubles; ++axis) {
      entries[i].exact.min[axis] = entries[i].box.min[axis];
      entries[i].exact.max[axis] = entries[i].box.max[axis];
    }
    entries[i].id = BoxId(first_id + i);
    entries[i].dedup_mask = static_cast<std::uint32_t>(rng.bits()) & kind.dedup_mask;
  }
  rng.shuffle(entries);  // ids must not rise with the places
  return entries;
}

/// The widths of buckets by which runs are sorted; 0: wholly sorted. The coarsest one comes first, since a
/// sort leaves in a bucket what order it finds.
constexpr float slacks[] = {20, 1.5F, 0};

/// Sorts as kernels::sweep() asks for: by min[0], or only by which multiple of `slack` it lies above.
template <int D>
void sort_run(Entries<D>& entries, float slack = 0) {
  std::ranges::stable_sort(entries, {}, [slack](const Entry<D>& entry) {
    const float min = entry.box.min[0];
    return slack == 0 || std::isinf(min) ? min : std::floor(min / slack);
  });
}

/// Runs `body(entries, others, doubles)` on every instruction set and sizes from 0 to 200. The doubles are
/// null where floats decide.
template <typename Body>
void on_all(Body body) {
  on_each_instruction_set([&]<int D>() {
    for (const Kind& kind : kinds) {
      SCOPED_TRACE(kind.name);
      Rng rng(17);
      for (std::size_t size = 200; size != std::size_t(-1); size -= size > 70 ? 13 : size > 36 ? 3 : 1) {
        const Entries<D> entries = entries_of<D>(kind, size, 0, rng);
        const Entries<D> others = entries_of<D>(kind, rng.below(200), size, rng);
        std::vector<Box<D, double>> doubles(entries.size() + others.size());
        for (const Entry<D>& entry : entries) doubles[index(entry.id)] = entry.exact;
        for (const Entry<D>& entry : others) doubles[index(entry.id)] = entry.exact;
        body(entries, others, kind.doubles ? doubles.data() : nullptr);
        if (testing::Test::HasFailure()) return;
      }
    }
  });
}

TEST(Kernels, AreThereForPlainCppAtLeast) {
  const std::vector<std::string> names = instruction_sets();
  ASSERT_FALSE(names.empty());
  for (const std::string& name : names) EXPECT_TRUE(is_instruction_set(name)) << name;
  EXPECT_EQ(instruction_set(), names.front());
  EXPECT_FALSE(is_instruction_set("Unknown"));
}

TEST(Kernels, NameInstructionSetsAsPeopleDo) {
  EXPECT_EQ(kernels::instruction_set_name("AVX3"), "AVX-512");
  EXPECT_EQ(kernels::instruction_set_name("AVX3_ZEN4"), "AVX-512-ZEN4");
  EXPECT_EQ(kernels::instruction_set_name("AVX2"), "AVX2");
  EXPECT_FALSE(is_instruction_set("AVX3"));
  for (const std::string& name : instruction_sets())
    EXPECT_THAT(name, testing::Not(testing::HasSubstr("AVX3")));
}

TEST(Kernels, RunOnTheInstructionSetThatTheyAreLimitedTo) {
  const std::vector<std::string> names = instruction_sets();
  for (const std::string& name : names) {
    limit_instruction_set(name);
    EXPECT_EQ(instruction_set(), name);
    EXPECT_EQ(instruction_sets(), names);
    EXPECT_THAT(message_of<InvalidSpec>([] { limit_instruction_set("AVX9"); }),
                testing::AllOf(testing::HasSubstr("'AVX9'"), testing::HasSubstr(names.front()),
                               testing::HasSubstr(names.back())));
    EXPECT_EQ(instruction_set(), name);
  }
  limit_instruction_set("");
  EXPECT_EQ(instruction_set(), names.front());
}

TEST(Kernels, SweepARunAsDefinedOnEveryInstructionSet) {
  on_all([]<int D>(Entries<D> run, const Entries<D>&, const Box<D, double>* doubles) {
    static RunBuffer<D> buffer;
    for (const float slack : slacks) {
      sort_run(run, slack);
      const Result result =
          found([&](PairSink& pairs) { return sweep(fill(buffer, run, doubles, slack), pairs); });
      EXPECT_EQ(sorted(result), sorted(swept(run))) << run.size() << " boxes, slack " << slack;
    }
  });
}

TEST(Kernels, SweepTwoRunsAsDefinedOnEveryInstructionSet) {
  on_all([]<int D>(Entries<D> a, Entries<D> b, const Box<D, double>* doubles) {
    static RunBuffer<D> first;
    static RunBuffer<D> second;
    for (const float slack : slacks) {
      sort_run(a, slack);
      sort_run(b);
      EXPECT_EQ(found([&](PairSink& pairs) {
                  return sweep(fill(first, a, doubles, slack), fill(second, b, doubles), pairs);
                }),
                swept(a, b))
          << a.size() << " and " << b.size() << " boxes, slack " << slack;
      EXPECT_EQ(found([&](PairSink& pairs) {
                  return sweep(fill(second, b, doubles), fill(first, a, doubles, slack), pairs);
                }),
                swept(b, a))
          << b.size() << " and " << a.size() << " boxes, slack " << slack;
    }
  });
}

TEST(Kernels, CompareAllOfARunOnEveryInstructionSet) {
  on_all([]<int D>(const Entries<D>& run, const Entries<D>&, const Box<D, double>* doubles) {
    static RunBuffer<D> buffer;
    EXPECT_EQ(found([&](PairSink& pairs) { return compare_all(fill(buffer, run, doubles), pairs); }),
              compared(run))
        << run.size();
  });
}

TEST(Kernels, CompareAllOfTwoRunsOnEveryInstructionSet) {
  on_all([]<int D>(const Entries<D>& a, const Entries<D>& b, const Box<D, double>* doubles) {
    static RunBuffer<D> first;
    static RunBuffer<D> second;
    EXPECT_EQ(found([&](PairSink& pairs) {
                return compare_all(fill(first, a, doubles), fill(second, b, doubles), pairs);
              }),
              compared(a, b))
        << a.size() << " and " << b.size();
  });
}

}  // namespace
}  // namespace broadside::kernels
