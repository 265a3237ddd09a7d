// Worlds of many boxes that tremble, whose trackers enlarge them by themselves: each update's events against
// the definition, whatever happens to the boxes in between.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <ostream>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/executor.hpp"
#include "broadside/world.hpp"

#include "tests/support/rng.hpp"

namespace broadside::laws {
namespace {

using HandlePairs = std::vector<HandlePair>;

/// What the worlds with a predicate ask about a pair.
bool is_liked(Handle a, Handle b) { return (a.slot + b.slot + a.generation) % 5 != 0; }

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

/// What a world knows, in plain containers.
template <int D, typename Real>
struct KnownWorld {
  struct Member {
    Handle handle;
    Box<D, Real> rest;
    Box<D, Real> box;
    Filter filter;
  };

  std::vector<Member> members{};
  std::set<HandlePair> ignored{};
  HandlePairs pairs{};  ///< after the last update

  static HandlePair ordered(Handle a, Handle b) {
    return a.slot < b.slot ? HandlePair{a, b} : HandlePair{b, a};
  }

  HandlePairs pairs_now(bool asks_predicate) const {
    HandlePairs now;
    for (std::size_t i = 0; i < members.size(); ++i) {
      for (std::size_t j = i + 1; j < members.size(); ++j) {
        const Member& a = members[i];
        const Member& b = members[j];
        if (!overlap(a.box, b.box) || !is_present(a.box) || !is_present(b.box)) continue;
        const HandlePair pair = ordered(a.handle, b.handle);
        if (accepts(a.filter, b.filter) && !ignored.contains(pair) &&
            (!asks_predicate || is_liked(pair.first, pair.second)))
          now.push_back(pair);
      }
    }
    std::ranges::sort(now);
    return now;
  }
};

/// A world and its model, to which the same things happen.
template <int D, typename Real>
class History {
 public:
  History(const TremblingCourse& course, std::uint64_t seed) : course_(course), world_(made()), rng_(seed) {
    // Some four neighbours each.
    side_ = static_cast<float>(D == 2 ? std::sqrt(course.boxes) : std::cbrt(course.boxes)) * 1.1F;
    for (std::size_t i = 0; i < course.boxes; ++i) add();
  }

  void play() {
    for (int frame = 0; frame < course_.frames; ++frame) {
      change(frame);
      update("frame " + std::to_string(frame));
      if (rng_.one_in(10)) ask();
      if (testing::Test::HasFatalFailure()) return;
    }
    EXPECT_GE(enlarged_, course_.frames / 4) << "frames in which the tracker enlarged boxes";
    EXPECT_LT(enlarged_, course_.frames);
  }

 private:
  using Member = typename KnownWorld<D, Real>::Member;

  World<D, Real> made() const {
    WorldOptions options;
    options.algorithm = course_.algorithm;
    options.keep_pairs = course_.keeps_pairs;
    if (course_.quarantines) options.bad_input = BadInput::quarantine;
    World<D, Real> world(options);
    world.set_workers({.threads = course_.threads, .executor = standard_executor(), .boxes_per_thread = 1});
    if (course_.has_predicate) world.set_predicate(predicate());
    return world;
  }

  PairPredicate predicate() const {
    return [this](Handle first, Handle second) {
      if (throws_) throw std::runtime_error("a predicate's");
      return is_liked(first, second);
    };
  }

  /// What happens between two updates: nearly always all boxes tremble, and a few boxes come, go or change.
  void change(int frame) {
    const int phase = frame % 80;
    const bool is_calm = phase >= 60 && phase < 72;
    if (phase == 79) {
      for (Member& member : model_.members) member.rest = anywhere();
    }
    for (int i = rng_.whole(0, 4); i > 0; --i) change_one();
    if (phase == 30) change_many();
    if (!is_calm) tremble();
    if (rng_.one_in(12)) kept_.emplace(world_.snapshot(), model_);
    if (rng_.one_in(9)) restore();
    if (rng_.one_in(60)) world_.shrink_to_fit();
    if (rng_.one_in(60)) shift();
  }

  void change_one() {
    const std::size_t place = rng_.below(model_.members.size());
    Member& member = model_.members[place];
    const Member& other = model_.members[rng_.below(model_.members.size())];
    switch (rng_.below(7)) {
      case 0:
        return add();
      case 1:
        return remove(place);
      case 2:
        member.rest = member.box = anywhere();
        return world_.move(member.handle, member.box);
      case 3:
        member.filter = filter();
        return world_.set_filter(member.handle, member.filter);
      case 4:
        if (!course_.quarantines) return;
        world_.move(member.handle, {{}, {std::numeric_limits<Real>::quiet_NaN()}});
        member.rest = member.box = absent_box<D, Real>();
        return;
      case 5:
        return world_.refilter(member.handle);
      default:
        return toggle(member.handle, neighbour(member, other));
    }
  }

