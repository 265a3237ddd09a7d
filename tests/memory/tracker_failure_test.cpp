// Trackers that run out of memory: the update throws std::bad_alloc, and the next one that comes to its end
// tells of all that happened meanwhile, once.
#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "drawn_frames.hpp"
#include "injection.hpp"
#include "memory_case.hpp"
#include "tests/support/executors.hpp"

namespace broadside::laws {
namespace {

/// Frames of up to `max_boxes` boxes. Where many boxes move by little, trackers enlarge them.
template <int D, typename Real>
std::vector<WholeFrame<D, Real>> random_frames(std::size_t count, std::size_t max_boxes, Rng& rng) {
  const bool trembles = max_boxes > 600 && rng.one_in(2);
  return draw_frames<D, Real>(rng, {.frames = count,
                                    .boxes = trembles ? max_boxes : (max_boxes + 1) / 2,
                                    .changes = trembles ? max_boxes / 20 : max_boxes,
                                    .resize_one_in = std::size_t{trembles ? 20U : 4U},
                                    .sweep_one_in = std::size_t{trembles ? 0U : 3U},
                                    .coordinates = Coordinates::halves,
                                    .trembles = trembles,
                                    .has_filters = true});
}

/// What the tracker tells wrongly of the frames; empty if nothing.
template <int D, typename Real>
std::string play(const MemoryCase& memory_case, const Spec& spec, const Workers& workers,
                 std::span<const WholeFrame<D, Real>> frames, Injector& injector) {
  std::optional<Tracker<D, Real>> made;
  while (!injector.attempt([&] { made.emplace(*memory_case.algorithm, spec); })) {
  }
  Tracker<D, Real>& tracker = *made;
  tracker.set_workers(workers);
  std::string wrong;
  const auto run = [&](const std::function<void()>& update) {
    const std::size_t size = tracker.last_frame().boxes.size();
    if (injector.attempt(update)) return true;
    const Frame<D, Real> last = tracker.last_frame();
    if (last.boxes.size() != size || (!last.filters.empty() && last.filters.size() != size))
      wrong = "after an update that failed, the last frame is not the one before";
    return false;
  };
  const std::string text = divergence<D, Real>(tracker, frames, run);
  return wrong.empty() ? text : wrong;
}

class TrackerFailure : public MemoryTest {
 protected:
  /// Plays histories with each allocation failing, and many with some failing at random.
  template <int D, typename Real>
  void check(const std::vector<Spec>& specs, const std::vector<Workers>& all_workers) {
    std::uint64_t failures = 0;
    Rng rng(2);
    for (const Spec& spec : specs) {
      for (const Workers& workers : all_workers) {
        const bool is_alone = workers.threads == 1;
        const std::int64_t blocks = blocks_held();
        std::string text;
        const auto run = [&](std::span<const WholeFrame<D, Real>> frames, Injector injector) {
          text = play<D, Real>(GetParam(), spec, workers, frames, injector);
          failures += injector.failures();
          return injector.failures() > 0;
        };
        {
          const auto few = random_frames<D, Real>(7, 12, rng);
          for (const FailureKind kind : {FailureKind::once, FailureKind::from_then_on}) {
            for (std::uint64_t k = 0; text.empty() && run(few, {k, kind}); k = next_number(k, !is_alone)) {
            }
            ASSERT_EQ(text, "") << spec.text();
          }
        }
        for (std::uint64_t seed = 0; seed < random_histories(); ++seed) {
          constexpr std::array<std::size_t, 6> most = {3, 20, 20, 60, 200, 700};
          const auto frames = random_frames<D, Real>(10, rng.one_of<std::size_t>(most), rng);
          run(frames, Injector(seed));
          ASSERT_EQ(text, "") << spec.text() << ", seed " << seed;
        }
        if (is_alone) {
          ASSERT_EQ(blocks_held(), blocks) << spec.text() << " leaks";
        }
      }
    }
    RecordProperty("failures", std::to_string(failures));
  }
};

TEST_P(TrackerFailure, NeitherLosesNorDoublesEvents) {
  in_case([&]<int D, typename Real>() { check<D, Real>(specs_of(GetParam()), {Workers{}}); });
}

class ThreadedTrackerFailure : public TrackerFailure {};

TEST_P(ThreadedTrackerFailure, NeitherLosesNorDoublesEventsInAnyThread) {
  ReverseExecutor reverse;
  in_case([&]<int D, typename Real>() {
    check<D, Real>(threaded_specs_of(GetParam()),
                   {{.threads = 3, .executor = nullptr, .boxes_per_thread = 4},
                    {.threads = 5, .executor = &reverse, .boxes_per_thread = 1}});
  });
}

INSTANTIATE_TEST_SUITE_P(Library, TrackerFailure, testing::ValuesIn(memory_cases()), case_name);
INSTANTIATE_TEST_SUITE_P(Library, ThreadedTrackerFailure, testing::ValuesIn(threaded_memory_cases()),
                         case_name);

}  // namespace
}  // namespace broadside::laws
