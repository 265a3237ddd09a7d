// Worlds that run out of memory: a call that throws std::bad_alloc has changed nothing, and an update that
// has failed can be tried again.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/world.hpp"

#include "failing_allocation.hpp"
#include "injection.hpp"
#include "memory_case.hpp"

namespace broadside::laws {
namespace {

/// A world and, by definition, what it must know.
template <int D, typename Real>
class Model {
 public:
  Model(const WorldOptions& options, std::size_t max_boxes, std::uint64_t seed, Injector& injector)
      : rng_(seed), max_boxes_(max_boxes), injector_(injector) {
    while (!injector_.attempt([&] { world_.emplace(options); })) {
    }
  }

  /// Does something to the world. What is wrong then; empty if nothing is.
  std::string act() {
    switch (rng_.below(15)) {
      case 0:
      case 1:
        return add(1 + rng_.below(2));
      case 2:
        return add(rng_.below(max_boxes_ + 1));
      case 3:
      case 4:
        return move();
      case 5:
        return remove();
      case 6:
        return set_filter();
      case 7:
      case 8:
        return ignore();
      case 9:
        return change_predicate();
      case 10:
        return query();
      case 11:
        return look_back();
      case 12:
        return go_back();
      default:
        return update();
    }
  }

  /// Lets an update come to its end.
  std::string end() {
    while (is_owed_) {
      if (std::string text = update(); !text.empty()) return text;
    }
    return compare("the pairs", world_->pairs(), known_.pairs);
  }

 private:
  using Pairs = std::vector<HandlePair>;

  struct Live {
    Box<D, Real> box;
    Filter filter;
  };

  struct Known {
    std::map<Handle, Live> live{};
    std::set<HandlePair> ignored{};
    std::uint32_t phase = 3;  ///< of the predicate; 3: none
    Pairs pairs{};
    Pairs persisting{};
  };

  struct Kept {
    Known known;
    std::vector<std::byte> bytes;
  };

  Box<D, Real> any_box() {
    for (;;) {
      const Box<D, Real> box = lattice_boxes<D, Real>(std::max<std::size_t>(max_boxes_, 1), rng_).front();
      if (is_present(box)) return box;
    }
  }

  Handle any_handle() {
    return std::next(known_.live.begin(), std::ptrdiff_t(rng_.below(known_.live.size())))->first;
  }

  std::vector<Handle> some_handles() {
    std::set<Handle> handles;
    if (known_.live.empty()) return {};
    for (std::size_t i = rng_.one_in(3) ? rng_.below(known_.live.size() + 1) : 1; i > 0; --i)
      handles.insert(any_handle());
    return {handles.begin(), handles.end()};
  }

  static HandlePair ordered(Handle a, Handle b) {
    return a.slot < b.slot ? HandlePair{a, b} : HandlePair{b, a};
  }

  Filter any_filter() {
    if (rng_.one_in(2)) return {};
    return {
        .category = rng_.one_in(2) ? 1U : 2U, .mask = rng_.one_in(2) ? 1U : 3U, .is_static = rng_.one_in(4)};
  }

  bool attempt(const auto& call) {
    is_owed_ = true;
    return injector_.attempt(call);
  }

  std::string check_size() const {
    if (world_->size() != known_.live.size()) return "a call that threw has changed the number of boxes";
    for (const auto& [handle, live] : known_.live) {
      if (!world_->contains(handle) || world_->box(handle) != live.box)
        return "a box is not what it was set to";
      if (world_->filter(handle) != live.filter) return "a filter is not what it was set to";
    }
    return "";
  }

  std::string add(std::size_t count) {
    std::vector<Box<D, Real>> boxes(count);
    for (Box<D, Real>& box : boxes) box = any_box();
    std::vector<BoxOptions> options(rng_.one_in(2) ? count : 0);
    for (BoxOptions& its : options) its.filter = any_filter();
    std::vector<Handle> handles(count);
    if (count == 1 && rng_.one_in(2)) {
      if (!attempt([&] { handles[0] = world_->add(boxes[0], options.empty() ? BoxOptions{} : options[0]); }))
        return check_size();
    } else if (!attempt([&] { world_->add(boxes, handles, options); })) {
      return check_size();
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (!known_.live.emplace(handles[i], Live{boxes[i], options.empty() ? Filter{} : options[i].filter})
               .second)
        return "a new box has another one's handle";
    }
    return check_size();
  }

  std::string move() {
    const std::vector<Handle> handles = some_handles();
    if (handles.empty()) return "";
    std::vector<Box<D, Real>> boxes(handles.size());
    for (Box<D, Real>& box : boxes) box = any_box();
    const bool is_one = handles.size() == 1 && rng_.one_in(2);
    if (attempt([&] { is_one ? world_->move(handles[0], boxes[0]) : world_->move(handles, boxes); })) {
      for (std::size_t i = 0; i < handles.size(); ++i) known_.live[handles[i]].box = boxes[i];
    }
    return check_size();
  }

