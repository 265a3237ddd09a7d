// CheckedSearcher: refuses pairs with ids out of range, which a searcher of the user's may write.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "broadside/algorithm.hpp"
#include "broadside/searcher.hpp"

#include "core/filter_sink.hpp"

namespace broadside::find {

/// Passes pairs on, and throws std::logic_error for the first one that is not of two boxes below `boxes`.
class IdCheck final : public core::FilterSink {
 public:
  IdCheck(std::size_t boxes, PairSink& target) : FilterSink(target), boxes_(boxes) {}

  std::unique_ptr<FilterSink> onto(PairSink& target) const override {
    return std::make_unique<IdCheck>(boxes_, target);
  }

 private:
  void consume(std::span<const Pair> pairs) override;

  std::size_t boxes_;
};

/// Everything behind a searcher reads arrays by the ids that it writes. The library's own algorithms and the
/// peers of the comparison are tested, and not slowed down by this.
template <int D>
class CheckedSearcher final : public Searcher<D> {
 public:
  explicit CheckedSearcher(std::unique_ptr<Searcher<D>> searcher) : searcher_(std::move(searcher)) {}

  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) override {
    IdCheck checked(input.boxes.size(), pairs);
    const std::optional<Statistics> statistics = searcher_->search(input, checked);
    checked.flush();
    return statistics;
  }

  std::string explanation() const override { return searcher_->explanation(); }

 private:
  std::unique_ptr<Searcher<D>> searcher_;
};

/// The searcher of an algorithm by its settings; checked if a user registered the algorithm.
template <int D>
std::unique_ptr<Searcher<D>> searcher_of(const Algorithm& algorithm, const Settings& settings);

}  // namespace broadside::find
