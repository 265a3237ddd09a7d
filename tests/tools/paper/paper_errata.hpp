// What the tests of the errata share: small boxes, a record of the printed listings' tests, and the mended
// algorithms on the same input.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/sinks.hpp"

#include "lab/verify/verify.hpp"
#include "paper/listings/printed.hpp"

namespace broadside::paper {

inline constexpr float infinity = std::numeric_limits<float>::infinity();

inline Box2 box(float min_x, float min_y, float max_x, float max_y) {
  return {{min_x, min_y}, {max_x, max_y}};
}

/// The boxes as objects numbered from 0.
inline printed::Collection objects(const std::vector<Box2>& boxes) {
  printed::Collection objects;
  for (std::size_t i = 0; i < boxes.size(); ++i) objects.push_back({BoxId(i), boxes[i]});
  return objects;
}

/// A TEST COLLIDE that remembers what it was handed.
class Record {
 public:
  printed::TestCollide sink() {
    return [this](const printed::Object& a, const printed::Object& b) {
      tests_.emplace_back(std::min(index(a.id), index(b.id)), std::max(index(a.id), index(b.id)));
    };
  }

  std::size_t size() const { return tests_.size(); }

  /// How often the objects a <= b were tested against each other.
  std::size_t times(std::uint32_t a, std::uint32_t b) const {
    return static_cast<std::size_t>(std::ranges::count(tests_, std::pair(a, b)));
  }

 private:
  std::vector<std::pair<std::uint32_t, std::uint32_t>> tests_;
};

/// Expects `run` to end in a read past the end by the listing of that name.
template <typename Run>
void expect_past_the_end(std::string_view listing, Run run) {
  try {
    run();
    ADD_FAILURE() << listing << " reads nothing past an end";
  } catch (const std::out_of_range& error) {
    EXPECT_THAT(error.what(), testing::StartsWith(std::string(listing) + ", "));
  }
}

/// Expects the mended algorithm to find exactly the pairs of `boxes`, each once; returns what it counted.
inline Statistics expect_right(std::string_view spec, const std::vector<Box2>& boxes) {
  Finder<2> finder(spec);
  const auto divergence = lab::check_finder<2>(finder, boxes, spec);
  EXPECT_FALSE(divergence) << divergence->text;
  PairCounter pairs;
  return finder.find(boxes, pairs).value_or(Statistics{});
}

}  // namespace broadside::paper