  /// One that it overlaps, if there is one, since an ignored pair is to matter.
  Handle neighbour(const Member& member, const Member& other) const {
    for (const Member& one : model_.members) {
      if (one.handle != member.handle && overlap(one.box, member.box)) return one.handle;
    }
    return other.handle;
  }

  void toggle(Handle a, Handle b) {
    if (a == b) return;
    const HandlePair pair = KnownWorld<D, Real>::ordered(a, b);
    if (model_.ignored.erase(pair) != 0) return world_.unignore(a, b);
    model_.ignored.insert(pair);
    world_.ignore(a, b);
  }

  /// A quarter goes, and later comes again: the slots' arrays grow and shrink.
  void change_many() {
    for (std::size_t i = course_.boxes / 4; i > 0; --i) remove(rng_.below(model_.members.size()));
    if (rng_.one_in(2)) update("after many are gone");
    for (std::size_t i = course_.boxes / 4; i > 0; --i) add();
  }

  void add() {
    Member member{{}, anywhere(), {}, rng_.one_in(3) ? filter() : Filter{}};
    member.box = member.rest;
    member.handle = world_.add(member.box, {.filter = member.filter});
    model_.members.push_back(member);
  }

  void remove(std::size_t place) {
    const Handle handle = model_.members[place].handle;
    world_.remove(handle);
    std::swap(model_.members[place], model_.members.back());
    model_.members.pop_back();
    std::erase_if(model_.ignored,
                  [handle](const HandlePair& pair) { return pair.first == handle || pair.second == handle; });
  }

  /// Moves all by up to a two-hundredth of their sides, and some a bit farther in each frame, so that they
  /// leave their enlarged boxes now and then.
  void tremble() {
    std::vector<Handle> handles;
    std::vector<Box<D, Real>> boxes;
    for (std::size_t i = 0; i < model_.members.size(); ++i) {
      Member& member = model_.members[i];
      if (is_present(member.rest)) {
        member.box = member.rest;
        for (int axis = 0; axis < D; ++axis) {
          const Real side = member.rest.max[axis] - member.rest.min[axis];
          const Real drift = i % 4 == 0 ? static_cast<Real>(axis == 0 ? 0.006F : 0) * side : 0;
          member.rest.min[axis] += drift;
          member.rest.max[axis] += drift;
          const Real by = static_cast<Real>(rng_.between(-0.005F, 0.005F)) * side;
          member.box.min[axis] = member.rest.min[axis] + by;
          member.box.max[axis] = member.rest.max[axis] + by;
        }
      } else if (course_.quarantines && rng_.one_in(20)) {
        member.rest = member.box = anywhere();
      } else {
        continue;
      }
      handles.push_back(member.handle);
      boxes.push_back(member.box);
    }
    if (rng_.one_in(4)) {
      for (std::size_t i = 0; i < handles.size(); ++i) world_.move(handles[i], boxes[i]);
    } else {
      world_.move(handles, boxes);
    }
  }

  /// Goes back to the last snapshot: this world, a new one, or one that followed the same boxes to here.
  void restore() {
    if (!kept_) return;
    const std::size_t how = rng_.below(3);
    if (how == 1) world_ = made();
    if (how == 2) {
      World<D, Real> other = made();
      other.restore(world_.snapshot());
      other.update();
      world_ = std::move(other);
    }
    world_.restore(kept_->first);
    ASSERT_EQ(world_.snapshot(), kept_->first);
    model_ = kept_->second;
  }

  void shift() {
    Point<D, Real> origin;
    origin.fill(static_cast<Real>(0.25));
    world_.shift_origin(origin);
    for (Member& member : model_.members) {
      for (int axis = 0; axis < D; ++axis) {
        for (Box<D, Real>* const box : {&member.rest, &member.box}) {
          box->min[axis] -= origin[axis];
          box->max[axis] -= origin[axis];
        }
      }
    }
  }

