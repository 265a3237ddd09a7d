// DoubleSearch: boxes of doubles, searched as floats and tested again in double where floats cannot tell.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "broadside/searcher.hpp"

#include "core/large_array.hpp"
#include "core/parallel.hpp"

namespace broadside::find {

/// Finds pairs of boxes of doubles exactly, through any searcher of floats.
///
/// Rounding never puts two coordinates into the wrong order; at worst it makes them equal. So boxes that
/// overlap in double overlap in float as well; and boxes that overlap in float by more than touching overlap
/// in double. So only the searcher's pairs that touch need a test in double, and none if rounding has lost
/// nothing. That costs much only where rounding makes many separate boxes touch; there coordinates are
/// rounded by their quantiles, which distinguish more of them than one scale does.
template <int D>
class DoubleSearch {
 public:
  /// `tests_doubles`: whether searchers heed SearchInput::doubles.
  explicit DoubleSearch(bool tests_doubles) : tests_doubles_(tests_doubles) {}

  /// As Searcher::search(). The boxes are all present.
  std::optional<Statistics> search(Searcher<D>& searcher, std::span<const Box<D, double>> boxes,
                                   std::size_t left_count, Successor<D>* successor, const Workers& workers,
                                   PairSink& pairs);

 private:
  bool round(std::span<const Box<D, double>> boxes, std::size_t left_count, const Workers& workers);

  bool tests_doubles_;
  core::Parallel parallel_;
  core::LargeArray<Box<D>> floats_;
};

}  // namespace broadside::find
