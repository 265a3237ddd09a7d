// The law of trackers: after any history, exactly the events, each once.
#include <vector>

#include <gtest/gtest.h>

#include "histories.hpp"
#include "law_case.hpp"
#include "smallest_failure.hpp"
#include "whole_frames.hpp"

namespace broadside::laws {
namespace {

class TrackerLaw : public Law {};

TEST_P(TrackerLaw, GivesEachEventOnce) {
  in_dimension([&]<int D>() {
    for (const NamedHistory<D>& named : hard_histories<D>(algorithm()))
      EXPECT_TRUE(tracks_the_pairs<D>(algorithm(), spec(), named.history)) << named.name;
  });
}

TEST_P(TrackerLaw, GivesEachEventOnceWithFiltersAndIgnoredPairs) {
  in_dimension([&]<int D>() {
    std::uint64_t seed = 0;
    for (const NamedHistory<D>& named : hard_histories<D>(algorithm())) {
      EXPECT_TRUE(tracks_the_frames<D>(algorithm(), spec(), with_filters(named.history, ++seed)))
          << named.name;
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Catalogue, TrackerLaw, testing::ValuesIn(law_cases()), case_name);

}  // namespace
}  // namespace broadside::laws
