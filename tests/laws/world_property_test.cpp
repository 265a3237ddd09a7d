// World against a model: whatever is done to it, it knows what a map from handles to boxes would know.
#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "broadside/error.hpp"
#include "broadside/world.hpp"

#include "generators.hpp"
#include "hard_inputs.hpp"
#include "law_case.hpp"

namespace broadside::laws {

enum class Action { add, move, remove, update, use_a_removed_one };

template <int D>
struct Command {
  Action action;
  std::uint32_t which;  ///< of the boxes it can be done to, counted round and round
  Box<D> box;           ///< for add and move
};

template <int D>
void showValue(const Command<D>& command, std::ostream& out) {
  constexpr std::array names = {"add", "move", "remove", "update", "use a removed one"};
  out << "\n  " << names[static_cast<std::size_t>(command.action)];
  if (command.action != Action::add && command.action != Action::update) out << " " << command.which;
  if (command.action == Action::add || command.action == Action::move) {
    out << " ";
    showValue(command.box, out);
  }
}

namespace {

template <int D>
rc::Gen<Command<D>> command(const rc::Gen<Box<D>>& box) {
  const auto action = rc::gen::weightedElement<Action>({{5, Action::add},
                                                        {4, Action::move},
                                                        {3, Action::remove},
                                                        {3, Action::update},
                                                        {1, Action::use_a_removed_one}});
  return rc::gen::construct<Command<D>>(action, rc::gen::inRange<std::uint32_t>(0, 30), box);
}

/// A world and what it must know.
template <int D>
class Model {
 public:
  explicit Model(std::unique_ptr<PairTracker<D>> tracker) : world_(std::move(tracker)) {}

  void run(const Command<D>& command) {
    switch (command.action) {
      case Action::add:
        if (!is_absent(command.box)) add(command.box);
        break;
      case Action::move:
        if (!live_.empty() && !is_absent(command.box)) {
          const Handle handle = live_handle(command.which);
          world_.move(handle, command.box);
          live_[handle] = command.box;
        }
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
    }
    RC_ASSERT(world_.size() == live_.size());
  }

  /// Looks at everything the world can be asked.
  void check() const {
    for (const auto& [handle, box] : live_) {
      RC_ASSERT(world_.contains(handle));
      RC_ASSERT(world_.box(handle) == box);
    }
    for (const auto& [handle, removal] : removed_) {
      RC_ASSERT(!world_.contains(handle));
      // Readable until the update after the one that reported the removal.
      if (removal.updates < 2)
        RC_ASSERT(world_.box(handle) == removal.box);
      else
        RC_ASSERT_THROWS_AS(world_.box(handle), InvalidHandle);
    }
  }

 private:
  struct Removal {
    Box<D> box;
    int updates = 0;  ///< since it was removed
  };

  Handle live_handle(std::uint32_t which) const {
    return std::next(live_.begin(), which % live_.size())->first;
  }

  void add(const Box<D>& box) {
    const Handle handle = world_.add(box);
    RC_ASSERT(!live_.contains(handle));
    RC_ASSERT(!removed_.contains(handle));
    live_[handle] = box;
  }

  void remove(Handle handle) {
    world_.remove(handle);
    removed_[handle] = {live_.at(handle)};
    live_.erase(handle);
  }

  void use_removed(std::uint32_t which) {
    const Handle handle = std::next(removed_.begin(), which % removed_.size())->first;
    RC_ASSERT_THROWS_AS(world_.move(handle, Box<D>{}), InvalidHandle);
    RC_ASSERT_THROWS_AS(world_.remove(handle), InvalidHandle);
  }

  void update() {
    const std::vector<HandlePair> before = pairs_;
    pairs_.clear();
    for (auto a = live_.begin(); a != live_.end(); ++a) {
      for (auto b = std::next(a); b != live_.end(); ++b) {
        if (overlap(a->second, b->second)) pairs_.push_back({a->first, b->first});
      }
    }
    std::vector<HandlePair> begun;
    std::vector<HandlePair> ended;
    std::ranges::set_difference(pairs_, before, std::back_inserter(begun));
    std::ranges::set_difference(before, pairs_, std::back_inserter(ended));
    const Events events = world_.update();
    RC_ASSERT(std::ranges::equal(events.begun, begun));
    RC_ASSERT(std::ranges::equal(events.ended, ended));
    RC_ASSERT(std::ranges::equal(world_.pairs(), pairs_));
    for (auto& [handle, removal] : removed_) ++removal.updates;
  }

  World<D> world_;
  std::map<Handle, Box<D>> live_;
  std::map<Handle, Removal> removed_;
  std::vector<HandlePair> pairs_;
};

class WorldProperty : public Law {
 protected:
  template <int D>
  bool holds(const rc::Gen<Box<D>>& box) const {
    return rc::check("a world over " + name(GetParam()) + " knows what its model knows", [&] {
      const auto commands = *rc::gen::container<std::vector<Command<D>>>(command(box)).as("commands");
      Model<D> model(make_tracker<D>(algorithm(), spec()));
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

TEST_P(WorldProperty, HoldsForAnyBoxes) {
  if (!takes_any_floats(algorithm())) GTEST_SKIP() << algorithm().name << " does not take any boxes";
  in_dimension([&]<int D>() { EXPECT_TRUE(holds<D>(any_box<D>())); });
}

INSTANTIATE_TEST_SUITE_P(Catalogue, WorldProperty, testing::ValuesIn(law_cases()), case_name);

}  // namespace
}  // namespace broadside::laws
