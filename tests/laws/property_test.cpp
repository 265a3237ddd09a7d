// The law as properties: RapidCheck looks for boxes and histories that break it, and makes them small.
//
// ctest runs them with one seed, so that they pass or fail alike everywhere. Run laws_tests itself for
// another seed each time, which it prints.
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "broadside/debug/history.hpp"

#include "drawn_frames.hpp"
#include "generators.hpp"
#include "hard_inputs.hpp"
#include "lab/verify/verify.hpp"
#include "law_case.hpp"
#include "smallest_failure.hpp"
#include "strained_specs.hpp"
#include "tests/support/drawn_boxes.hpp"

namespace broadside::laws {
namespace {

class Property : public Law {
 protected:
  /// `boxes` without those that are beyond the algorithm's declared limits.
  template <int D>
  void keep_to_limits(std::vector<Box<D>>& boxes) const {
    std::erase_if(boxes, [&](const Box<D>& box) { return is_beyond(algorithm(), box); });
  }

  /// The algorithm's specs: with nothing set, and with each tunable strained.
  std::vector<Spec> specs() const {
    std::vector<Spec> all = strained_specs(GetParam());
    all.push_back(spec());
    return all;
  }

  template <int D>
  bool finders_hold(bool on_lattice) const {
    return rc::check(name(GetParam()) + " finds each overlapping pair once", [&] {
      const std::vector<std::uint8_t> bytes = *rc::gen::scale(8, drawn_bytes()).as("choices");
      ByteChoices choices(bytes);
      std::vector<Box<D>> boxes;
      while (!choices.is_spent()) {
        boxes.push_back(on_lattice ? random_box<D>(choices, {8, 3, 0}) : box_of_any_floats<D>(choices));
        if (choices.one_in(10)) boxes.back() = absent_box<D>();
      }
      keep_to_limits(boxes);
      const Spec strained = *rc::gen::elementOf(specs());
      for (const Spec& tried : {spec(), strained}) {
        Finder<D> finder(algorithm(), tried);
        if (const auto divergence = lab::check_finder<D>(finder, boxes, tried.text()))
          RC_FAIL(divergence->text + "\n" + text_of(History<D>{boxes, {}}));
      }
    });
  }

  template <int D>
  bool trackers_hold(const std::vector<Coordinates>& kinds) const {
    return rc::check(name(GetParam()) + " gives each event once", [&] {
      const std::vector<std::uint8_t> bytes = *rc::gen::scale(4, drawn_bytes()).as("choices");
      ByteChoices choices(bytes);
      FrameCourse course{.boxes = choices.below(20), .changes = 20, .resize_one_in = 4, .sweep_one_in = 6};
      course.coordinates = choices.one_of<Coordinates>(kinds);
      course.has_filters = choices.one_in(2);
      std::vector<WholeFrame<D>> frames = draw_frames<D>(choices, course);
      for (WholeFrame<D>& frame : frames)
        std::ranges::replace_if(
            frame.boxes, [&](const Box<D>& box) { return is_beyond(algorithm(), box); }, absent_box<D>());
      const Spec strained = *rc::gen::elementOf(specs());
      for (const Spec& tried : {spec(), strained}) {
        const testing::AssertionResult result = tracks_the_frames<D>(algorithm(), tried, frames);
        if (!result) RC_FAIL(result.message());
      }
    });
  }
};

TEST_P(Property, FindsThePairsOfBoxesOnALattice) {
  in_dimension([&]<int D>() { EXPECT_TRUE(finders_hold<D>(true)); });
}

TEST_P(Property, FindsThePairsOfAnyBoxes) {
  in_dimension([&]<int D>() { EXPECT_TRUE(finders_hold<D>(false)); });
}

TEST_P(Property, TracksBoxesOnALattice) {
  in_dimension([&]<int D>() { EXPECT_TRUE(trackers_hold<D>({Coordinates::whole, Coordinates::halves})); });
}

class AnyBoxProperty : public Property {};

TEST_P(AnyBoxProperty, TracksAnyBoxes) {
  in_dimension([&]<int D>() { EXPECT_TRUE(trackers_hold<D>({Coordinates::any})); });
}

INSTANTIATE_TEST_SUITE_P(Catalogue, Property, testing::ValuesIn(law_cases()), case_name);
INSTANTIATE_TEST_SUITE_P(Catalogue, AnyBoxProperty, testing::ValuesIn(law_cases_if(takes_any_boxes)),
                         case_name);

}  // namespace
}  // namespace broadside::laws
