// DoubleSearch: boxes of doubles, searched as floats and tested again in double where floats cannot tell.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>

#include "broadside/searcher.hpp"

#include "core/filter_sink.hpp"
#include "core/large_array.hpp"
#include "core/parallel.hpp"
#include "kernels/last_test.hpp"

namespace broadside::find {

/// Finds pairs of boxes of doubles exactly, through any search of floats.
///
/// Rounding never puts two coordinates into the wrong order; at worst it makes them equal. So boxes that
/// overlap in double overlap in float as well; and boxes that overlap in float by more than touching overlap
/// in double. So only the search's pairs that touch need a test in double, and none if rounding has lost
/// nothing. That costs much only where rounding makes many separate boxes touch; there coordinates are
/// rounded by their quantiles, which distinguish more of them than one scale does.
template <int D>
class DoubleSearch {
 public:
  /// `tests_doubles`: whether searches heed SearchInput::doubles.
  explicit DoubleSearch(bool tests_doubles) : tests_doubles_(tests_doubles) {}

  /// Returns search_floats(input, sink), which is as Searcher::search(). The boxes are all present.
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
  /// Passes on the pairs that overlap in double, for searches that do not test doubles. The order stays.
  class ExactSink final : public core::FilterSink {
   public:
    ExactSink(std::span<const Box<D, double>> boxes, PairSink& target) : FilterSink(target), boxes_(boxes) {}

    std::unique_ptr<FilterSink> onto(PairSink& target) const override {
      return std::make_unique<ExactSink>(boxes_, target);
    }

   private:
    void consume(std::span<const Pair> pairs) override;

    std::span<const Box<D, double>> boxes_;
  };

  bool round(std::span<const Box<D, double>> boxes, std::size_t left_count, const Workers& workers);

  bool tests_doubles_;
  core::Parallel parallel_;
  core::LargeArray<Box<D>> floats_;
};

}  // namespace broadside::find
