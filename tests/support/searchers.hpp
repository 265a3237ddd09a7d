// Searchers and followers as tests use them: a stub, and the library's own.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "broadside/algorithm.hpp"
#include "broadside/follower.hpp"
#include "broadside/searcher.hpp"

namespace broadside {

/// Calls a function with what a searcher gets to see.
class StubSearcher final : public Searcher<2> {
 public:
  using Search = std::function<std::optional<Statistics>(const SearchInput<2>&, PairSink&)>;

  explicit StubSearcher(Search search) : search_(std::move(search)) {}

  std::optional<Statistics> search(const SearchInput<2>& input, PairSink& pairs) override {
    return search_(input, pairs);
  }

 private:
  Search search_;
};

/// The searcher of one of algorithms(), with nothing set.
template <int D>
std::unique_ptr<Searcher<D>> library_searcher(std::string_view name) {
  const Algorithm& algorithm = *find_algorithm(name);
  const Settings settings({algorithm.name, {}}, algorithm.tunables);
  if constexpr (D == 2)
    return algorithm.searcher_2d(settings);
  else
    return algorithm.searcher_3d(settings);
}

/// Its first follower, likewise.
template <int D>
std::unique_ptr<Follower<D>> library_follower(std::string_view name) {
  const Algorithm& algorithm = *find_algorithm(name);
  const Settings settings({algorithm.name, {}}, algorithm.tunables);
  if constexpr (D == 2)
    return algorithm.followers_2d[0].make(settings);
  else
    return algorithm.followers_3d[0].make(settings);
}

}  // namespace broadside
