// An algorithm's search held to the definition.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"

#include "tests/support/model.hpp"

namespace broadside::algorithm {

/// Expects each overlapping pair once, within one set and between two. Returns what the search within one
/// did.
template <int D>
std::optional<Statistics> expect_definition(const Spec& spec, const std::vector<Box<D>>& boxes) {
  SCOPED_TRACE(spec.text() + ", " + std::to_string(boxes.size()) + " boxes");
  Finder<D> finder{spec};
  std::optional<Statistics> statistics;
  EXPECT_EQ(sorted_pairs([&](PairSink& sink) { statistics = finder.find(boxes, sink); }),
            overlapping_pairs(boxes));
  const std::size_t left_count = boxes.size() / 3;
  if (left_count > 0) {
    std::vector<Pair> expected = overlapping_pairs(boxes, left_count);
    for (Pair& pair : expected)
      pair.second = BoxId(index(pair.second) - left_count);  // its place on the right
    EXPECT_EQ(sorted_pairs([&](PairSink& sink) { finder.find_across(boxes, left_count, sink); }), expected);
  }
  return statistics;
}

}  // namespace broadside::algorithm
