// The law of bad input under quarantine: invalid boxes count as absent and are named, whatever the algorithm,
// in float and double. That they are refused otherwise is in failure_law_test.cpp.
#include <algorithm>
#include <limits>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/error.hpp"
#include "broadside/sinks.hpp"

#include "lab/verify/verify.hpp"
#include "law_case.hpp"
#include "tests/support/rng.hpp"

namespace broadside::laws {
namespace {

template <int D, typename Real>
Box<D, Real> any_box(Rng& rng) {
  Box<D, Real> box;
  for (int axis = 0; axis < D; ++axis) {
    box.min[axis] = rng.between(0, 8);
    box.max[axis] = box.min[axis] + rng.between(0, 2);
  }
  return box;
}

/// One that is wrong on one axis, in one of the ways there are.
template <int D, typename Real>
Box<D, Real> wrong_box(Rng& rng) {
  constexpr Real infinity = std::numeric_limits<Real>::infinity();
  constexpr Real nan = std::numeric_limits<Real>::quiet_NaN();
  Box<D, Real> box = any_box<D, Real>(rng);
  const int axis = rng.whole(0, D - 1);
  switch (rng.below(7)) {
    case 0:
      box.min[axis] = nan;
      break;
    case 1:
      box.max[axis] = nan;
      break;
    case 2:
      box.min[axis] = box.max[axis] = nan;
      break;
    case 3:
      box.max[axis] = box.min[axis] - 1;
      break;
    case 4:
      box.min[axis] = infinity;
      box.max[axis] = -infinity;
      break;
    case 5:
      box.min[axis] = -nan;
      box.max[axis] = infinity;
      break;
    default:
      box.min.fill(nan);
      box.max.fill(nan);
  }
  return box;
}

template <int D, typename Real>
bool is_wrong(const Box<D, Real>& box) {
  return !is_present(box) && !is_absent(box);
}

template <int D, typename Real>
std::vector<BoxId> wrong_places(const Boxes<D, Real>& boxes) {
  std::vector<BoxId> places;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (is_wrong(boxes[i])) places.push_back(BoxId(i));
  }
  return places;
}

template <int D, typename Real>
Boxes<D, Real> without_wrong(Boxes<D, Real> boxes) {
  std::ranges::replace_if(boxes, is_wrong<D, Real>, absent_box<D, Real>());
  return boxes;
}

template <int D, typename Real>
Boxes<D, Real> some_boxes(Rng& rng, std::size_t count) {
  Boxes<D, Real> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    boxes.push_back(rng.one_in(12)  ? absent_box<D, Real>()
                    : rng.one_in(6) ? wrong_box<D, Real>(rng)
                                    : any_box<D, Real>(rng));
  }
  return boxes;
}

std::vector<BoxId> listed(std::span<const BoxId> ids) { return {ids.begin(), ids.end()}; }

/// Takes nothing.
class FailingSink final : public PairSink {
 private:
  void consume(std::span<const Pair>) override { throw std::runtime_error("full"); }
};

class BadInputLaw : public Law {
 protected:
  template <typename Body>
  static void in_dimension_and_precision(Body body) {
    in_dimension([&]<int D>() {
      body.template operator()<D, float>();
      body.template operator()<D, double>();
    });
  }
};

TEST_P(BadInputLaw, AFinderPairsNothingWithWhatItQuarantines) {
  in_dimension_and_precision([&]<int D, typename Real>() {
    Finder<D, Real> finder(algorithm(), spec());
    finder.set_bad_input(BadInput::quarantine);
    Rng rng(31);
    for (const std::size_t count : {0, 1, 5, 60, 400}) {
      const auto boxes = some_boxes<D, Real>(rng, count);
      std::vector<Pair> pairs;
      PairCollector collector(pairs);
      finder.find(boxes, collector);
      EXPECT_FALSE(lab::compare_pairs(pairs, lab::reference_pairs<D, Real>(without_wrong<D, Real>(boxes))));
      EXPECT_EQ(listed(finder.quarantined()), (wrong_places<D, Real>(boxes)));
    }
    const Boxes<D, Real> right(3);
    PairCounter counter;
    finder.find(right, counter);
    EXPECT_TRUE(finder.quarantined().empty());
    const Boxes<D, Real> wrong = {wrong_box<D, Real>(rng)};
    finder.set_bad_input(BadInput::reject);
    EXPECT_THROW(finder.find(wrong, counter), InvalidInput);
  });
}

TEST_P(BadInputLaw, AJoinPairsNothingWithWhatItQuarantines) {
  in_dimension_and_precision([&]<int D, typename Real>() {
    Finder<D, Real> finder(algorithm(), spec());
    finder.set_bad_input(BadInput::quarantine);
    Rng rng(32);
    const auto boxes = some_boxes<D, Real>(rng, 120);
    std::vector<Pair> expected;
    for (const Pair pair : lab::reference_pairs<D, Real>(without_wrong<D, Real>(boxes))) {
      if (index(pair.first) < 50 && index(pair.second) >= 50)
        expected.push_back({pair.first, BoxId(index(pair.second) - 50)});
    }
    std::vector<Pair> pairs;
    PairCollector collector(pairs);
    finder.find_across(boxes, 50, collector);
    EXPECT_FALSE(lab::compare_pairs(pairs, expected));
    EXPECT_EQ(listed(finder.quarantined()), (wrong_places<D, Real>(boxes)));
  });
}

TEST_P(BadInputLaw, ATrackerHoldsWhatItQuarantinesForAbsent) {
  in_dimension_and_precision([&]<int D, typename Real>() {
    Tracker<D, Real> tracker(algorithm(), spec());
    tracker.set_bad_input(BadInput::quarantine);
    Rng rng(33);
    Boxes<D, Real> boxes = some_boxes<D, Real>(rng, 80);
    std::vector<Pair> held;
    std::vector<BoxId> changed;
    std::vector<BoxId> quarantined;
    for (std::size_t frame = 0; frame < reduced(60, 1); ++frame) {
      std::vector<Pair> begun;
      std::vector<Pair> ended;
      PairCollector begun_pairs(begun);
      PairCollector ended_pairs(ended);
      bool taken = true;
      if (rng.one_in(5)) {
        FailingSink failing;
        try {
          tracker.update({boxes, changed}, failing, failing);
        } catch (const std::runtime_error&) {
          taken = false;
        }
      } else {
        tracker.update({boxes, changed}, begun_pairs, ended_pairs);
      }
      if (taken) {
        std::vector<Pair> now = lab::reference_pairs<D, Real>(without_wrong<D, Real>(boxes));
        const auto difference =
            lab::check_events<D, Real>(begun, ended, held, now, algorithm().name, frame, boxes);
        ASSERT_FALSE(difference) << difference->text;
        held = std::move(now);
        quarantined = wrong_places<D, Real>(boxes);
      }
      ASSERT_EQ(listed(tracker.quarantined()), quarantined) << "frame " << frame;

      changed.clear();
      const std::size_t known = boxes.size();
      if (rng.one_in(4)) boxes.resize(rng.below(100), wrong_box<D, Real>(rng));
      for (std::size_t count = boxes.empty() ? 0 : rng.below(30); count > 0; --count) {
        const std::size_t place = rng.below(boxes.size());
        boxes[place] = some_boxes<D, Real>(rng, 1)[0];
        if (place < known) changed.push_back(BoxId(place));
      }
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Catalogue, BadInputLaw, testing::ValuesIn(law_cases_without_peers()), case_name);

}  // namespace
}  // namespace broadside::laws
