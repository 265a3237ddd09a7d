// DoubleSearch: searches double boxes as floats, and retests in double the pairs that floats cannot decide.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "broadside/searcher.hpp"

#include "core/filter_sink.hpp"
#include "core/large_array.hpp"
#include "core/parallel.hpp"
#include "core/rounding.hpp"
#include "kernels/last_test.hpp"
#include "kernels/overlap_flags.hpp"
#include "kernels/round_boxes.hpp"

namespace broadside::find {

/// Finds pairs of double boxes exactly, through any search of floats.
///
/// Rounding never reverses the order of two coordinates; at worst it makes them equal. So boxes that overlap
/// in double overlap in float as well, and boxes that overlap in float by more than touching overlap in
/// double. Only pairs that touch in float need a test in double, and none do if rounding has lost nothing.
/// These tests cost much only if rounding makes many separate boxes touch. Coordinates are then rounded by
/// their quantiles, which keep more of them apart than one scale does.
template <int D>
class DoubleSearch {
 public:
  /// `tests_doubles`: whether searches use SearchInput::doubles.
  explicit DoubleSearch(bool tests_doubles) : tests_doubles_(tests_doubles) {}

  /// Rounds boxes for search(). Returns false if not all of them are present: search() would then be wrong.
  bool round(std::span<const Box<D, double>> boxes, std::size_t left_count, const Workers& workers) {
    const std::array<core::LinearRounding, D> fit = core::fit_linear<D>(boxes);
    core::renew(floats_, boxes.size());
    if (boxes.size() <= few_boxes) {
      is_lossless_ = false;
      return kernels::round_few_boxes<D>(boxes, fit, floats_.data());
    }
    parallel_.start(workers, boxes.size());
    std::atomic<bool> all_present = true;
    std::atomic<bool> all_exact = true;
    std::atomic<std::uint64_t> hash = 0;
    parallel_.for_ranges(boxes.size(), [&](core::Range range, std::size_t) {
      const std::span<const Box<D, double>> some = boxes.subspan(range.begin, range.end - range.begin);
      const kernels::RoundedBoxes rounded =
          kernels::round_boxes<D>(some, range.begin, fit, floats_.data() + range.begin);
      if (!rounded.all_present) all_present.store(false, std::memory_order_relaxed);
      if (!rounded.is_lossless) all_exact.store(false, std::memory_order_relaxed);
      hash.fetch_add(rounded.hash, std::memory_order_relaxed);
    });
    is_lossless_ = all_exact;
    if (!all_present) return false;
    if (is_lossless_) return true;
    if (core::makes_false_pairs<D>(fit, boxes, left_count, hash)) {
      const std::array<core::QuantileRounding, D> quantiles = core::fit_quantiles<D>(boxes, hash);
      parallel_.for_ranges(boxes.size(), [&](core::Range range, std::size_t) {
        for (std::size_t i = range.begin; i < range.end; ++i) floats_[i] = core::rounded(boxes[i], quantiles);
      });
    }
    lengthen_flat_axes(boxes);
    return true;
  }

  /// Returns search_floats(input, sink), which works as Searcher::search() does. round() has rounded the
  /// boxes, with the same arguments. Unless `is_exact`, pairs that overlap only as floats are written too.
  template <typename SearchFloats>
  std::optional<Statistics> search(std::span<const Box<D, double>> boxes, std::size_t left_count,
                                   Successor<D>* successor, const Workers& workers, bool is_exact,
                                   PairSink& pairs, const SearchFloats& search_floats) {
    const bool needs_doubles = is_exact && !is_lossless_;
    const bool in_kernels = tests_doubles_ && boxes.size() <= kernels::touching_bit;
    const Box<D, double>* const doubles = in_kernels && needs_doubles ? boxes.data() : nullptr;
    const SearchInput<D> input{floats_, left_count, doubles, successor, workers};
    if (!needs_doubles || in_kernels) return search_floats(input, pairs);
    return core::search_through(ExactSink(boxes, pairs),
                                [&](PairSink& exact) { return search_floats(input, exact); });
  }

 private:
  /// Up to this number of boxes, pairs are few, false ones included: the last test costs less than to look
  /// for what rounding has lost.
  static constexpr std::size_t few_boxes = 320;

  /// Passes on the pairs that overlap in double, in the same order. For searches that do not test doubles.
  class ExactSink final : public core::FilterSink {
   public:
    ExactSink(std::span<const Box<D, double>> boxes, PairSink& target) : FilterSink(target), boxes_(boxes) {}

    std::unique_ptr<FilterSink> onto(PairSink& target) const override {
      return std::make_unique<ExactSink>(boxes_, target);
    }

   private:
    void consume(std::span<const Pair> pairs) override {
      while (!pairs.empty()) {
        const std::span<const Pair> some = pairs.first(std::min(pairs.size(), max_room));
        std::array<std::uint8_t, max_room> overlaps;
        kernels::set_overlap_flags(boxes_, some, overlaps.data());
        const std::uint8_t* next = overlaps.data();
        pass_on(some, [&next](Pair pair, Pair& to) {
          to = pair;
          return *next++ != 0;
        });
        pairs = pairs.subspan(some.size());
      }
    }

    std::span<const Box<D, double>> boxes_;
  };

  /// On an axis where all boxes have the same one coordinate, as intervals have on y, all pairs touch. Gives
  /// the floats a length there, so that they overlap by more than touching and need no test in double.
  void lengthen_flat_axes(std::span<const Box<D, double>> boxes) {
    for (int axis = 0; axis < D; ++axis) {
      const double only = boxes.front().min[axis];
      std::atomic<bool> is_flat = true;
      parallel_.for_ranges(boxes.size(), [&](core::Range range, std::size_t) {
        const auto some = boxes.subspan(range.begin, range.end - range.begin);
        if (!std::all_of(some.begin(), some.end(), [&](const Box<D, double>& box) {
              return box.min[axis] == only && box.max[axis] == only;
            }))
          is_flat.store(false, std::memory_order_relaxed);
      });
      if (!is_flat) continue;
      parallel_.for_ranges(boxes.size(), [&](core::Range range, std::size_t) {
        for (std::size_t i = range.begin; i < range.end; ++i) {
          floats_[i].min[axis] = 0;
          floats_[i].max[axis] = 1;
        }
      });
    }
  }

  bool tests_doubles_;
  core::Parallel parallel_;
  core::LargeArray<Box<D>> floats_;
  bool is_lossless_ = false;  // whether all coordinates that differ as doubles also differ in floats_
};

}  // namespace broadside::find
