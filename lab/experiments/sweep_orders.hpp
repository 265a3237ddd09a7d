// The order of a sweep by itself, disturbed on purpose and mended: what section VI-C of the paper is about.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "broadside/box.hpp"

#include "lab/measure/contest.hpp"
#include "lab/measure/samples.hpp"

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
inline std::uint64_t sort_by_insertion(std::vector<SweptBox>& boxes) {
  std::uint64_t places = 0;
  for (std::size_t i = 1; i < boxes.size(); ++i) {
    const SweptBox box = boxes[i];
    std::size_t at = i;
    for (; at > 0 && box < boxes[at - 1]; --at) boxes[at] = boxes[at - 1];
    boxes[at] = box;
    places += i - at;
  }
  return places;
}

/// Sorts as section VI-C has it: all are in a heap, and the least is taken until none is left.
inline void sort_by_heap(std::vector<SweptBox>& boxes, std::vector<SweptBox>& heap) {
  const auto is_later = [](const SweptBox& a, const SweptBox& b) { return b < a; };
  heap.swap(boxes);
  boxes.clear();
  std::make_heap(heap.begin(), heap.end(), is_later);
  while (!heap.empty()) {
    std::pop_heap(heap.begin(), heap.end(), is_later);
    boxes.push_back(heap.back());
    heap.pop_back();
  }
}

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