  std::string remove() {
    const std::vector<Handle> handles = some_handles();
    if (handles.empty()) return "";
    const bool is_one = handles.size() == 1 && rng_.one_in(2);
    if (!attempt([&] { is_one ? world_->remove(handles[0]) : world_->remove(handles); })) return check_size();
    for (const Handle handle : handles) {
      known_.live.erase(handle);
      std::erase_if(known_.ignored,
                    [&](const HandlePair& pair) { return pair.first == handle || pair.second == handle; });
    }
    return check_size();
  }

  std::string set_filter() {
    if (known_.live.empty()) return "";
    const Handle handle = any_handle();
    const Filter filter = any_filter();
    if (attempt([&] { world_->set_filter(handle, filter); })) known_.live[handle].filter = filter;
    return check_size();
  }

  std::string ignore() {
    if (known_.live.size() < 2) return "";
    const Handle a = any_handle();
    const Handle b = any_handle();
    if (a == b) return "";
    const bool is_new = rng_.one_in(2);
    if (attempt([&] { is_new ? world_->ignore(a, b) : world_->unignore(a, b); })) {
      if (is_new)
        known_.ignored.insert(ordered(a, b));
      else
        known_.ignored.erase(ordered(a, b));
    }
    return world_->is_ignored(b, a) == known_.ignored.contains(ordered(a, b)) ? ""
                                                                              : "a pair is ignored wrongly";
  }

  /// The predicate depends on the pair alone, so that it does not matter when it is asked.
  std::string change_predicate() {
    const std::uint32_t phase = static_cast<std::uint32_t>(rng_.below(4));
    if (rng_.one_in(2)) {
      attempt([&] { world_->refilter(); });
      return "";
    }
    PairPredicate predicate;
    if (phase < 3) predicate = [phase](Handle a, Handle b) { return (a.slot + b.slot) % 3 != phase; };
    if (attempt([&] { world_->set_predicate(predicate); })) known_.phase = phase;
    return "";
  }

  std::string query() {
    const Box<D, Real> box = any_box();
    std::set<Handle> found;
    if (!attempt([&] { static_cast<void>(world_->box_index()); })) return "";
    world_->overlapping(box, [&](Handle handle) { found.insert(handle); });
    for (const auto& [handle, live] : known_.live) {
      if (overlap(box, live.box) != found.contains(handle))
        return "a query has not found the boxes that overlap";
    }
    return "";
  }

  /// Asks for what can be asked between updates, and for memory to be given back.
  std::string look_back() {
    if (rng_.one_in(3)) attempt([&] { world_->shrink_to_fit(); });
    if (attempt([&] { static_cast<void>(world_->pairs()); })) {
      if (std::string text = compare("the pairs", world_->pairs(), known_.pairs); !text.empty()) return text;
    }
    if (attempt([&] { static_cast<void>(world_->persisting()); }))
      return compare("persisting", world_->persisting(), known_.persisting);
    std::vector<std::byte> bytes;
    if (attempt([&] { bytes = world_->snapshot(); }) && bytes != world_->snapshot())
      return "a snapshot differs from the next";
    return "";
  }

  /// Keeps what there is, or restores what was kept. That must be right after failed updates as well; whether
  /// restore() itself may fail is tested elsewhere.
  std::string go_back() {
    if (!kept_ || kept_->known.phase != known_.phase || rng_.one_in(2)) {
      kept_ = Kept{known_, world_->snapshot()};
      return "";
    }
    world_->restore(kept_->bytes);
    known_ = kept_->known;
    is_owed_ = true;
    return check_size();
  }

  std::string update() {
    std::optional<Events> events;
    if (!attempt([&] { events = world_->update(); })) return check_size();
    is_owed_ = false;
    Pairs now;
    for (auto a = known_.live.begin(); a != known_.live.end(); ++a) {
      for (auto b = std::next(a); b != known_.live.end(); ++b) {
        if (!overlap(a->second.box, b->second.box) || !accepts(a->second.filter, b->second.filter)) continue;
        if (known_.phase < 3 && (a->first.slot + b->first.slot) % 3 == known_.phase) continue;
        if (!known_.ignored.contains({a->first, b->first})) now.push_back({a->first, b->first});
      }
    }
    Pairs begun;
    Pairs ended;
    known_.persisting.clear();
    std::ranges::set_difference(now, known_.pairs, std::back_inserter(begun));
    std::ranges::set_difference(known_.pairs, now, std::back_inserter(ended));
    std::ranges::set_intersection(now, known_.pairs, std::back_inserter(known_.persisting));
    known_.pairs = std::move(now);
    if (std::string text = compare("begun", events->begun, begun); !text.empty()) return text;
    return compare("ended", events->ended, ended);
  }

  static std::string compare(const char* what, std::span<const HandlePair> found, const Pairs& expected) {
    if (std::ranges::equal(found, expected)) return "";
    return std::string(what) + ": " + std::to_string(found.size()) + " pairs are not the " +
           std::to_string(expected.size()) + " expected";
  }

