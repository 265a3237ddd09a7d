// World against a model: whatever is done to it, it knows what a map from handles to boxes would know.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "broadside/error.hpp"
#include "broadside/world.hpp"

#include "generators.hpp"
#include "hard_inputs.hpp"
#include "law_case.hpp"

namespace broadside::laws {

enum class Action {
  add,
  add_many,
  move,
  move_two,
  move_on,
  remove,
  update,
  use_a_removed_one,
  filter,
  ignore,
  unignore,
  change_the_predicate,
  shrink
};

template <int D>
struct Command {
  Action action;
  std::uint32_t which;  ///< of the boxes it can be done to, counted round and round
  std::uint32_t other;  ///< likewise, where it takes two; else a choice
  Box<D> box;           ///< for what takes a box
};

template <int D>
void showValue(const Command<D>& command, std::ostream& out) {
  constexpr std::array names = {"add",     "add many", "move",     "move two",
                                "move on", "remove",   "update",   "use a removed one",
                                "filter",  "ignore",   "unignore", "change the predicate",
                                "shrink"};
  out << "\n  " << names[static_cast<std::size_t>(command.action)] << " " << command.which << " "
      << command.other << " ";
  showValue(command.box, out);
}

namespace {

/// What kind of world.
struct WorldKind {
  std::uint32_t margins;  ///< a bit each: margin, relative margin, predicted frames, enlarged events
  bool has_predicate;

  WorldOptions options() const {
    WorldOptions options;
    if ((margins & 1) != 0) options.margin = 0.75;
    if ((margins & 2) != 0) options.relative_margin = 0.25;
    if ((margins & 4) != 0) options.predicted_frames = 2;
    if (margins > 8) options.events = WorldEvents::enlarged;
    return options;
  }
};

template <int D>
rc::Gen<Command<D>> command(const rc::Gen<Box<D>>& box) {
  const auto action = rc::gen::weightedElement<Action>({{5, Action::add},
                                                        {1, Action::add_many},
                                                        {4, Action::move},
                                                        {1, Action::move_two},
                                                        {2, Action::move_on},
                                                        {3, Action::remove},
                                                        {4, Action::update},
                                                        {1, Action::use_a_removed_one},
                                                        {2, Action::filter},
                                                        {2, Action::ignore},
                                                        {1, Action::unignore},
                                                        {1, Action::change_the_predicate},
                                                        {1, Action::shrink}});
  const auto number = rc::gen::inRange<std::uint32_t>(0, 30);
  return rc::gen::construct<Command<D>>(action, number, number, box);
}

/// A world and what it must know.
template <int D>
class Model {
 public:
  Model(Tracker<D> tracker, WorldKind kind)
      : options_(kind.options()), world_(std::move(tracker), options_), has_predicate_(kind.has_predicate) {
    if (has_predicate_)
      world_.set_predicate([this](Handle first, Handle second) { return accepts_now(first, second); });
  }

  void run(const Command<D>& command) {
    const bool has_box = !is_absent(command.box);
    switch (command.action) {
      case Action::add:
        if (has_box) add(command);
        break;
      case Action::add_many:
        if (has_box) add_many(command);
        break;
      case Action::move:
        if (live_.empty() || !has_box) break;
        world_.move(live_handle(command.which), command.box);
        set(live_[live_handle(command.which)], command.box);
        break;
      case Action::move_two:
        if (!live_.empty() && has_box) move_two(command);
        break;
      case Action::move_on:
        if (!live_.empty() && has_box) move_on(command);
        break;
      case Action::remove:
        if (!live_.empty()) remove(live_handle(command.which));
        break;
      case Action::update:
        update();
        break;
      case Action::use_a_removed_one:
        if (!removed_.empty()) use_removed(command.which);
        break;
      case Action::filter:
        if (live_.empty()) break;
        world_.set_filter(live_handle(command.which), filter(command.other));
        live_[live_handle(command.which)].filter = filter(command.other);
        break;
      case Action::ignore:
      case Action::unignore:
        if (!live_.empty()) ignore(command);
        break;
      case Action::change_the_predicate:
        if (!live_.empty()) change_predicate(command);
        break;
      case Action::shrink:
        world_.shrink_to_fit();
        break;
    }
    RC_ASSERT(world_.size() == live_.size());
  }

  /// Looks at everything the world can be asked.
  void check() const {
    for (const auto& [handle, its] : live_) {
      RC_ASSERT(world_.contains(handle));
      RC_ASSERT(world_.box(handle) == its.box);
      RC_ASSERT(world_.filter(handle) == its.filter);
      RC_ASSERT(world_.user_data(handle) == its.user_data);
      RC_ASSERT(world_.enlarged_box(handle) == its.enlarged);
    }
    for (const auto& [handle, removal] : removed_) {
      RC_ASSERT(!world_.contains(handle));
      // Readable until the update after the one that reported the removal.
      if (removal.updates < 2)
        RC_ASSERT(world_.box(handle) == removal.box);
      else
        RC_ASSERT_THROWS_AS(static_cast<void>(world_.box(handle)), InvalidHandle);
    }
    RC_ASSERT(world_.statistics().pairs == pairs_.size());
    RC_ASSERT(world_.statistics().ignored_pairs == ignored_.size());
  }

