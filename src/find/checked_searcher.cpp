// Searchers that are checked.
#include "find/checked_searcher.hpp"

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "algorithms/registry.hpp"
#include "core/filter_sink.hpp"
#include "core/lean.hpp"
#include "core/message.hpp"

namespace broadside::find {
namespace {

/// Passes pairs of two boxes below `boxes` on, and throws for the first other one.
class IdCheck final : public core::FilterSink {
 public:
  IdCheck(std::size_t boxes, PairSink& target) : FilterSink(target), boxes_(boxes) {}

  std::unique_ptr<FilterSink> onto(PairSink& target) const override {
    return std::make_unique<IdCheck>(boxes_, target);
  }

 private:
  void consume(std::span<const Pair> pairs) override {
    for (const Pair pair : pairs) {
      if (index(pair.first) < index(pair.second) && index(pair.second) < boxes_) continue;
      throw std::logic_error(
          core::message({"a searcher wrote the pair (", index(pair.first), ", ", index(pair.second), ") of ",
                         boxes_, " boxes; expected two different places below their number"}));
    }
    target().put(pairs);
  }

  std::size_t boxes_;
};

template <int D>
class CheckedSearcher final : public Searcher<D> {
 public:
  explicit CheckedSearcher(std::unique_ptr<Searcher<D>> searcher) : searcher_(std::move(searcher)) {}

  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) override {
    return core::search_through(IdCheck(input.boxes.size(), pairs),
                                [&](PairSink& sink) { return searcher_->search(input, sink); });
  }

  std::string explanation() const override { return searcher_->explanation(); }

 private:
  std::unique_ptr<Searcher<D>> searcher_;
};

}  // namespace

template <int D>
std::unique_ptr<Searcher<D>> checked(std::unique_ptr<Searcher<D>> searcher) {
  return std::make_unique<CheckedSearcher<D>>(std::move(searcher));
}

template <int D>
std::unique_ptr<Searcher<D>> searcher_of(const Algorithm& algorithm, const Settings& settings) {
  std::unique_ptr<Searcher<D>> searcher = algorithm::searcher<D>(algorithm, settings);
  if (core::is_lean || algorithm.kind != AlgorithmKind::own || algorithm::is_linked(algorithm.name))
    return searcher;
  return checked<D>(std::move(searcher));
}

template std::unique_ptr<Searcher<2>> checked<2>(std::unique_ptr<Searcher<2>>);
template std::unique_ptr<Searcher<3>> checked<3>(std::unique_ptr<Searcher<3>>);
template std::unique_ptr<Searcher<2>> searcher_of<2>(const Algorithm&, const Settings&);
template std::unique_ptr<Searcher<3>> searcher_of<3>(const Algorithm&, const Settings&);

}  // namespace broadside::find
