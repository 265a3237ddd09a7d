// Orders of a sweep: made, disturbed and mended.
#include "paper/experiments/sweep_orders.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace broadside::lab {
namespace {

/// The first place of a box that is not before `wanted`: a binary search, its comparisons counted.
std::size_t place_of(const std::vector<SweptBox>& order, const SweptBox& wanted, std::uint64_t& comparisons) {
  std::size_t low = 0;
  for (std::size_t count = order.size(); count > 0;) {
    const std::size_t half = count / 2;
    const bool is_behind = order[low + half] < wanted;
    low = is_behind ? low + half + 1 : low;
    count = is_behind ? count - half - 1 : half;
    ++comparisons;
  }
  return low;
}

/// Where the box is and where it goes; of a box that goes up, its own place is not counted.
std::pair<std::size_t, std::size_t> way(const std::vector<SweptBox>& order, const Reinsertion& reinsertion,
                                        Work& work) {
  const std::size_t from = place_of(order, reinsertion.from, work.comparisons);
  const std::size_t to = place_of(order, reinsertion.to, work.comparisons);
  return {from, to > from ? to - 1 : to};
}

}  // namespace

std::uint64_t sort_by_insertion(std::vector<SweptBox>& boxes) {
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

void sort_by_heap(std::vector<SweptBox>& boxes, std::vector<SweptBox>& heap) {
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

std::vector<SweptBox> order_of(std::size_t count, Random& random) {
  const double side = std::sqrt(static_cast<double>(count));
  std::vector<SweptBox> order;
  for (std::uint32_t i = 0; i < count; ++i) order.push_back({static_cast<float>(random.between(0, side)), i});
  std::sort(order.begin(), order.end());
  return order;
}

std::vector<Reinsertion> reinsertions(const std::vector<SweptBox>& order, std::size_t count, bool is_near,
                                      Random& random) {
  const double side = std::sqrt(static_cast<double>(order.size()));
  std::vector<std::size_t> places(order.size());
  for (std::size_t i = 0; i < places.size(); ++i) places[i] = i;
  random.shuffle(places, count);
  std::vector<Reinsertion> all;
  for (std::size_t i = 0; i < count; ++i) {
    const SweptBox box = order[places[i]];
    const double there = is_near ? std::clamp<double>(box.min + 0.2 * random.direction<2>()[0], 0, side)
                                 : random.between(0, side);
    all.push_back({box, {static_cast<float>(there), box.id}});
  }
  return all;
}

Work search_only(const std::vector<SweptBox>& order, const std::vector<Reinsertion>& all) {
  Work work;
  for (const Reinsertion& reinsertion : all) {
    const auto [from, to] = way(order, reinsertion, work);
    work.places += from < to ? to - from : from - to;
  }
  return work;
}

Work reinsert(std::vector<SweptBox>& order, const std::vector<Reinsertion>& all) {
  Work work;
  for (const Reinsertion& reinsertion : all) {
    const auto [from, to] = way(order, reinsertion, work);
    SweptBox* const boxes = order.data();
    if (from < to)
      std::memmove(boxes + from, boxes + from + 1, (to - from) * sizeof(SweptBox));
    else
      std::memmove(boxes + to + 1, boxes + to, (from - to) * sizeof(SweptBox));
    boxes[to] = reinsertion.to;
    work.places += from < to ? to - from : from - to;
  }
  return work;
}

}  // namespace broadside::lab