 private:
  struct Live {
    Box<D> box;
    Filter filter;
    std::uint64_t user_data = 0;
    Box<D> enlarged = absent_box<D>();
  };

  struct Removal {
    Box<D> box;
    int updates = 0;  ///< since it was removed
  };

  static Filter filter(std::uint32_t choice) {
    switch (choice % 5) {
      case 0:
        return {.category = 2};
      case 1:
        return {.mask = 1};
      case 2:
        return {.is_static = true};
      case 3:
        return {.group = choice % 2 == 0 ? 1 : -1};
      default:
        return {};
    }
  }

  bool meet(const Live& a, const Live& b) const {
    return options_.events == WorldEvents::exact ? overlap(a.box, b.box) : overlap(a.enlarged, b.enlarged);
  }

  static HandlePair ordered(Handle a, Handle b) {
    return a.slot < b.slot ? HandlePair{a, b} : HandlePair{b, a};
  }

  bool accepts_now(Handle first, Handle second) const { return (first.slot + second.slot) % 3 != phase_; }

  Handle live_handle(std::uint32_t which) const {
    return std::next(live_.begin(), which % live_.size())->first;
  }

  void add(const Command<D>& command) {
    const Live live{command.box, filter(command.other), command.which};
    take(world_.add(live.box, {.filter = live.filter, .user_data = live.user_data}), live);
  }

  void add_many(const Command<D>& command) {
    const std::vector<Box<D>> boxes(command.which % 4, command.box);
    std::vector<Handle> handles(boxes.size());
    world_.add(boxes, handles);
    for (const Handle handle : handles) take(handle, {command.box, {}, 0});
  }

  void take(Handle handle, const Live& live) {
    RC_ASSERT(!live_.contains(handle));
    RC_ASSERT(!removed_.contains(handle));
    live_[handle] = live;
    set(live_[handle], live.box);
  }

  float margin_of(const Box<D>& box) const {
    const auto margin = static_cast<float>(options_.margin);
    if (options_.relative_margin == 0) return margin;
    float longest = 0;
    for (int axis = 0; axis < D; ++axis) {
      const float side = box.max[axis] - box.min[axis];
      if (std::isfinite(side) && side > longest) longest = side;
    }
    const float share = static_cast<float>(options_.relative_margin) * longest;
    return margin == 0 || share < margin ? share : margin;
  }

  /// Keeps the enlarged box while it contains the box and is at most six margins and the way ahead longer.
  void set(Live& live, const Box<D>& box, const Point<D>& velocity = {}) const {
    live.box = box;
    const float margin = margin_of(box);
    Box<D> wanted = box;
    for (int axis = 0; axis < D; ++axis) {
      const float way = static_cast<float>(options_.predicted_frames) * velocity[axis];
      wanted.min[axis] = box.min[axis] - margin + std::min(way, 0.0F);
      wanted.max[axis] = box.max[axis] + margin + std::max(way, 0.0F);
    }
    const Box<D>& kept = live.enlarged;
    for (int axis = 0; axis < D; ++axis) {
      const float most = box.max[axis] - box.min[axis] + 6 * margin +
                         std::abs(static_cast<float>(options_.predicted_frames) * velocity[axis]);
      if (kept.min[axis] > box.min[axis] || kept.max[axis] < box.max[axis] ||
          kept.max[axis] - kept.min[axis] > most) {
        live.enlarged = wanted;
        return;
      }
    }
  }

  void move_two(const Command<D>& command) {
    const std::vector<Handle> handles = {live_handle(command.which), live_handle(command.other)};
    world_.move(handles, std::vector<Box<D>>{live_[handles[1]].box, command.box});
    const Box<D> first = live_[handles[1]].box;
    set(live_[handles[0]], first);
    set(live_[handles[1]], command.box);
  }

  void move_on(const Command<D>& command) {
    const Handle handle = live_handle(command.which);
    Point<D> velocity;
    for (int axis = 0; axis < D; ++axis)
      velocity[axis] = static_cast<float>((command.other >> axis) % 4) / 2 - 0.5F;
    if (options_.predicted_frames == 0) {
      RC_ASSERT_THROWS_AS(world_.move(handle, command.box, velocity), std::logic_error);
      return;
    }
    if (command.other % 2 == 0)
      world_.move(handle, command.box, velocity);
    else
      world_.move(std::vector{handle}, std::vector{command.box}, std::vector{velocity});
    set(live_[handle], command.box, velocity);
  }

  void remove(Handle handle) {
    world_.remove(handle);
    removed_[handle] = {live_.at(handle).box};
    live_.erase(handle);
    std::erase_if(ignored_,
                  [handle](const HandlePair& pair) { return pair.first == handle || pair.second == handle; });
  }

  void use_removed(std::uint32_t which) {
    const Handle handle = std::next(removed_.begin(), which % removed_.size())->first;
    RC_ASSERT_THROWS_AS(world_.move(handle, Box<D>{}), InvalidHandle);
    RC_ASSERT_THROWS_AS(world_.remove(handle), InvalidHandle);
    RC_ASSERT_THROWS_AS(world_.set_filter(handle, {}), InvalidHandle);
  }

