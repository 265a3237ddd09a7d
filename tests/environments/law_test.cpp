// The law in every floating-point environment: what the library answers is what it answers in the default
// one, in the same order, on every instruction set.
#include <algorithm>
#include <bit>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/debug/outline.hpp"
#include "broadside/moving.hpp"
#include "broadside/queries.hpp"
#include "broadside/sinks.hpp"
#include "broadside/world.hpp"

#include "environment.hpp"
#include "tests/laws/hard_inputs.hpp"
#include "tests/laws/law_case.hpp"
#include "tests/laws/tracker_histories.hpp"
#include "tests/support/found.hpp"
#include "tests/support/instruction_sets.hpp"
#include "tests/support/searchers.hpp"

namespace broadside::laws {
namespace {

/// The boxes, in double with bits that a float does not have, down to the denormals of a double.
template <int D, typename Real>
std::vector<Box<D, Real>> real(const std::vector<Box<D>>& floats) {
  std::vector<Box<D, Real>> boxes;
  for (const Box<D>& box : floats) {
    Box<D, Real>& result = boxes.emplace_back();
    for (int axis = 0; axis < D; ++axis) {
      result.min[axis] = box.min[axis];
      result.max[axis] = box.max[axis];
      if (std::is_same_v<Real, float> || is_absent(box) || boxes.size() % 3 == 0) continue;
      if (result.min[axis] == 0) result.min[axis] -= std::numeric_limits<Real>::denorm_min();
      if (result.max[axis] == 0) result.max[axis] += std::numeric_limits<Real>::denorm_min();
      if (boxes.size() % 3 == 1) continue;
      result.min[axis] -= std::min<Real>(std::abs(result.min[axis]), 1) * Real(0x1p-40);
      result.max[axis] += std::min<Real>(std::abs(result.max[axis]), 1) * Real(0x1p-40);
    }
  }
  return boxes;
}

/// The hard inputs of both types of coordinates: body(name, boxes).
template <int D, typename Body>
void for_hard_inputs(const Algorithm& algorithm, Body body) {
  for (const Input<D>& input : hard_inputs<D>(algorithm, 100)) {
    body(input.name, input.boxes);
    body(input.name + ", in double", real<D, double>(input.boxes));
  }
}

class EnvironmentLaw : public Law {};

TEST_P(EnvironmentLaw, FindsTheSamePairsInTheSameOrder) {
  const std::vector<std::string> sets = instruction_sets();
  std::size_t turn = 0;
  in_dimension([&]<int D>() {
    for_hard_inputs<D>(
        algorithm(), [&]<typename Real>(const std::string& name, const std::vector<Box<D, Real>>& boxes) {
          Finder<D, Real> finder(algorithm(), spec());
          const std::vector<Pair> expected = found(finder, boxes);
          const std::vector<Pair> between = found(finder, boxes, boxes.size() / 3);
          for (const Environment& environment : environments()) {
            const InEnvironment in(environment);
            EXPECT_EQ(found(finder, boxes), expected) << name << ", " << environment.name;
            EXPECT_EQ(found(finder, boxes, boxes.size() / 3), between) << name << ", " << environment.name;
          }
          // On each of the other instruction sets another environment in turn.
          for (std::size_t i = 1; i < sets.size(); ++i) {
            const Environment& environment = environments()[++turn % environments().size()];
            const OnInstructionSet on(sets[i]);
            const InEnvironment in(environment);
            EXPECT_EQ(found(finder, boxes), expected) << name << ", " << environment.name << ", " << sets[i];
          }
        });
  });
}

TEST(MovingBoxesLaw, OverlapAtTheSameTimes) {
  for_hard_inputs<3>(Algorithm{},
                     []<typename Real>(const std::string& name, const std::vector<Box<3, Real>>& from) {
                       std::vector<Box<3, Real>> to = from;
                       std::ranges::reverse(to);
                       const std::vector<Pair> pairs = find_pairs_moving(from, to);
                       const std::vector<OverlapTime> times = overlap_times(from, to, pairs);
                       for (const Environment& environment : environments()) {
                         const InEnvironment in(environment);
                         EXPECT_EQ(find_pairs_moving(from, to), pairs) << name << ", " << environment.name;
                         EXPECT_EQ(overlap_times(from, to, pairs), times) << name << ", " << environment.name;
                       }
                     });
}

/// Frames made of one input: all boxes in other places, a few of them back, some gone, the first frame again.
template <int D, typename Real>
std::vector<std::vector<Box<D, Real>>> frames_of(const std::vector<Box<D, Real>>& boxes) {
  std::vector<std::vector<Box<D, Real>>> frames(5, boxes);
  std::ranges::reverse(frames[1]);
  frames[2] = frames[3] = frames[1];
  for (std::size_t i = 0; i < boxes.size(); i += 8) frames[2][i] = frames[3][i] = boxes[i];
  for (std::size_t i = 0; i < boxes.size(); i += 3) frames[3][i] = absent_box<D, Real>();
  return frames;
}

/// What a tracker tells of frames whose boxes may all have changed, or of which only some are listed.
template <int D, typename Real>
class Followed {
 public:
  explicit Followed(const Algorithm& algorithm, const Spec& spec) : tracker_(algorithm, spec) {}

