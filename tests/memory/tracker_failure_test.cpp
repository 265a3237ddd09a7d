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

#include "injection.hpp"
#include "memory_case.hpp"
#include "tests/support/executors.hpp"
#include "whole_frames.hpp"

namespace broadside::laws {
namespace {

/// Few filters, so that many accept each other and many do not.
Filter any_filter(Rng& rng) {
  if (rng.one_in(3)) return {};
  return {.category = rng.one_in(2) ? 1U : 2U,
          .mask = rng.one_in(2) ? 1U : 3U,
          .group = rng.one_in(4) ? rng.whole(-1, 1) : 0,
          .is_static = rng.one_in(6)};
}

/// Frames in which boxes come, move and go, filters and ignored pairs change. Some come twice: as one that is
/// handed in again because it has failed.
template <int D, typename Real>
std::vector<WholeFrame<D, Real>> random_frames(std::size_t count, std::size_t max_boxes, Rng& rng) {
  std::vector<WholeFrame<D, Real>> frames;
  WholeFrame<D, Real> frame;
  // Where many boxes move by little, trackers enlarge them.
  const bool trembles = max_boxes > 600 && rng.one_in(2);
  frame.boxes = lattice_boxes<D, Real>(trembles ? max_boxes : rng.below(max_boxes + 1), rng);
  std::vector<Filter> filters(max_boxes);
  std::vector<Pair> ignored;
  bool has_filters = rng.one_in(3);
  bool has_ignored = rng.one_in(2);
  while (frames.size() < count) {
    if (rng.one_in(trembles ? 20 : 4)) frame.boxes.resize(rng.below(max_boxes + 1), absent_box<D, Real>());
    std::vector<Box<D, Real>> others = lattice_boxes<D, Real>(frame.boxes.size(), rng);
    const std::size_t part = trembles ? 20 : rng.one_in(3) ? 1 : rng.one_in(2) ? 4 : 20;
    if (trembles) {
      const Real by = frames.size() % 2 == 0 ? 0x1p-7F : -0x1p-7F;
      for (Box<D, Real>& box : frame.boxes) {
        if (!is_present(box) || rng.one_in(8)) continue;
        box.min[0] += by;
        box.max[0] += by;
      }
    }
    for (std::size_t i = 0; i < others.size(); ++i) {
      if (rng.one_in(part)) frame.boxes[i] = others[i];
    }
    if (rng.one_in(8)) has_filters = !has_filters;
    if (rng.one_in(8)) has_ignored = !has_ignored;
    for (std::size_t i = rng.below(4); i > 0; --i) filters[rng.below(max_boxes)] = any_filter(rng);
    for (std::size_t i = rng.below(6); i > 0; --i) {
      const std::size_t near = std::min<std::size_t>(max_boxes, 12);
      const auto a = BoxId(rng.below(near));
      const auto b = BoxId(rng.below(near));
      const Pair pair{std::min(a, b), std::max(a, b)};
      if (a == b) continue;
      const auto at = std::ranges::lower_bound(ignored, pair);
      if (at != ignored.end() && *at == pair)
        ignored.erase(at);
      else
        ignored.insert(at, pair);
    }
    frame.filters.clear();
    if (has_filters)
      frame.filters.assign(filters.begin(), filters.begin() + std::ptrdiff_t(frame.boxes.size()));
    frame.ignored.reset();
    if (has_ignored) frame.ignored = ignored;
    frames.push_back(frame);
    if (rng.one_in(3)) frames.push_back(frame);
  }
  return frames;
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
