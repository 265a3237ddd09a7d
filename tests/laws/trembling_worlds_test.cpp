// Worlds of many boxes that tremble, whose trackers enlarge them by themselves: each update's events against
// the definition, whatever happens to the boxes in between.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/executor.hpp"
#include "broadside/world.hpp"

#include "law_case.hpp"
#include "tests/support/world_history.hpp"

namespace broadside::laws {
namespace {

struct TremblingCourse {
  std::string name;
  std::string algorithm;
  std::size_t boxes;
  int frames;
  bool has_predicate = false;
  bool keeps_pairs = true;
  bool quarantines = false;
  std::size_t threads = 1;
};

void PrintTo(const TremblingCourse& course, std::ostream* out) { *out << course.name; }

/// Nearly always all boxes tremble, and a few boxes come, go or change.
template <int D, typename Real>
class TremblingBoxes {
 public:
  TremblingBoxes(const TremblingCourse& course, std::uint64_t seed)
      : course_(course),
        rng_(seed),
        // Some four neighbours each.
        side_(static_cast<float>(D == 2 ? std::sqrt(course.boxes) : std::cbrt(course.boxes)) * 1.1F),
        history_(rng_, course_of(course)) {
    history_.add(course.boxes);
  }

  void play() {
    for (int frame = 0; frame < course_.frames; ++frame) {
      change(frame % 80);
      update();
      if (rng_.one_in(10)) history_.look();
    }
    EXPECT_GE(enlarged_, course_.frames / 4) << "frames in which the tracker enlarged boxes";
    EXPECT_LT(enlarged_, course_.frames);
  }

 private:
  WorldCourse<D, Real> course_of(const TremblingCourse& course) {
    WorldCourse<D, Real> its;
    its.options.algorithm = course.algorithm;
    its.options.keep_pairs = course.keeps_pairs;
    if (course.quarantines) its.options.bad_input = BadInput::quarantine;
    its.box = [this](Choices& choices) { return anywhere(choices); };
    its.has_predicate = its.predicate_throws = course.has_predicate;
    its.shifts = true;
    its.make = [options = its.options, threads = course.threads] {
      World<D, Real> world(options);
      world.set_workers({.threads = threads, .executor = standard_executor(), .boxes_per_thread = 1});
      return world;
    };
    return its;
  }

  void change(int phase) {
    const bool is_calm = phase >= 60 && phase < 72;
    if (phase == 79) {
      for (auto& [handle, at] : rests_) at.rest = anywhere(rng_);
    }
    for (int i = rng_.whole(0, 4); i > 0; --i) history_.change();
    if (phase == 30) change_many();
    if (!is_calm) tremble();
    if (rng_.one_in(6)) history_.go_back();
  }

  void update() {
    history_.update();
    const WorldStatistics statistics = history_.world().statistics();
    enlarged_ += static_cast<int>(statistics.explanation.find("enlarged") != std::string::npos);
  }

  /// A quarter goes, and later comes again: the slots' arrays grow and shrink.
  void change_many() {
    std::vector<Handle> some;
    for (const auto& [handle, its] : history_.model().members) {
      if (rng_.one_in(4)) some.push_back(handle);
    }
    history_.remove(some);
    if (rng_.one_in(2)) update();
    history_.add(some.size());
  }

  /// Moves all by up to a two-hundredth of their sides, and some a bit farther in each frame, so that they
  /// leave their enlarged boxes now and then.
  void tremble() {
    std::vector<Handle> handles;
    std::vector<Box<D, Real>> boxes;
    for (const auto& [handle, its] : history_.model().members) {
      Place& at = rests_[handle];
      if (at.last != its.box) at.rest = its.box;
      if (!is_present(at.rest)) {
        if (!rng_.one_in(20)) continue;
        at.rest = anywhere(rng_);
      }
      Box<D, Real> box = at.rest;
      for (int axis = 0; axis < D; ++axis) {
        const Real side = at.rest.max[axis] - at.rest.min[axis];
        const Real drift = handles.size() % 4 == 0 ? static_cast<Real>(axis == 0 ? 0.006F : 0) * side : 0;
        at.rest.min[axis] += drift;
        at.rest.max[axis] += drift;
        const Real by = static_cast<Real>(rng_.between(-0.005F, 0.005F)) * side;
        box.min[axis] = at.rest.min[axis] + by;
        box.max[axis] = at.rest.max[axis] + by;
      }
      at.last = box;
      handles.push_back(handle);
      boxes.push_back(box);
    }
    if (!rng_.one_in(4)) return history_.move(handles, boxes);
    for (std::size_t i = 0; i < handles.size(); ++i) history_.move({handles[i]}, {boxes[i]});
  }

  /// Many that touch at rest, and so meet and part as they tremble.
  Box<D, Real> anywhere(Choices& choices) const {
    Box<D, Real> box;
    const bool is_thin = choices.one_in(20);
    const Real side = static_cast<Real>(choices.one_in(5) ? choices.between(0.25F, 2) : 1.0F);
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] = static_cast<Real>(choices.whole(0, static_cast<int>(2 * side_))) / 2;
      box.max[axis] = box.min[axis] + (is_thin && axis == 0 ? side / 8 : side);
    }
    return box;
  }

  /// Where a box rests, and where it was when it last trembled. If it is elsewhere, it rests there.
  struct Place {
    Box<D, Real> rest = absent_box<D, Real>();
    Box<D, Real> last = absent_box<D, Real>();
  };

  TremblingCourse course_;
  Rng rng_;
  float side_;
  WorldHistory<D, Real> history_;
  std::map<Handle, Place> rests_{};
  int enlarged_ = 0;
};

/// Only `auto` enlarges boxes of doubles by itself.
std::vector<TremblingCourse> courses(const std::vector<std::string>& algorithms) {
  const int frames = sanitized ? 80 : 160;
  std::vector<TremblingCourse> courses;
  for (const std::string& algorithm : algorithms) courses.push_back({algorithm, algorithm, 700, frames});
  courses.push_back({"by_threads", "auto", 600, 80});
  courses.back().threads = 3;
  courses.push_back({"many", "auto", sanitized ? 1000 : 2000, 60});
  courses.push_back({"with_a_predicate", "auto", 700, frames});
  courses.back().has_predicate = true;
  courses.push_back({"without_pairs", "auto", 700, frames});
  courses.back().keeps_pairs = false;
  courses.push_back({"with_invalid_boxes", "auto", 700, frames});
  courses.back().quarantines = true;
  return courses;
}

class TremblingWorld : public testing::TestWithParam<TremblingCourse> {};

INSTANTIATE_TEST_SUITE_P(Courses, TremblingWorld,
                         testing::ValuesIn(courses({"auto", "grid", "sweep_and_prune", "quadtree", "bvh"})),
                         [](const auto& course) { return course.param.name; });

TEST_P(TremblingWorld, TellsTheEventsOfTheBoxesThemselvesInTheFlat) {
  TremblingBoxes<2, float>(GetParam(), 1).play();
}

TEST_P(TremblingWorld, TellsTheEventsOfTheBoxesThemselvesInSpace) {
  TremblingBoxes<3, float>(GetParam(), 2).play();
}

class TremblingDoubleWorld : public TremblingWorld {};

INSTANTIATE_TEST_SUITE_P(Courses, TremblingDoubleWorld, testing::ValuesIn(courses({"auto"})),
                         [](const auto& course) { return course.param.name; });

TEST_P(TremblingDoubleWorld, TellsTheEventsOfTheBoxesThemselves) {
  TremblingBoxes<2, double>(GetParam(), 3).play();
}

}  // namespace
}  // namespace broadside::laws
