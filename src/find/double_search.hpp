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

  /// Returns search_floats(input, sink), which works as Searcher::search() does. All boxes must be present.
  template <typename SearchFloats>
  std::optional<Statistics> search(std::span<const Box<D, double>> boxes, std::size_t left_count,
                                   Successor<D>* successor, const Workers& workers, PairSink& pairs,
                                   const SearchFloats& search_floats) {
    const bool is_exact = round(boxes, left_count, workers);
    const bool in_kernels = tests_doubles_ && boxes.size() <= kernels::touching_bit;
    const Box<D, double>* const doubles = in_kernels && !is_exact ? boxes.data() : nullptr;
    const SearchInput<D> input{floats_, left_count, doubles, successor, workers};
    if (is_exact || in_kernels) return search_floats(input, pairs);
    return core::search_through(ExactSink(boxes, pairs),
                                [&](PairSink& exact) { return search_floats(input, exact); });
  }

 private:
  /// Up to this number of boxes, pairs are few, false ones included.
  static constexpr std::size_t few_boxes = 256;

  /// Boxes that are rounded, checked and hashed at a time, while they are in a core's cache.
  static constexpr std::size_t boxes_at_once = 256;

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

  /// Sets floats_. Returns whether all coordinates that differ as doubles also differ as floats.
  bool round(std::span<const Box<D, double>> boxes, std::size_t left_count, const Workers& workers) {
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
        for (std::size_t i = 0; i < count; ++i) floats[i] = core::rounded(some[i], fit);
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
      for (std::size_t i = range.begin; i < range.end; ++i) floats_[i] = core::rounded(boxes[i], quantiles);
    });
    return false;
  }

  bool tests_doubles_;
  core::Parallel parallel_;
  core::LargeArray<Box<D>> floats_;
};

}  // namespace broadside::find