  /// One update, which a predicate that throws may make fail at first.
  void update(const std::string& when) {
    const HandlePairs now = model_.pairs_now(course_.has_predicate);
    const HandlePairs before = std::exchange(model_.pairs, now);
    throws_ = course_.has_predicate && rng_.one_in(8);
    Events events;
    try {
      events = world_.update();
    } catch (const std::runtime_error&) {
      throws_ = false;
      events = world_.update();
    }
    throws_ = false;
    const WorldStatistics statistics = world_.statistics();
    enlarged_ += static_cast<int>(statistics.explanation.find("enlarged") != std::string::npos);
    const std::string what = when + ": " + statistics.explanation;
    ASSERT_TRUE(std::ranges::equal(events.begun, without(now, before))) << what;
    ASSERT_TRUE(std::ranges::equal(events.ended, without(before, now))) << what;
    ASSERT_EQ(statistics.pairs, now.size()) << what;
    // Not always, so that events of several updates wait to be taken in.
    const bool asks_pairs = course_.keeps_pairs && rng_.one_in(3);
    ASSERT_TRUE(!asks_pairs || std::ranges::equal(world_.pairs(), now)) << what;
  }

  void ask() {
    Box<D, Real> place;
    place.min.fill(0);
    place.max.fill(static_cast<Real>(side_ / 3));
    std::vector<Handle> found;
    std::vector<Handle> expected;
    world_.overlapping(place, [&found](Handle handle) { found.push_back(handle); });
    for (const Member& member : model_.members) {
      if (is_present(member.box) && overlap(member.box, place)) expected.push_back(member.handle);
    }
    std::ranges::sort(found);
    std::ranges::sort(expected);
    ASSERT_EQ(found, expected);
  }

  static HandlePairs without(const HandlePairs& pairs, const HandlePairs& others) {
    HandlePairs rest;
    std::ranges::set_difference(pairs, others, std::back_inserter(rest));
    return rest;
  }

  /// Many that touch at rest, and so meet and part as they tremble.
  Box<D, Real> anywhere() {
    Box<D, Real> box;
    const bool is_thin = rng_.one_in(20);
    const Real side = static_cast<Real>(rng_.one_in(5) ? rng_.between(0.25F, 2) : 1.0F);
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] = static_cast<Real>(rng_.whole(0, static_cast<int>(2 * side_))) / 2;
      box.max[axis] = box.min[axis] + (is_thin && axis == 0 ? side / 8 : side);
    }
    return box;
  }

  Filter filter() {
    Filter filter;
    filter.group = rng_.whole(-2, 2);
    filter.is_static = rng_.one_in(8);
    if (rng_.one_in(8)) filter.mask = 2;
    if (rng_.one_in(8)) filter.category = 2;
    return filter;
  }

  TremblingCourse course_;
  World<D, Real> world_;
  KnownWorld<D, Real> model_{};
  std::optional<std::pair<std::vector<std::byte>, KnownWorld<D, Real>>> kept_{};
  Rng rng_;
  float side_ = 0;
  bool throws_ = false;
  int enlarged_ = 0;
};

/// Only `auto` enlarges boxes of doubles by itself.
std::vector<TremblingCourse> courses(const std::vector<std::string>& algorithms) {
  std::vector<TremblingCourse> courses;
  for (const std::string& algorithm : algorithms) {
    courses.push_back({algorithm, algorithm, 700, 160});
  }
  courses.push_back({"by_threads", "auto", 600, 80});
  courses.back().threads = 3;
  courses.push_back({"many", "auto", 2000, 60});
  courses.push_back({"with_a_predicate", "auto", 700, 160});
  courses.back().has_predicate = true;
  courses.push_back({"without_pairs", "auto", 700, 160});
  courses.back().keeps_pairs = false;
  courses.push_back({"with_invalid_boxes", "auto", 700, 160});
  courses.back().quarantines = true;
  return courses;
}

class TremblingWorld : public testing::TestWithParam<TremblingCourse> {};

INSTANTIATE_TEST_SUITE_P(Courses, TremblingWorld,
                         testing::ValuesIn(courses({"auto", "grid", "sweep_and_prune", "quadtree", "bvh"})),
                         [](const auto& course) { return course.param.name; });

TEST_P(TremblingWorld, TellsTheEventsOfTheBoxesThemselvesInTheFlat) {
  History<2, float>(GetParam(), 1).play();
}

TEST_P(TremblingWorld, TellsTheEventsOfTheBoxesThemselvesInSpace) { History<3, float>(GetParam(), 2).play(); }

class TremblingDoubleWorld : public TremblingWorld {};

INSTANTIATE_TEST_SUITE_P(Courses, TremblingDoubleWorld, testing::ValuesIn(courses({"auto"})),
                         [](const auto& course) { return course.param.name; });

TEST_P(TremblingDoubleWorld, TellsTheEventsOfTheBoxesThemselves) { History<2, double>(GetParam(), 3).play(); }

}  // namespace
}  // namespace broadside::laws
