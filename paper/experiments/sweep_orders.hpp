// The order of a sweep by itself, disturbed on purpose and mended: what section VI-C of the paper is about.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadside/box.hpp"

#include "lab/measure/benchmark.hpp"
#include "lab/measure/samples.hpp"
#include "lab/scenes/random.hpp"

namespace broadside::lab {

/// A box in a sweep's order: by where it begins, and of equal ones by id.
struct SweptBox {
  float min = 0;
  std::uint32_t id = 0;

  friend bool operator<(const SweptBox& a, const SweptBox& b) {
    return a.min < b.min || (a.min == b.min && a.id < b.id);
  }
  friend bool operator==(const SweptBox&, const SweptBox&) = default;
};

/// Sorts by insertion and returns by how many places boxes were moved: the number of pairs in wrong order.
std::uint64_t sort_by_insertion(std::vector<SweptBox>& boxes);

/// Sorts as section VI-C has it: all are in a heap, and the least is taken until none is left.
void sort_by_heap(std::vector<SweptBox>& boxes, std::vector<SweptBox>& heap);

/// Boxes of one size along an axis, sorted; as many a length as in a plane, however many there are.
std::vector<SweptBox> order_of(std::size_t count, Random& random);

/// A box that leaves one place of the order for another.
struct Reinsertion {
  SweptBox from;
  SweptBox to;
};

/// Of `count` different boxes of the order, which has as many: each goes a fifth of its size, or anywhere.
std::vector<Reinsertion> reinsertions(const std::vector<SweptBox>& order, std::size_t count, bool is_near,
                                      Random& random);

/// What reinsertions come to in all.
struct Work {
  std::uint64_t comparisons = 0;
  std::uint64_t places = 0;
};

/// The two binary searches of each reinsertion, and nothing moved.
Work search_only(const std::vector<SweptBox>& order, const std::vector<Reinsertion>& all);

/// One reinsertion after the other by binary search; the order stays sorted.
Work reinsert(std::vector<SweptBox>& order, const std::vector<Reinsertion>& all);

/// The median milliseconds of `run`, done `times` times on a copy of `boxes`.
template <typename Run>
double sorting_ms(std::span<const SweptBox> boxes, std::size_t times, const Run& run) {
  std::vector<double> samples;
  std::vector<SweptBox> copy;
  for (std::size_t time = 0; time < times; ++time) {
    copy.assign(boxes.begin(), boxes.end());
    const Stopwatch watch;
    run(copy);
    samples.push_back(watch.milliseconds());
  }
  return median(samples);
}

}  // namespace broadside::lab
