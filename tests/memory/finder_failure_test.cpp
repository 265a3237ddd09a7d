// Finders that run out of memory: the search throws std::bad_alloc, and the next one finds all pairs again.
#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"

#include "injection.hpp"
#include "memory_case.hpp"
#include "tests/support/executors.hpp"

namespace broadside::laws {
namespace {

/// Boxes to be searched, all of them or one part against the other, and their pairs.
template <int D, typename Real>
struct Search {
  Search(std::size_t count, bool is_between, Rng& rng)
      : boxes(lattice_boxes<D, Real>(count, rng)),
        left_count(is_between && count > 1 ? 1 + rng.below(count - 1) : 0) {
    for (std::size_t i = 0; i < count; ++i) {
      if (!is_present(boxes[i])) continue;
      for (std::size_t j = std::max(i + 1, left_count); j < count; ++j) {
        if (left_count > 0 && i >= left_count) break;
        if (is_present(boxes[j]) && overlap(boxes[i], boxes[j]))
          pairs.push_back({BoxId(i), BoxId(j - left_count)});
      }
    }
  }

  void run(Finder<D, Real>& finder, PairSink& sink) const {
    if (left_count == 0)
      finder.find(boxes, sink);
    else
      finder.find_across(boxes, left_count, sink);
  }

  std::vector<Box<D, Real>> boxes;
  std::size_t left_count;
  std::vector<Pair> pairs;
};

/// What is wrong with what the finder finds; empty if nothing is.
template <int D, typename Real>
std::string fault(Finder<D, Real>& finder, const Search<D, Real>& search) {
  std::vector<Pair> found;
  PairCollector collector(found);
  search.run(finder, collector);
  std::ranges::sort(found);
  if (found == search.pairs) return "";
  return std::to_string(found.size()) + " pairs of " + std::to_string(search.boxes.size()) +
         " boxes are not the " + std::to_string(search.pairs.size()) + " expected";
}

/// Searches `searches` one after the other, each again where it has failed. What is wrong; empty if nothing
/// is.
template <int D, typename Real>
std::string play(const MemoryCase& memory_case, const Spec& spec, const Workers& workers,
                 const std::vector<Search<D, Real>>& searches, Injector& injector) {
  std::optional<Finder<D, Real>> made;
  while (!injector.attempt([&] { made.emplace(*memory_case.algorithm, spec); })) {
  }
  Finder<D, Real>& finder = *made;
  finder.set_workers(workers);
  for (const Search<D, Real>& search : searches) {
    std::vector<Pair> found;
    PairCollector collector(found);
    PairCounter counter;
    const bool counts = search.boxes.size() % 2 != 0;
    const bool is_done =
        injector.attempt([&] { counts ? search.run(finder, counter) : search.run(finder, collector); });
    std::ranges::sort(found);
    if (is_done && (counts ? counter.count() != search.pairs.size() : found != search.pairs))
      return "a search that did not throw has not found all pairs";
    if (!is_done) {
      const std::string text = fault(finder, search);
      if (!text.empty()) return "after a search that failed, " + text;
    }
  }
  return "";
}

class FinderFailure : public MemoryTest {
 protected:
  /// Plays each of some histories with each allocation failing, and many with some failing at random.
  template <int D, typename Real>
  void check(const std::vector<Spec>& specs, const std::vector<Workers>& all_workers) const {
    std::uint64_t failures = 0;
    Rng rng(1);
    for (const Spec& spec : specs) {
      for (const Workers& workers : all_workers) {
        const bool is_alone = workers.threads == 1;
        const std::int64_t blocks = blocks_held();
        std::string text;
        const auto run = [&](const std::vector<Search<D, Real>>& searches, Injector injector) {
          text = play<D, Real>(GetParam(), spec, workers, searches, injector);
          failures += injector.failures();
          return injector.failures() > 0;
        };
        {
          const std::vector<Search<D, Real>> few = {{6, false, rng}, {41, false, rng}, {70, true, rng}};
          for (const FailureKind kind : {FailureKind::once, FailureKind::from_then_on}) {
            for (std::uint64_t k = 0; text.empty() && run(few, {k, kind}); k = next_number(k, !is_alone)) {
            }
            ASSERT_EQ(text, "") << spec.text();
          }
          for (std::uint64_t seed = 0; seed < random_histories(); ++seed) {
            std::vector<Search<D, Real>> searches;
            for (std::size_t i = 2 + rng.below(5); i > 0; --i) {
              constexpr std::array<std::size_t, 5> most = {3, 30, 200, 1000, 3000};
              const std::size_t count = rng.below(rng.one_of<std::size_t>(most));
              searches.emplace_back(count, rng.one_in(3), rng);
            }
            run(searches, Injector(seed));
            ASSERT_EQ(text, "") << spec.text() << ", seed " << seed;
          }
        }
        if (is_alone) {
          ASSERT_EQ(blocks_held(), blocks) << spec.text() << " leaks";
        }
      }
    }
    RecordProperty("failures", std::to_string(failures));
  }
};

TEST_P(FinderFailure, LosesNothingButItsSearch) {
  in_case([&]<int D, typename Real>() { check<D, Real>(specs_of(GetParam()), {Workers{}}); });
}

class ThreadedFinderFailure : public FinderFailure {};

TEST_P(ThreadedFinderFailure, LosesNothingInAnyThread) {
  TeamExecutor team;
  ReverseExecutor reverse;
  in_case([&]<int D, typename Real>() {
    check<D, Real>(threaded_specs_of(GetParam()),
                   {{.threads = 3, .executor = nullptr, .boxes_per_thread = 4},
                    {.threads = 3, .executor = &team, .boxes_per_thread = 4},
                    {.threads = 5, .executor = &reverse, .boxes_per_thread = 1}});
  });
}

INSTANTIATE_TEST_SUITE_P(Library, FinderFailure, testing::ValuesIn(memory_cases()), case_name);
INSTANTIATE_TEST_SUITE_P(Library, ThreadedFinderFailure, testing::ValuesIn(threaded_memory_cases()),
                         case_name);

}  // namespace
}  // namespace broadside::laws
