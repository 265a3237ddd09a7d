// DoubleSearch: rounds boxes of doubles, and tests pairs that touch in double.
#include "find/double_search.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <utility>

#include "core/rounding.hpp"
#include "kernels/overlap_flags.hpp"

namespace broadside::find {
namespace {

/// Up to this many boxes have few pairs, false ones included.
constexpr std::size_t few_boxes = 256;

/// Boxes that are rounded, looked at and hashed while a core's cache holds them.
constexpr std::size_t boxes_at_once = 256;

}  // namespace

template <int D>
void DoubleSearch<D>::ExactSink::consume(std::span<const Pair> pairs) {
  while (!pairs.empty()) {
    const std::span<const Pair> some = pairs.first(std::min(pairs.size(), PairSink::max_room));
    std::array<std::uint8_t, PairSink::max_room> overlaps;
    kernels::set_overlap_flags(boxes_, some, overlaps.data());
    const std::uint8_t* next = overlaps.data();
    FilterSink::pass_on(some, [&next](Pair pair, Pair& to) {
      to = pair;
      return *next++ != 0;
    });
    pairs = pairs.subspan(some.size());
  }
}

/// Sets floats_. Returns whether coordinates that differ do so as floats.
template <int D>
bool DoubleSearch<D>::round(std::span<const Box<D, double>> boxes, std::size_t left_count,
                            const Workers& workers) {
  const std::array<core::LinearRounding, D> fit = core::fit_linear<D>(boxes);
  core::renew(floats_, boxes.size());
  parallel_.start(workers, boxes.size());
  std::atomic<bool> all_exact = true;
  std::atomic<std::uint64_t> hash = 0;
  parallel_.for_ranges(boxes.size(), [&](core::Range range, std::size_t) {
    bool is_exact = true;
    std::uint64_t of_range = 0;
    for (std::size_t begin = range.begin; begin < range.end; begin += boxes_at_once) {
      const std::size_t count = std::min(boxes_at_once, range.end - begin);
      const std::span<const Box<D, double>> some = boxes.subspan(begin, count);
      const std::span<Box<D>> floats = std::span(floats_).subspan(begin, count);
      core::round_linear<D>(fit, some, floats);
      is_exact = is_exact && core::is_lossless<D>(fit, some, floats);
      of_range += core::hash_of<D>(some, begin);
    }
    if (!is_exact) all_exact.store(false, std::memory_order_relaxed);
    hash.fetch_add(of_range, std::memory_order_relaxed);
  });
  if (all_exact) return true;
  if (boxes.size() <= few_boxes || !core::makes_false_pairs<D>(fit, boxes, left_count, hash)) return false;
  const std::array<core::QuantileRounding, D> quantiles = core::fit_quantiles<D>(boxes, hash);
  parallel_.for_ranges(boxes.size(), [&](core::Range range, std::size_t) {
    for (std::size_t i = range.begin; i < range.end; ++i)
      floats_[i] = core::rounded(
          boxes[i], [&](int axis) -> const auto& { return quantiles[axis]; });
  });
  return false;
}

template class DoubleSearch<2>;
template class DoubleSearch<3>;

}  // namespace broadside::find
