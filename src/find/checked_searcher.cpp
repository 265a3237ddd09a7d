// CheckedSearcher.
#include "find/checked_searcher.hpp"

#include <stdexcept>

#include "algorithms/registry.hpp"
#include "core/lean.hpp"
#include "core/message.hpp"

namespace broadside::find {

void IdCheck::consume(std::span<const Pair> pairs) {
  for (const Pair pair : pairs) {
    if (index(pair.first) < index(pair.second) && index(pair.second) < boxes_) continue;
    throw std::logic_error(
        core::message({"a searcher wrote the pair (", index(pair.first), ", ", index(pair.second), ") of ",
                       boxes_, " boxes; expected two different places below their number"}));
  }
  target().put(pairs);
}

template <int D>
std::unique_ptr<Searcher<D>> searcher_of(const Algorithm& algorithm, const Settings& settings) {
  std::unique_ptr<Searcher<D>> searcher = algorithm::searcher<D>(algorithm, settings);
  if (core::is_lean || algorithm.kind != AlgorithmKind::own || algorithm::is_linked(algorithm.name))
    return searcher;
  return std::make_unique<CheckedSearcher<D>>(std::move(searcher));
}

template std::unique_ptr<Searcher<2>> searcher_of<2>(const Algorithm&, const Settings&);
template std::unique_ptr<Searcher<3>> searcher_of<3>(const Algorithm&, const Settings&);

}  // namespace broadside::find
