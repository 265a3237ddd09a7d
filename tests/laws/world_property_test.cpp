// World against its model as a property: RapidCheck looks for histories that break it, and makes them small.
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "broadside/world.hpp"

#include "generators.hpp"
#include "law_case.hpp"
#include "tests/support/world_history.hpp"

namespace broadside::laws {
namespace {

/// A world of some kind, with margins or without.
WorldOptions any_options(Choices& choices) {
  WorldOptions options;
  if (choices.one_in(2)) options.margin = 0.75;
  if (choices.one_in(2)) options.relative_margin = 0.25;
  if (choices.one_in(2)) options.predicted_frames = 2;
  const bool has_margin = options.margin > 0 || options.relative_margin > 0 || options.predicted_frames > 0;
  if (has_margin && choices.one_in(2)) options.events = WorldEvents::enlarged;
  if (choices.one_in(3)) options.touching = false;
  if (choices.one_in(4)) options.bad_input = BadInput::quarantine;
  return options;
}

class WorldProperty : public Law {
 protected:
  template <int D>
  bool holds(const std::function<Box<D>(Choices&)>& box) const {
    return rc::check("a world over " + name(GetParam()) + " knows what its model knows", [&] {
      const std::vector<std::uint8_t> bytes = *rc::gen::scale(6, drawn_bytes()).as("choices");
      ByteChoices choices(bytes);
      WorldCourse<D> course;
      course.options = any_options(choices);
      course.box = box;
      course.has_predicate = choices.one_in(2);
      course.predicate_throws = choices.one_in(4);
      course.tells = true;
      course.make = [&] { return World<D>(Tracker<D>(algorithm(), spec()), course.options); };
      WorldHistory<D> history(choices, course);
      while (!choices.is_spent()) {
        const std::size_t what = choices.below(16);
        if (what < 11)
          history.change();
        else if (what < 14)
          history.update();
        else if (what == 14)
          history.look();
        else
          history.go_back();
        history.check();
      }
    });
  }
};

TEST_P(WorldProperty, HoldsForBoxesOnALattice) {
  in_dimension([&]<int D>() {
    EXPECT_TRUE(holds<D>([](Choices& choices) { return random_box<D>(choices, {8, 3, 0}); }));
  });
}

TEST_P(WorldProperty, HoldsForAnyBoxes) {
  in_dimension([&]<int D>() { EXPECT_TRUE(holds<D>(box_of_any_floats<D>)); });
}

// A world adds nothing to a peer but what it adds to our own trackers.
INSTANTIATE_TEST_SUITE_P(Catalogue, WorldProperty, testing::ValuesIn(law_cases_without_peers()), case_name);

}  // namespace
}  // namespace broadside::laws