  void ignore(const Command<D>& command) {
    const Handle a = live_handle(command.which);
    const Handle b = live_handle(command.other);
    if (a == b) return;
    if (command.action == Action::ignore) {
      world_.ignore(a, b);
      ignored_.insert(ordered(a, b));
    } else {
      world_.unignore(a, b);
      ignored_.erase(ordered(a, b));
    }
    RC_ASSERT(world_.is_ignored(b, a) == ignored_.contains(ordered(a, b)));
  }

  void change_predicate(const Command<D>& command) {
    if (!has_predicate_) return;
    phase_ = command.other % 4;
    const Handle handle = live_handle(command.which);
    if (command.other % 2 == 0) {
      world_.refilter();
      answers_.clear();
    } else {
      world_.refilter(handle);
      std::erase_if(answers_, [handle](const auto& answer) {
        return answer.first.first == handle || answer.first.second == handle;
      });
    }
  }

  void update() {
    const std::vector<HandlePair> before = pairs_;
    const std::map<HandlePair, bool> old_answers = std::move(answers_);
    pairs_.clear();
    answers_.clear();
    for (auto a = live_.begin(); a != live_.end(); ++a) {
      for (auto b = std::next(a); b != live_.end(); ++b) {
        const HandlePair pair{a->first, b->first};
        if (!meet(a->second, b->second) || !accepts(a->second.filter, b->second.filter) ||
            ignored_.contains(pair))
          continue;
        const auto old = old_answers.find(pair);
        const bool is_accepted =
            !has_predicate_ ||
            (old != old_answers.end() ? old->second : accepts_now(pair.first, pair.second));
        answers_[pair] = is_accepted;
        if (is_accepted) pairs_.push_back(pair);
      }
    }
    std::vector<HandlePair> begun;
    std::vector<HandlePair> ended;
    std::vector<HandlePair> persisting;
    std::ranges::set_difference(pairs_, before, std::back_inserter(begun));
    std::ranges::set_difference(before, pairs_, std::back_inserter(ended));
    std::ranges::set_intersection(before, pairs_, std::back_inserter(persisting));
    const Events events = world_.update();
    RC_ASSERT(std::ranges::equal(events.begun, begun));
    RC_ASSERT(std::ranges::equal(events.ended, ended));
    // Not always, so that events of several updates wait to be taken in.
    if (++updates_ % 3 != 0) {
      RC_ASSERT(std::ranges::equal(world_.persisting(), persisting));
      RC_ASSERT(std::ranges::equal(world_.pairs(), pairs_));
      std::vector<std::uint8_t> flags(pairs_.size());
      world_.overlaps(pairs_, flags);
      for (std::size_t i = 0; i < pairs_.size(); ++i) {
        const bool overlaps = overlap(live_.at(pairs_[i].first).box, live_.at(pairs_[i].second).box);
        RC_ASSERT((flags[i] == 1) == overlaps);
      }
    }
    for (auto& [handle, removal] : removed_) ++removal.updates;
  }

  WorldOptions options_;
  World<D> world_;
  bool has_predicate_;
  std::uint32_t phase_ = 0;
  int updates_ = 0;
  std::map<Handle, Live> live_;
  std::map<Handle, Removal> removed_;
  std::set<HandlePair> ignored_;
  std::map<HandlePair, bool> answers_;  // of the predicate, about pairs that overlapped in the last update
  std::vector<HandlePair> pairs_;
};

class WorldProperty : public Law {
 protected:
  template <int D>
  bool holds(const rc::Gen<Box<D>>& box) const {
    return rc::check("a world over " + name(GetParam()) + " knows what its model knows", [&] {
      const WorldKind kind{*rc::gen::inRange<std::uint32_t>(0, 16).as("margins"),
                           *rc::gen::arbitrary<bool>().as("predicate")};
      const auto commands = *rc::gen::container<std::vector<Command<D>>>(command(box)).as("commands");
      Model<D> model(Tracker<D>(algorithm(), spec()), kind);
      for (const Command<D>& command : commands) {
        model.run(command);
        model.check();
      }
    });
  }
};

TEST_P(WorldProperty, HoldsForBoxesOnALattice) {
  in_dimension([&]<int D>() { EXPECT_TRUE(holds<D>(lattice_box<D>())); });
}

class AnyBoxWorldProperty : public WorldProperty {};

TEST_P(AnyBoxWorldProperty, HoldsForAnyBoxes) {
  in_dimension([&]<int D>() { EXPECT_TRUE(holds<D>(any_box<D>())); });
}

// A world adds nothing to a peer but what it adds to our own trackers.
INSTANTIATE_TEST_SUITE_P(Catalogue, WorldProperty, testing::ValuesIn(law_cases_without_peers()), case_name);
INSTANTIATE_TEST_SUITE_P(Catalogue, AnyBoxWorldProperty, testing::ValuesIn(law_cases_without_peers()),
                         case_name);

}  // namespace
}  // namespace broadside::laws
