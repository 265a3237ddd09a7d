// The scalar model that kernels and structures are held to: boxes drawn at random, and what they overlap by
// definition.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"
#include "broadside/sinks.hpp"

#include "core/moved_box.hpp"
#include "tests/support/boxes.hpp"
#include "tests/support/drawn_boxes.hpp"
#include "tests/support/instruction_sets.hpp"

namespace broadside {

/// Calls `body.operator()<D>()` for 2 and 3 dimensions.
template <typename Body>
void in_each_dimension(Body body) {
  body.template operator()<2>();
  body.template operator()<3>();
}

/// The same on every instruction set that the processor has.
template <typename Body>
void on_each_instruction_set(Body body) {
  for (const std::string& name : instruction_sets()) {
    const OnInstructionSet chosen(name);
    ASSERT_EQ(instruction_set(), name);
    SCOPED_TRACE(name);
    in_each_dimension(body);
    if (testing::Test::HasFailure()) return;
  }
}

inline Pair ordered(std::size_t a, std::size_t b) { return {BoxId(std::min(a, b)), BoxId(std::max(a, b))}; }

/// The overlapping pairs in order; between the first `left_count` boxes and the others if it is not 0.
template <int D, typename Real>
std::vector<Pair> overlapping_pairs(const std::vector<Box<D, Real>>& boxes, std::size_t left_count = 0) {
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t j = std::max(i + 1, left_count); j < boxes.size(); ++j) {
      if ((left_count == 0 || i < left_count) && overlap(boxes[i], boxes[j])) pairs.push_back(ordered(i, j));
    }
  }
  return pairs;
}

/// What `search(sink)` writes, as it comes.
template <typename Search>
std::vector<Pair> written_pairs(Search search) {
  std::vector<Pair> pairs;
  PairCollector collector(pairs);
  search(static_cast<PairSink&>(collector));
  collector.flush();
  return pairs;
}

/// The same in order.
template <typename Search>
std::vector<Pair> sorted_pairs(Search search) {
  std::vector<Pair> pairs = written_pairs(search);
  std::ranges::sort(pairs);
  return pairs;
}

/// A box that changes, as the interface makes it. A box that was or is absent is nan_box().
template <int D>
core::MovedBox<D> moved_box(std::size_t id, const Box<D>& before, const Box<D>& now,
                            bool filter_changed = false) {
  core::MovedBox<D> moved{.before = before,
                          .now = now,
                          .bounds = is_present(before) ? before : now,
                          .id = BoxId(id),
                          .was_present = is_present(before),
                          .is_present = is_present(now),
                          .filter_changed = filter_changed};
  for (int axis = 0; axis < D && is_present(now); ++axis) {
    moved.bounds.min[axis] = std::min(moved.bounds.min[axis], now.min[axis]);
    moved.bounds.max[axis] = std::max(moved.bounds.max[axis], now.max[axis]);
  }
  return moved;
}

/// What moved boxes change.
struct Changes {
  std::set<Pair> begun;
  std::set<Pair> ended;
  std::set<Pair> candidates;

  friend bool operator==(const Changes&, const Changes&) = default;

  /// Adds what one moved box changes with `others`, by id, where boxes that move are marked in `moves`.
  template <int D>
  void add(const core::MovedBox<D>& moved, std::span<const Box<D>> others,
           const std::vector<std::uint8_t>& moves) {
    for (std::size_t other = 0; other < others.size(); ++other) {
      if (other == index(moved.id)) continue;
      const bool was = overlap(moved.before, others[other]);
      const bool is = overlap(moved.now, others[other]);
      const Pair pair = ordered(index(moved.id), other);
      if (moved.filter_changed && (was || is))
        candidates.insert(pair);
      else if (was != is)
        (moves[other] != 0 ? candidates : is ? begun : ended).insert(pair);
    }
  }
};

/// What `find(sinks)` writes.
template <typename Find>
Changes written_changes(const std::vector<std::uint8_t>& moves, Find find) {
  std::vector<Pair> begun;
  std::vector<Pair> ended;
  std::vector<Pair> candidates;
  PairCollector to_begun(begun);
  PairCollector to_ended(ended);
  PairCollector to_candidates(candidates);
  find(core::ChangeSinks{to_begun, to_ended, to_candidates, moves.data()});
  for (PairCollector* sink : {&to_begun, &to_ended, &to_candidates}) sink->flush();
  const auto set_of = [](const std::vector<Pair>& pairs) {
    std::set<Pair> set;
    for (const Pair pair : pairs) set.insert(ordered(index(pair.first), index(pair.second)));
    return set;
  };
  return {set_of(begun), set_of(ended), set_of(candidates)};
}

}  // namespace broadside
