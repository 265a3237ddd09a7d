// The law as properties: RapidCheck looks for boxes and histories that break it, and makes them small.
//
// ctest runs them with one seed, so that they pass or fail alike everywhere. Run laws_tests itself for
// another seed each time, which it prints.
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "filtered_frames.hpp"
#include "generators.hpp"
#include "hard_inputs.hpp"
#include "lab/verify/verify.hpp"
#include "law_case.hpp"
#include "strained_specs.hpp"

namespace broadside::laws {

/// One frame of a generated history: how long the array is, and what changes in it.
template <int D>
struct GeneratedFrame {
  int size;
  std::vector<std::pair<int, Box<D>>> changes;  ///< places counted beyond the array's end start over
};

template <int D>
void showValue(const GeneratedFrame<D>& frame, std::ostream& out) {
  out << "\n  " << frame.size << " boxes; changed: ";
  rc::show(frame.changes, out);
}

namespace {

template <int D>
rc::Gen<GeneratedFrame<D>> frame(const rc::Gen<Box<D>>& box) {
  return rc::gen::construct<GeneratedFrame<D>>(
      rc::gen::inRange(0, 20), rc::gen::resize(20, rc::gen::container<std::vector<std::pair<int, Box<D>>>>(
                                                       rc::gen::pair(rc::gen::inRange(0, 20), box))));
}

/// The history that starts without a box and goes through `frames`.
template <int D>
lab::History<D> history_of(const std::vector<GeneratedFrame<D>>& frames) {
  lab::History<D> history;
  std::size_t known = 0;
  for (const GeneratedFrame<D>& frame : frames) {
    const auto size = static_cast<std::size_t>(frame.size);
    lab::Step<D> step{.size = size, .changed = {}, .boxes = {}};
    const std::size_t places = std::max(size, known);
    for (const auto& [place, box] : frame.changes) {
      if (places == 0) break;
      step.changed.push_back(BoxId(std::size_t(place) % places));
      step.boxes.push_back(box);
    }
    known = size;
    history.steps.push_back(std::move(step));
  }
  return history;
}

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
  bool finders_hold(const rc::Gen<Box<D>>& box) const {
    return rc::check(name(GetParam()) + " finds each overlapping pair once", [&] {
      auto boxes = *rc::gen::scale(2, rc::gen::container<std::vector<Box<D>>>(box)).as("boxes");
      keep_to_limits(boxes);
      const Spec strained = *rc::gen::elementOf(specs());
      for (const Spec& tried : {spec(), strained}) {
        Finder<D> finder(algorithm(), tried);
        if (const auto divergence = lab::check_finder<D>(finder, boxes, tried.text()))
          RC_FAIL(divergence->text);
      }
    });
  }

  template <int D>
  bool trackers_hold(const rc::Gen<Box<D>>& box) const {
    return rc::check(name(GetParam()) + " gives each event once", [&] {
      const auto frames = *rc::gen::container<std::vector<GeneratedFrame<D>>>(frame(box)).as("frames");
      const auto seed = *rc::gen::arbitrary<std::uint8_t>().as("the filters' seed");
      const Spec strained = *rc::gen::elementOf(specs());
      for (const Spec& tried : {spec(), strained}) {
        Tracker<D> tracker(algorithm(), tried);
        const auto divergence = lab::check_tracker<D>(tracker, history_of(frames), tried.text());
        if (divergence) RC_FAIL(divergence->text);
        const auto filtered = with_filters(whole_frames(history_of(frames)), seed);
        Tracker<D> filtered_tracker(algorithm(), tried);
        const std::string text = laws::divergence<D, float>(filtered_tracker, filtered);
        if (!text.empty()) RC_FAIL(tried.text() + ", with filters: " + text);
      }
    });
  }
};

TEST_P(Property, FindsThePairsOfBoxesOnALattice) {
  in_dimension([&]<int D>() { EXPECT_TRUE(finders_hold<D>(lattice_box<D>())); });
}

TEST_P(Property, FindsThePairsOfAnyBoxes) {
  in_dimension([&]<int D>() { EXPECT_TRUE(finders_hold<D>(any_box<D>())); });
}

TEST_P(Property, TracksBoxesOnALattice) {
  in_dimension([&]<int D>() { EXPECT_TRUE(trackers_hold<D>(lattice_box<D>())); });
}

class AnyBoxProperty : public Property {};

TEST_P(AnyBoxProperty, TracksAnyBoxes) {
  in_dimension([&]<int D>() { EXPECT_TRUE(trackers_hold<D>(any_box<D>())); });
}

INSTANTIATE_TEST_SUITE_P(Catalogue, Property, testing::ValuesIn(law_cases()), case_name);
INSTANTIATE_TEST_SUITE_P(Catalogue, AnyBoxProperty, testing::ValuesIn(law_cases_if(takes_any_boxes)),
                         case_name);

}  // namespace
}  // namespace broadside::laws
