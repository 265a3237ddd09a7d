// The law of trackers: after any history, exactly the events, each once.
#include <vector>

#include <gtest/gtest.h>

#include "histories.hpp"
#include "law_case.hpp"
#include "smallest_failure.hpp"

namespace broadside::laws {
namespace {

class TrackerLaw : public Law {};

TEST_P(TrackerLaw, GivesEachEventOnce) {
  in_dimension([&]<int D>() {
    for (const NamedHistory<D>& named : hard_histories<D>(algorithm()))
      EXPECT_TRUE(tracks_the_pairs<D>(algorithm(), spec(), named.history)) << named.name;
  });
}

INSTANTIATE_TEST_SUITE_P(Catalogue, TrackerLaw, testing::ValuesIn(law_cases()), case_name);

}  // namespace
}  // namespace broadside::laws
