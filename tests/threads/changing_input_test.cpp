// What another thread writes to the caller's arrays during a call may spoil the pairs, and nothing else: each
// algorithm, tracker, index and world reads some of its input several times, and no place that it computed
// from one look may be out of bounds at the next.
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <span>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/debug/outline.hpp"
#include "broadside/error.hpp"
#include "broadside/find_pairs.hpp"
#include "broadside/finder.hpp"
#include "broadside/index.hpp"
#include "broadside/sinks.hpp"
#include "broadside/tracker.hpp"
#include "broadside/world.hpp"

#include "law_case.hpp"
#include "searches.hpp"

namespace broadside::laws {
namespace {

/// What a box becomes: another one, small, large, in one place or far away; or one that was read half before
/// and half after it changed, or with a NaN.
template <int D, typename Real>
Box<D, Real> changed_box(std::mt19937& random) {
  const auto kind = random() % 200;
  Box<D, Real> box;
  for (int axis = 0; axis < D; ++axis) {
    const auto at = static_cast<Real>(random() % 1000);
    box.min[axis] = kind == 0 ? 500 : at;
    box.max[axis] = box.min[axis] + (kind == 1 ? 1000 : static_cast<Real>(random() % 10));
    if (kind / 4 == 1) box.max[axis] = box.min[axis] - 5;
    if (kind / 4 == 2 && random() % 2 == 0) box.min[axis] = std::numeric_limits<Real>::quiet_NaN();
    if (kind / 4 == 3 && random() % 2 == 0) box.max[axis] = std::numeric_limits<Real>::quiet_NaN();
    if (kind == 2 && random() % 2 == 0) box.max[axis] = std::numeric_limits<Real>::infinity();
  }
  return box;
}

template <int D, typename Real>
std::vector<Box<D, Real>> valid_boxes(std::size_t count, std::mt19937& random) {
  std::vector<Box<D, Real>> boxes;
  while (boxes.size() < count) {
    const Box<D, Real> box = changed_box<D, Real>(random);
    if (is_present(box)) boxes.push_back(box);
  }
  return boxes;
}

/// Runs all tasks in the calling thread and, once it was run some times since begin(), changes boxes before
/// each: so they are valid when they are checked, and change between the passes that follow.
template <int D, typename Real>
class ChangingExecutor final : public Executor {
 public:
  explicit ChangingExecutor(std::vector<Box<D, Real>>& boxes) : boxes_(boxes) {}

  std::size_t threads() const noexcept override { return 3; }

  void run(std::size_t count, const std::function<void(std::size_t)>& task) override {
    for (std::size_t i = 0; i < count; ++i) {
      if (runs_ >= first_) {
        for (Box<D, Real>& box : boxes_) {
          if (random_() % 4 == 0) box = changed_box<D, Real>(random_);
        }
      }
      task(i);
    }
    ++runs_;
  }

  /// From the run of this number on.
  void begin(std::size_t first) {
    runs_ = 0;
    first_ = first;
  }

 private:
  std::size_t runs_ = 0;
  std::size_t first_ = 0;
  std::vector<Box<D, Real>>& boxes_;
  std::mt19937 random_{7};
};

/// Takes only pairs of places that there are.
class PlacesSink final : public PairSink {
 public:
  explicit PlacesSink(std::size_t boxes) : boxes_(boxes) {}
  ~PlacesSink() override { EXPECT_EQ(beyond_, 0u); }

 private:
  void consume(std::span<const Pair> pairs) override {
    for (const Pair pair : pairs)
      beyond_ += std::max(index(pair.first), index(pair.second)) >= boxes_ ? 1 : 0;
  }

  std::size_t boxes_;
  std::size_t beyond_ = 0;
};

std::vector<Pair> sorted(std::vector<Pair> pairs) {
  std::ranges::sort(pairs);
  return pairs;
}

/// Calls `call`, which may refuse what it finds.
template <typename Call>
void try_to(const Call& call) {
  try {
    call();
  } catch (const InvalidInput&) {
  } catch (const InvalidFrame&) {
  } catch (const InvalidHandle&) {
  }
}

class ChangingInput : public Law {
 protected:
  /// Searches of all kinds, while the boxes change.
  template <int D, typename Real>
  void search(
      Finder<D, Real>& finder, const std::vector<Box<D, Real>>& boxes,
      const std::function<void()>& begin = [] {}) {
    const std::span<const Box<D, Real>> all = boxes;
    begin();
    try_to([&] {
      PlacesSink sink(boxes.size());
      finder.find(all, sink);
    });
    begin();
    try_to([&] {
      PlacesSink sink(boxes.size());
      finder.find_across(all, boxes.size() / 3, sink);
    });
    begin();
    try_to([&] { static_cast<void>(outline<D, Real>(spec().text(), all, finder.workers())); });
  }

  template <int D, typename Real>
  void follow(Tracker<D, Real>& tracker, const std::vector<Box<D, Real>>& boxes,
              std::span<const BoxId> changed) {
    try_to([&] {
      PlacesSink begun(boxes.size());
      PlacesSink ended(boxes.size());
      tracker.update({.boxes = boxes, .changed = changed}, begun, ended);
    });
  }

