// The law of trackers: after any history, exactly the events, each once.
#include <algorithm>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/sinks.hpp"

#include "drawn_frames.hpp"
#include "law_case.hpp"
#include "smallest_failure.hpp"
#include "strained_specs.hpp"
#include "tracker_histories.hpp"

namespace broadside::laws {
namespace {

class TrackerLaw : public Law {};

/// What is asked of our own trackers only: peers take no strain, and do not say their bytes.
class OwnTrackerLaw : public Law {};

TEST_P(TrackerLaw, GivesEachEventOnce) {
  in_dimension([&]<int D>() {
    for (const NamedFrames<D>& named : drawn_histories<D>(algorithm()))
      EXPECT_TRUE(tracks_the_frames<D>(algorithm(), spec(), named.frames)) << named.name;
  });
}

TEST_P(TrackerLaw, GivesEachEventOnceWithFiltersAndIgnoredPairs) {
  in_dimension([&]<int D>() {
    std::uint64_t seed = 0;
    for (const NamedFrames<D>& named : drawn_histories<D>(algorithm()))
      EXPECT_TRUE(tracks_the_frames<D>(algorithm(), spec(), with_filters(named.frames, ++seed)))
          << named.name;
  });
}

TEST_P(TrackerLaw, GivesEachEventOnceInScriptedHistories) {
  in_dimension([&]<int D>() {
    std::uint64_t seed = 100;
    for (const NamedFrames<D>& named : scripted_histories<D>(algorithm())) {
      EXPECT_TRUE(tracks_the_frames<D>(algorithm(), spec(), named.frames)) << named.name;
      if (!is_own(GetParam())) continue;  // on others the interface puts filters
      EXPECT_TRUE(tracks_the_frames<D>(algorithm(), spec(), with_filters(named.frames, ++seed)))
          << named.name << ", with filters";
    }
  });
}

TEST_P(OwnTrackerLaw, GivesEachEventOnceWithEveryTunableStrained) {
  in_dimension([&]<int D>() {
    const std::vector<NamedFrames<D>> histories = scripted_histories<D>(algorithm());
    std::uint64_t seed = 200;
    for (const Spec& strained : strained_specs(GetParam())) {
      for (const NamedFrames<D>& named : histories) {
        // A third of them for each value, and others for the next.
        if (++seed % 3 != 0) continue;
        EXPECT_TRUE(tracks_the_frames<D>(algorithm(), strained,
                                         seed % 2 == 0 ? named.frames : with_filters(named.frames, seed)))
            << named.name;
      }
    }
  });
}

TEST_P(OwnTrackerLaw, GivesEachEventOnceOfThousandsOfBoxes) {
  in_dimension([&]<int D>() {
    EXPECT_TRUE(tracks_the_frames<D>(algorithm(), spec(), large_history<D>(reduced(3000))));
    EXPECT_TRUE(
        tracks_the_frames<D>(algorithm(), spec(), with_filters(large_history<D>(reduced(1000)), 1500)));
  });
}

TEST_P(OwnTrackerLaw, DoesNotGrowWhileHistoriesRepeatThemselves) {
  in_dimension([&]<int D>() {
    for (const NamedFrames<D>& named : scripted_histories<D>(algorithm())) {
      Tracker<D> tracker(algorithm(), spec());
      std::vector<BoxId> all(named.frames.front().boxes.size());
      for (std::size_t i = 0; i < all.size(); ++i) all[i] = BoxId(i);
      const auto play = [&] {
        PairCounter counter;
        for (const WholeFrame<D>& frame : named.frames) {
          all.resize(std::max(all.size(), frame.boxes.size()));
          for (std::size_t i = 0; i < all.size(); ++i) all[i] = BoxId(i);
          const auto count = std::min(all.size(), frame.boxes.size());
          tracker.update({frame.boxes, std::span(all).first(count)}, counter, counter);
        }
        return tracker.bytes();
      };
      // What is kept for coming and going settles in some ten plays, and by then trackers that choose have
      // chosen.
      std::size_t settled = 0;
      for (int time = 0; time < 12; ++time) settled = play();
      std::size_t last = 0;
      for (int time = 0; time < 4; ++time) last = play();
      EXPECT_LE(last, settled) << named.name;
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Catalogue, TrackerLaw, testing::ValuesIn(law_cases()), case_name);
INSTANTIATE_TEST_SUITE_P(Catalogue, OwnTrackerLaw, testing::ValuesIn(law_cases_if(is_own)), case_name);

}  // namespace
}  // namespace broadside::laws
