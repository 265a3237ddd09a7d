// The law through the interface for C: on every scene, of every kind, by every algorithm, of the shared
// library. The scenes, and what is expected, are of the library that this program has in itself.
#include <algorithm>
#include <cstdint>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include <dlfcn.h>
#include <gtest/gtest.h>

#include "broadside/broadside.hpp"

#include "bindings/c/broadside.h"
#include "lab/scenes/scene.hpp"

namespace broadside {
namespace {

#ifdef BROADSIDE_SHARED_LIBRARY
/// The function of this name in the shared library. With RTLD_LOCAL, what that library defines and this
/// program does as well stays two things.
template <typename Function>
Function* loaded(const char* name) {
  static void* const library = dlopen(BROADSIDE_SHARED_LIBRARY, RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) throw std::runtime_error(dlerror());
  void* const symbol = dlsym(library, name);
  if (symbol == nullptr) throw std::runtime_error(dlerror());
  return reinterpret_cast<Function*>(symbol);
}

#define LOADED(function) (*loaded<decltype(function)>(#function))
#else  // under sanitizers no shared library is built, and the program's own functions are called
#define LOADED(function) function
#endif

template <int D, typename Real>
constexpr broadside_kind kind_of = D == 2 ? (sizeof(Real) == 4 ? BROADSIDE_FLOAT_2D : BROADSIDE_DOUBLE_2D)
                                          : (sizeof(Real) == 4 ? BROADSIDE_FLOAT_3D : BROADSIDE_DOUBLE_3D);

template <int D, typename Real>
broadside_boxes view_of(const std::vector<Box<D, Real>>& boxes) {
  return {kind_of<D, Real>, boxes.data(), boxes.size(), 0};
}

std::vector<std::string> algorithm_names() {
  std::vector<std::string> names;
  for (std::size_t i = 0; LOADED(broadside_algorithm_name)(i) != nullptr; ++i) {
    const std::string name = LOADED(broadside_algorithm_name)(i);
    if (find_algorithm(name)->kind == AlgorithmKind::own) names.push_back(name);
  }
  return names;
}

using Keys = std::vector<std::uint64_t>;

Keys sorted_keys(const broadside_pair* pairs, std::size_t count) {
  Keys keys;
  for (std::size_t i = 0; i < count; ++i)
    keys.push_back(std::uint64_t{pairs[i].first} << 32 | pairs[i].second);
  std::ranges::sort(keys);
  return keys;
}

/// By the definition: between the two sets, or within `left` if there is no right one.
template <int D, typename Real>
Keys expected_keys(const std::vector<Box<D, Real>>& left, const std::vector<Box<D, Real>>* right) {
  Keys keys;
  const std::vector<Box<D, Real>>& others = right == nullptr ? left : *right;
  for (std::size_t i = 0; i < left.size(); ++i) {
    for (std::size_t j = right == nullptr ? i + 1 : 0; j < others.size(); ++j) {
      if (is_present(left[i]) && is_present(others[j]) && overlap(left[i], others[j]))
        keys.push_back(std::uint64_t{i} << 32 | j);
    }
  }
  return keys;
}

/// A finder or a tracker by the algorithm; null if `create` failed.
template <int D, typename Real, typename Made>
Made* made(broadside_status (*create)(int, broadside_kind, const broadside_find_options*, Made**,
                                      broadside_error*),
           const std::string& algorithm, broadside_error& error) {
  broadside_find_options options;
  LOADED(broadside_find_options_init)(&options);
  options.algorithm = algorithm.c_str();
  Made* one = nullptr;
  create(BROADSIDE_C_API_VERSION, kind_of<D, Real>, &options, &one, &error);
  return one;
}

template <int D, typename Real>
void check_finding(const std::vector<Box<D, Real>>& boxes, const std::string& name) {
  const auto middle = boxes.begin() + static_cast<std::ptrdiff_t>(boxes.size() / 2);
  const std::vector<Box<D, Real>> left(boxes.begin(), middle);
  const std::vector<Box<D, Real>> right(middle, boxes.end());
  const Keys within = expected_keys<D, Real>(boxes, nullptr);
  const Keys between = expected_keys<D, Real>(left, &right);
  for (const std::string& algorithm : algorithm_names()) {
    SCOPED_TRACE(name + " by " + algorithm);
    broadside_error error;
    auto* const finder = made<D, Real>(LOADED(broadside_finder_create), algorithm, error);
    ASSERT_NE(finder, nullptr) << error.message;
    const broadside_pair* pairs = nullptr;
    std::size_t count = 0;
    const broadside_boxes all = view_of(boxes);
    ASSERT_EQ(LOADED(broadside_finder_find)(finder, &all, nullptr, nullptr, &pairs, &count, &error),
              BROADSIDE_OK)
        << error.message;
    EXPECT_EQ(sorted_keys(pairs, count), within);
    const broadside_boxes lefts = view_of(left);
    const broadside_boxes rights = view_of(right);
    ASSERT_EQ(LOADED(broadside_finder_find)(finder, &lefts, &rights, nullptr, &pairs, &count, &error),
              BROADSIDE_OK)
        << error.message;
    EXPECT_EQ(sorted_keys(pairs, count), between);
    LOADED(broadside_finder_destroy)(finder);
  }
}

template <int D, typename Real>
void check_tracking(const std::vector<std::vector<Box<D, Real>>>& frames, const std::string& name) {
  for (const std::string& algorithm : algorithm_names()) {
    SCOPED_TRACE(name + " by " + algorithm);
    broadside_error error;
    auto* const tracker = made<D, Real>(LOADED(broadside_tracker_create), algorithm, error);
    ASSERT_NE(tracker, nullptr) << error.message;
    Keys held;
    for (const std::vector<Box<D, Real>>& boxes : frames) {
      const broadside_boxes all = view_of(boxes);
      broadside_pair_events events;
      ASSERT_EQ(LOADED(broadside_tracker_update)(tracker, &all, nullptr, 0, nullptr, &events, &error),
                BROADSIDE_OK)
          << error.message;
      const Keys begun = sorted_keys(events.begun, events.begun_count);
      const Keys ended = sorted_keys(events.ended, events.ended_count);
      Keys now;
      std::ranges::set_difference(held, ended, std::back_inserter(now));
      EXPECT_EQ(now.size(), held.size() - ended.size()) << "a pair ended that was none";
      Keys both;
      std::ranges::set_union(now, begun, std::back_inserter(both));
      EXPECT_EQ(both.size(), now.size() + begun.size()) << "a pair began that was one";
      EXPECT_EQ(both, (expected_keys<D, Real>(boxes, nullptr)));
      held = std::move(both);
    }
    LOADED(broadside_tracker_destroy)(tracker);
  }
}

template <int D, typename Real>
std::vector<Box<D, Real>> as(const std::vector<Box<D>>& boxes) {
  std::vector<Box<D, Real>> result(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (int axis = 0; axis < D; ++axis) {
      result[i].min[axis] = boxes[i].min[axis];
      result[i].max[axis] = boxes[i].max[axis];
    }
  }
  return result;
}

class CLaw : public testing::TestWithParam<std::string> {
 protected:
  template <int D, typename Real>
  void check() {
    const lab::NamedScene named = lab::find_scene(GetParam());
    if (!named.scene.has_dimension(D)) return;
    lab::History<D> history =
        lab::make_history<D>(named.scene, named.spec, {.boxes = 200, .frames = 3, .moving = 0.5});
    if (history.boxes.size() > 2'000) {  // of a file
      history.boxes.resize(2'000);
      history.steps.clear();
    }
    check_finding(as<D, Real>(history.boxes), GetParam());
    std::vector<std::vector<Box<D, Real>>> frames = {as<D, Real>(history.boxes)};
    std::vector<Box<D>> boxes = history.boxes;
    for (std::size_t i = 0; i < std::min<std::size_t>(3, history.steps.size()); ++i) {
      lab::apply(history.steps[i], boxes);
      frames.push_back(as<D, Real>(boxes));
    }
    check_tracking(frames, GetParam());
  }
};

TEST_P(CLaw, HoldsForFloats) {
  check<2, float>();
  check<3, float>();
}

TEST_P(CLaw, HoldsForDoubles) {
  check<2, double>();
  check<3, double>();
}

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const lab::Scene& scene : lab::scenes()) names.push_back(scene.name);
  return names;
}

std::string name_of(const testing::TestParamInfo<std::string>& scene) { return scene.param; }

INSTANTIATE_TEST_SUITE_P(Scenes, CLaw, testing::ValuesIn(scene_names()), name_of);

}  // namespace
}  // namespace broadside