  std::vector<Pair> events(const std::vector<Box<D, Real>>& boxes) {
    std::vector<BoxId> changed;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (i >= last_.size() || bits(boxes[i]) != bits(last_[i])) changed.push_back(BoxId(i));
    }
    last_ = boxes;
    std::vector<Pair> events;
    PairCollector begun(events);
    PairCollector ended(events);
    tracker_.update({.boxes = boxes, .changed = changed}, begun, ended);
    return events;
  }

 private:
  /// Compared as integers, which no environment changes.
  static auto bits(const Box<D, Real>& box) {
    return std::bit_cast<
        std::array<std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>, 2 * D>>(box);
  }

  Tracker<D, Real> tracker_;
  std::vector<Box<D, Real>> last_;
};

TEST_P(EnvironmentLaw, TracksTheSamePairs) {
  const bool is_own = algorithm().kind == AlgorithmKind::own;
  std::size_t turn = 0;
  in_dimension([&]<int D>() {
    const auto expect_same = [&]<typename Real>(const std::string& name,
                                                const std::vector<std::vector<Box<D, Real>>>& frames) {
      Followed<D, Real> alone(algorithm(), spec());
      std::vector<std::vector<Pair>> expected;
      for (const std::vector<Box<D, Real>>& boxes : frames) expected.push_back(alone.events(boxes));
      // The one with most in it, and another in turn.
      for (const Environment* environment : {&environments()[++turn % environments().size()], &hardest()}) {
        const InEnvironment in(*environment);
        Followed<D, Real> followed(algorithm(), spec());
        for (std::size_t i = 0; i < frames.size(); ++i) {
          ASSERT_EQ(followed.events(frames[i]), expected[i])
              << name << ", frame " << i << ", " << environment->name;
        }
      }
    };
    for_hard_inputs<D>(algorithm(), [&](const std::string& name, const auto& boxes) {
      if (boxes.size() <= (is_own ? 300 : 60)) expect_same(name, frames_of(boxes));
    });
    if (!is_own) return;
    for (const NamedFrames<D>& named : scripted_histories<D>(algorithm())) {
      std::vector<std::vector<Box<D>>> frames;
      for (const WholeFrame<D>& frame : named.frames) frames.push_back(frame.boxes);
      expect_same(named.name, frames);
    }
  });
}

/// Runs tasks in threads of their own, each of which has another environment.
class ForeignThreads final : public Executor {
 public:
  std::size_t threads() const noexcept override { return 4; }

  void run(std::size_t count, const std::function<void(std::size_t)>& task) override {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < count; ++i) {
      threads.emplace_back([&task, i] {
        const InEnvironment in(environments()[i % environments().size()]);
        task(i);
      });
    }
  }
};

class ThreadedEnvironmentLaw : public EnvironmentLaw {};

TEST_P(ThreadedEnvironmentLaw, FindsTheSamePairsByThreadsOfOtherEnvironments) {
  ForeignThreads executor;
  std::size_t turn = 0;
  in_dimension([&]<int D>() {
    for_hard_inputs<D>(algorithm(), [&]<typename Real>(const std::string& name,
                                                       const std::vector<Box<D, Real>>& boxes) {
      if (++turn % 16 != 0) return;
      Finder<D, Real> finder(algorithm(), spec());
      const std::vector<Pair> expected = found(finder, boxes);
      finder.set_workers({.threads = environments().size(), .executor = &executor, .boxes_per_thread = 1});
      EXPECT_EQ(found(finder, boxes), expected) << name;
    });
  });
}

TEST_P(EnvironmentLaw, DrawsTheSameOutline) {
  in_dimension([&]<int D>() {
    for (const Input<D>& input : hard_inputs<D>(algorithm(), 100)) {
      const Outline<D> expected = outline<D, float>(algorithm(), spec(), input.boxes);
      for (const Environment& environment : environments()) {
        const auto drawn = [&] {
          const InEnvironment in(environment);
          return outline<D, float>(algorithm(), spec(), input.boxes);
        }();
        EXPECT_EQ(drawn.caption, expected.caption) << input.name << ", " << environment.name;
        EXPECT_EQ(drawn.levels, expected.levels) << input.name << ", " << environment.name;
      }
    }
  });
}

TEST(SpecInEnvironments, NamesTheSameNumber) {
  double seen = 0;
  Algorithm algorithm;
  algorithm.tunables = {{.name = "size", .summary = "", .default_value = "1"}};
  algorithm.in_2d.searcher = [&seen](const Settings& settings) {
    seen = settings.number("size");
    return searcher_of<2>("grid");
  };
  const Spec spec = {"any", {{"size", "0.0007873178702928792"}}};
  static_cast<void>(Finder<2>(algorithm, spec));
  const double expected = seen;
  for (const Environment& environment : environments()) {
    const InEnvironment in(environment);
    static_cast<void>(Finder<2>(algorithm, spec));
    EXPECT_EQ(std::bit_cast<std::uint64_t>(seen), std::bit_cast<std::uint64_t>(expected)) << environment.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Library, EnvironmentLaw, testing::ValuesIn(cases_of(algorithms())), case_name);
INSTANTIATE_TEST_SUITE_P(Library, ThreadedEnvironmentLaw, testing::ValuesIn(threaded_cases()), case_name);

}  // namespace
}  // namespace broadside::laws