  Rng rng_;
  std::size_t max_boxes_;
  Injector& injector_;
  std::optional<World<D, Real>> world_;
  Known known_;
  std::optional<Kept> kept_;
  bool is_owed_ = false;  // something was done since the last whole update
};

TEST(WorldFailureExample, KeepsItsFiltersWhereSettingOneFails) {
  bool has_failed = true;
  for (std::uint64_t number = 0; has_failed; ++number) {
    World2 world;
    const Handle handle = world.add({{0, 0}, {1, 1}});
    world.add({{0, 0}, {1, 1}});
    static_cast<void>(world.update());
    world.shrink_to_fit();
    const std::vector<std::byte> before = world.snapshot();
    has_failed = false;
    try {
      const FailingAllocation failing(number, FailureKind::once);
      world.set_filter(handle, {.category = 2});
    } catch (const std::bad_alloc&) {
      has_failed = true;
    }
    EXPECT_EQ(world.snapshot() == before, has_failed) << "allocation " << number;
  }
}

TEST(WorldFailureExample, TellsWhatAFailedUpdateOwesOfMovedBoxesAndIgnoredPairs) {
  for (std::uint64_t k = 0, failures = 1; failures > 0; ++k) {
    World2 world;
    const Box2 near{{0, 0}, {1, 1}};
    const Handle a = world.add(near);
    const Handle b = world.add(near);
    world.add({{5, 5}, {6, 6}});
    world.update();
    const Handle c = world.add(near);
    world.move(a, {{5, 5}, {6, 6}});
    world.ignore(b, c);
    Injector injector(k, FailureKind::once);
    Events events;
    while (!injector.attempt([&] { events = world.update(); })) {
    }
    EXPECT_EQ(events.begun.size(), 1U) << "allocation " << k;
    EXPECT_EQ(events.ended.size(), 1U) << "allocation " << k;
    failures = injector.failures();
  }
}

TEST(WorldFailureExample, WritesASnapshotThatCanBeRestoredAfterAFailedUpdate) {
  for (const WorldOptions& options : {WorldOptions{}, WorldOptions{.shadow = true}}) {
    for (std::uint64_t k = 0, failures = 1; failures > 0; ++k) {
      World2 world(options);
      const Box2 near{{0, 0}, {1, 1}};
      const Handle a = world.add(near);
      world.add(near);
      world.update();
      world.move(a, {{5, 5}, {6, 6}});
      world.add(near);
      Injector injector(k, FailureKind::once);
      if (injector.attempt([&] { world.update(); })) world.move(a, near);
      failures = injector.failures();
      World2 restored(options);
      restored.restore(world.snapshot());
      const Events expected = world.update();
      const Events events = restored.update();
      EXPECT_TRUE(std::ranges::equal(events.begun, expected.begun)) << "allocation " << k;
      EXPECT_TRUE(std::ranges::equal(events.ended, expected.ended)) << "allocation " << k;
    }
  }
}

class WorldFailure : public MemoryTest {
 protected:
  /// Plays histories with each allocation failing, and many with some failing at random.
  template <int D, typename Real>
  void check(const WorldOptions& options) {
    std::uint64_t failures = 0;
    const std::int64_t blocks = blocks_held();
    std::string text;
    const auto run = [&](std::size_t steps, std::size_t max_boxes, std::uint64_t seed, Injector injector) {
      Model<D, Real> model(options, max_boxes, seed, injector);
      text.clear();
      for (std::size_t i = 0; text.empty() && i < steps; ++i) text = model.act();
      if (text.empty()) text = model.end();
      failures += injector.failures();
      return injector.failures() > 0;
    };
    for (const FailureKind kind : {FailureKind::once, FailureKind::from_then_on}) {
      for (std::uint64_t k = 0; run(30, 8, 1, {k, kind}); k = next_number(k))
        ASSERT_EQ(text, "") << "allocation " << k;
    }
    for (std::uint64_t seed = 0; seed < 2 * random_histories(); ++seed) {
      run(60, seed % 5 == 0 ? 200 : 12, seed, Injector(seed));
      ASSERT_EQ(text, "") << "seed " << seed;
    }
    text = {};
    ASSERT_EQ(blocks_held(), blocks) << "leaks";
    RecordProperty("failures", std::to_string(failures));
  }
};

TEST_P(WorldFailure, CanTryAgain) {
  in_case([&]<int D, typename Real>() { check<D, Real>({.algorithm = algorithm().name}); });
}

TEST_P(WorldFailure, CanTryAgainWithAMargin) {
  in_case([&]<int D, typename Real>() { check<D, Real>({.algorithm = algorithm().name, .margin = 0.75}); });
}

TEST_P(WorldFailure, IsNotAccusedByItsShadow) {
  in_case([&]<int D, typename Real>() { check<D, Real>({.algorithm = algorithm().name, .shadow = true}); });
}

INSTANTIATE_TEST_SUITE_P(Library, WorldFailure, testing::ValuesIn(memory_cases()), case_name);

}  // namespace
}  // namespace broadside::laws
