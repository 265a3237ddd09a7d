// The scalar model that kernels and structures are compared with: random boxes, and their overlaps by
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
#include "tests/support/instruction_sets.hpp"
#include "tests/support/rng.hpp"

namespace broadside {

/// Calls `body.operator()<D>()` for 2 and 3 dimensions.
template <typename Body>
void in_each_dimension(Body body) {
  body.template operator()<2>();
  body.template operator()<3>();
}

/// The same on every instruction set that the processor supports.
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

/// How random boxes are generated: on a lattice, so that they touch and coincide.
struct BoxKind {
  int places = 60;  ///< minima are whole numbers below this one
  int max_extent = 10;
  std::size_t infinite_one_in = 40;  ///< fraction of infinite sides, one in this many; 0: none
};

template <int D>
Box<D> random_box(Rng& rng, const BoxKind& kind = {}) {
  const auto is_infinite = [&] { return kind.infinite_one_in != 0 && rng.one_in(kind.infinite_one_in); };
  Box<D> box;
  for (int axis = 0; axis < D; ++axis) {
    box.min[axis] = static_cast<float>(rng.whole(0, kind.places - 1));
    box.max[axis] = box.min[axis] + static_cast<float>(rng.whole(0, kind.max_extent));
    if (is_infinite()) box.min[axis] = -infinity;
    if (is_infinite()) box.max[axis] = infinity;
  }
  return box;
}

template <int D>
std::vector<Box<D>> random_boxes(Rng& rng, std::size_t count, const BoxKind& kind = {}) {
  std::vector<Box<D>> boxes(count);
  for (Box<D>& box : boxes) box = random_box<D>(rng, kind);
  return boxes;
}

/// Doubles that round to the box's floats, so that touching boxes may be apart in double precision.
template <int D>
Box<D, double> near_double(Rng& rng, const Box<D>& box) {
  // Offsets by at most half the distance to the next float, and by more than a double's precision.
  const auto near = [&rng](float value) {
    return std::isinf(value) ? value : value + rng.whole(-1, 1) * 0x1p-40 * std::max(1.0F, std::abs(value));
  };
  Box<D, double> doubles;
  for (int axis = 0; axis < D; ++axis) {
    doubles.min[axis] = near(box.min[axis]);
    doubles.max[axis] = std::max(doubles.min[axis], near(box.max[axis]));
  }
  return doubles;
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

/// The output of `search(sink)`, in its order.
template <typename Search>
std::vector<Pair> written_pairs(Search search) {
  std::vector<Pair> pairs;
  PairCollector collector(pairs);
  search(static_cast<PairSink&>(collector));
  collector.flush();
  return pairs;
}

/// The same, sorted.
template <typename Search>
std::vector<Pair> sorted_pairs(Search search) {
  std::vector<Pair> pairs = written_pairs(search);
  std::ranges::sort(pairs);
  return pairs;
}

/// A changed box, in the form that the interface uses. A box that was or is absent is nan_box().
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

/// Events of moved boxes.
struct Changes {
  std::set<Pair> begun;
  std::set<Pair> ended;
  std::set<Pair> candidates;

  friend bool operator==(const Changes&, const Changes&) = default;

  /// Adds the events of one moved box with `others`, by id; `moves` marks the boxes that move.
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

/// The output of `find(sinks)`.
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