  template <int D, typename Real>
  void changes_between_passes(std::size_t count) {
    std::mt19937 random(3);
    std::vector<Box<D, Real>> boxes = valid_boxes<D, Real>(count, random);
    const std::vector<Box<D, Real>> before = boxes;
    ChangingExecutor<D, Real> executor(boxes);
    Finder<D, Real> finder(spec().text());
    finder.set_workers(workers(3, &executor));
    Tracker<D, Real> tracker(spec().text());
    tracker.set_workers(workers(3, &executor));
    std::vector<BoxId> places;
    for (std::size_t i = 0; i < count; i += 3) places.push_back(BoxId(i));
    constexpr std::size_t never = std::numeric_limits<std::size_t>::max();
    for (const std::size_t first : {1, 2, 3, 4, 6, 9}) {
      const auto begin = [&] {
        boxes = before;
        executor.begin(first);
      };
      search<D, Real>(finder, boxes, begin);
      begin();
      follow(tracker, boxes, places);
      boxes = before;
      executor.begin(never);
      EXPECT_EQ(sorted(found(finder, boxes)), sorted(find_pairs(boxes, {.algorithm = "brute_force"})));
    }
  }
};

TEST_P(ChangingInput, SpoilsNothingButPairsWhereItChangesBetweenThePassesOfASearch) {
  in_dimension([&]<int D>() {
    changes_between_passes<D, float>(1000);
    changes_between_passes<D, double>(1000);
    changes_between_passes<D, float>(40);
  });
}

/// Another element of a list of places or handles; some name no box.
BoxId changed_element(BoxId other, std::mt19937& random) {
  return random() % 16 == 0 ? BoxId(random()) : other;
}
Handle changed_element(Handle other, std::mt19937& random) {
  return random() % 16 == 0 ? Handle{static_cast<std::uint32_t>(random()), other.generation} : other;
}

#if defined(__SANITIZE_THREAD__)
constexpr bool is_race_refused = true;  // plain memory that two threads share is what that looks for
#else
constexpr bool is_race_refused = false;
#endif

/// Calls `call` some times, while another thread changes the boxes, and an element of `list` now and then.
template <int D, typename Real, typename Element, typename Call>
void race(std::vector<Box<D, Real>>& boxes, std::vector<Element>& list, const Call& call) {
  const std::vector<Element> valid = list;
  std::atomic<bool> ends = false;
  std::thread writer([&] {
    std::mt19937 random(5);
    while (!ends) {
      boxes[random() % boxes.size()] = changed_box<D, Real>(random);
      list[random() % list.size()] = changed_element(valid[random() % valid.size()], random);
    }
  });
  std::mt19937 random(9);
  for (int round = 0; round < 12; ++round) {
    for (Box<D, Real>& box : boxes) {
      if (!is_present(box)) box = valid_boxes<D, Real>(1, random).front();
    }
    list = valid;
    call();
  }
  ends = true;
  writer.join();
}

TEST_P(ChangingInput, SpoilsNothingButPairsWhereAnotherThreadWrites) {
  if (is_race_refused) GTEST_SKIP() << "a race that is meant";
  in_dimension([&]<int D>() {
    std::mt19937 random(4);
    std::vector<Box<D>> boxes = valid_boxes<D, float>(2000, random);
    std::vector<BoxId> places;
    for (std::size_t i = 0; i < 500; ++i) places.push_back(BoxId(7 * i));
    Finder<D> finder(spec().text());
    Tracker<D> tracker(spec().text());
    race(boxes, places, [&] {
      search(finder, boxes);
      follow(tracker, boxes, places);
    });
  });
}

INSTANTIATE_TEST_SUITE_P(All, ChangingInput, testing::ValuesIn(threaded_cases()),
                         [](const auto& one) { return name(one.param); });

TEST(ChangingIndex, SpoilsNothingButAnswersWhereAnotherThreadWrites) {
  if (is_race_refused) GTEST_SKIP() << "a race that is meant";
  const auto check = []<int D, typename Real>() {
    std::mt19937 random(4);
    std::vector<Box<D, Real>> boxes = valid_boxes<D, Real>(2000, random);
    std::vector<BoxId> places;
    for (std::size_t i = 0; i < 100; ++i) places.push_back(BoxId(7 * i));
    BoxIndex<D, Real> boxes_index;
    race(boxes, places, [&] {
      try_to([&] { boxes_index.update({.boxes = boxes, .changed = places}); });
      Box<D, Real> all;
      all.min.fill(-1);
      all.max.fill(2000);
      boxes_index.overlapping(all, [&](BoxId id) { EXPECT_LT(index(id), boxes.size()); });
    });
  };
  check.template operator()<2, float>();
  check.template operator()<3, double>();
}

TEST(ChangingWorld, SpoilsNothingButEventsWhereAnotherThreadWrites) {
  if (is_race_refused) GTEST_SKIP() << "a race that is meant";
  std::mt19937 random(4);
  for (const float margin : {0.0F, 2.0F}) {
    std::vector<Box2> boxes = valid_boxes<2, float>(1000, random);  // races leave some that are not
    World2 world(WorldOptions{.margin = margin});
    std::vector<Handle> handles(boxes.size());
    world.add(boxes, handles);
    std::vector<Handle> leaving(handles.begin(), handles.begin() + 8);
    race(boxes, handles, [&] {
      try_to([&] { world.move(std::span<const Handle>(handles), boxes); });
      try_to([&] { world.update(); });
    });
    race(boxes, leaving, [&] {
      try_to([&] { world.remove(leaving); });
      try_to([&] { world.update(); });
    });
  }
}

}  // namespace
}  // namespace broadside::laws
