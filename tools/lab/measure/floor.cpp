// The lower bound of a search's time ("floor" in results): a sort, a gather and writing the pairs, timed
// beside the searches.
#include "lab/measure/floor.hpp"

#include <bit>

namespace broadside::lab {
namespace {

constexpr int digits = 3;
constexpr int digit_bits = 11;
constexpr std::size_t buckets = std::size_t{1} << digit_bits;

constexpr std::size_t digit(std::uint64_t key, int at) {
  return key >> (32 + at * digit_bits) & (buckets - 1);
}

/// Maps a float to an integer with the same order; -0.0 and 0.0 map to the same one.
std::uint32_t sort_key(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value + 0.0F);
  return bits ^ (static_cast<std::uint32_t>(static_cast<std::int32_t>(bits) >> 31) | 0x80000000U);
}

}  // namespace

template <int D>
void Floor<D>::run(std::span<const Box<D>> boxes, std::span<Pair> pairs) {
  sort(boxes);
  for (auto& bound : bounds_) bound.resize(boxes.size());
  const std::uint64_t* const keys = keys_.data();
  std::array<float*, 2 * D> bounds;
  for (int i = 0; i < 2 * D; ++i) bounds[i] = bounds_[i].data();
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Box<D>& box = boxes[static_cast<std::uint32_t>(keys[i])];
    for (int axis = 0; axis < D; ++axis) {
      bounds[axis][i] = box.min[axis];
      bounds[D + axis][i] = box.max[axis];
    }
  }
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto id = static_cast<std::uint32_t>(i);
    pairs[i] = {BoxId{id}, BoxId{id + 1}};
  }
}

template <int D>
void Floor<D>::sort(std::span<const Box<D>> boxes) {
  keys_.resize(boxes.size());
  other_.resize(boxes.size());
  std::array<std::array<std::uint32_t, buckets>, digits> places{};
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const std::uint64_t key = std::uint64_t{sort_key(boxes[i].min[0])} << 32 | i;
    keys_[i] = key;
    for (int at = 0; at < digits; ++at) ++places[at][digit(key, at)];
  }
  for (int at = 0; at < digits; ++at) {
    std::uint32_t begin = 0;
    for (std::uint32_t& place : places[at]) {
      const std::uint32_t count = place;
      place = begin;
      begin += count;
    }
    std::uint64_t* const to = other_.data();
    for (const std::uint64_t key : keys_) to[places[at][digit(key, at)]++] = key;
    keys_.swap(other_);
  }
}

template <int D>
std::vector<std::uint32_t> Floor<D>::order() const {
  std::vector<std::uint32_t> places;
  for (const std::uint64_t key : keys_) places.push_back(static_cast<std::uint32_t>(key));
  return places;
}

template class Floor<2>;
template class Floor<3>;

}  // namespace broadside::lab
