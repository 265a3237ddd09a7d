// Searchers and followers for tests: a stub, and the library's own.
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

/// Calls a function with the arguments of a search.
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

/// The algorithm's searcher, with default settings.
template <int D>
std::unique_ptr<Searcher<D>> searcher_of(const Algorithm& algorithm) {
  return algorithm.in<D>().searcher(Settings({algorithm.name, {}}, algorithm.tunables));
}
template <int D>
std::unique_ptr<Searcher<D>> searcher_of(std::string_view name) {
  return searcher_of<D>(*find_algorithm(name));
}

/// The algorithm's first follower, with default settings.
template <int D>
std::unique_ptr<Follower<D>> follower_of(std::string_view name) {
  const Algorithm& algorithm = *find_algorithm(name);
  return algorithm.in<D>().followers[0].make(Settings({algorithm.name, {}}, algorithm.tunables));
}

}  // namespace broadside
