// Deliberately wrong algorithms, for tests of error detection.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "broadside/algorithm.hpp"
#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"

namespace broadside::lab {

/// Changes the sorted pairs of a search, or throws. It is called only for searches with pairs, with the
/// number of such searches before.
using Spoil = std::function<void(std::vector<Pair>&, std::size_t searches)>;

/// Brute force with modified pairs.
template <int D>
class SpoiltSearcher final : public Searcher<D> {
 public:
  explicit SpoiltSearcher(Spoil spoil) : spoil_(std::move(spoil)) {}

  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& sink) override {
    std::vector<Pair> pairs;
    PairCollector collector(pairs);
    Finder<D>("brute_force").find(input.boxes, collector);
    if (!pairs.empty()) spoil_(pairs, searches_++);
    for (const Pair pair : pairs) sink.add(pair.first, pair.second);
    return std::nullopt;
  }

 private:
  Spoil spoil_;
  std::size_t searches_ = 0;
};

/// Brute force under another name, with modified pairs.
inline Algorithm spoilt(std::string name, const Spoil& spoil) {
  Algorithm algorithm;
  algorithm.name = std::move(name);
  algorithm.in_2d.searcher = [spoil](const Settings&) { return std::make_unique<SpoiltSearcher<2>>(spoil); };
  algorithm.in_3d.searcher = [spoil](const Settings&) { return std::make_unique<SpoiltSearcher<3>>(spoil); };
  return algorithm;
}

inline Algorithm misses_per_pair() {
  return spoilt("misses", [](std::vector<Pair>& pairs, std::size_t) { pairs.pop_back(); });
}

inline Algorithm repeats_a_pair() {
  return spoilt("repeats", [](std::vector<Pair>& pairs, std::size_t) { pairs.push_back(pairs.front()); });
}

/// Replaces an overlapping pair by one that does not overlap, so that the number of pairs stays correct.
inline void mistakes_per_pair(std::vector<Pair>& pairs) {
  const auto last = static_cast<std::uint32_t>(pairs.size());
  for (std::uint32_t j = 1; j <= last; ++j) {
    if (pairs[j - 1] != Pair{BoxId{0}, BoxId{j}}) {
      pairs.back() = {BoxId{0}, BoxId{j}};
      return;
    }
  }
}

inline Algorithm mistakes_per_pair() {
  return spoilt("mistakes", [](std::vector<Pair>& pairs, std::size_t) { mistakes_per_pair(pairs); });
}

}  // namespace broadside::lab
