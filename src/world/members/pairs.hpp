// World: the pairs that hold, and those between two worlds.
#pragma once

#include <algorithm>
#include <iterator>
#include <mutex>
#include <stdexcept>

#include "broadside/sinks.hpp"
#include "broadside/world.hpp"

#include "world/state.hpp"

namespace broadside {

template <int D, typename Real>
std::span<const HandlePair> World<D, Real>::pairs() const {
  const State& state = *state_;
  if (!state.options.keep_pairs) {
    throw std::logic_error(
        "a world was asked for its pairs and keeps none; expected WorldOptions::keep_pairs, or find_pairs()");
  }
  if (!state.is_current.load(std::memory_order_acquire)) {
    const std::lock_guard lock(state.reading);
    state.current.merge(state.generations);
    state.is_current.store(true, std::memory_order_release);
  }
  return state.current.pairs();
}

template <int D, typename Real>
std::span<const HandlePair> World<D, Real>::persisting() const {
  const State& state = *state_;
  const std::span<const HandlePair> current = pairs();
  if (state.begun.empty()) return current;
  if (!state.is_persisting.load(std::memory_order_acquire)) {
    const std::lock_guard lock(state.reading);
    if (!state.is_persisting.load(std::memory_order_relaxed)) {
      state.persisting.clear();
      state.persisting.reserve(current.size());
      std::ranges::set_difference(current, state.begun, std::back_inserter(state.persisting));
      state.is_persisting.store(true, std::memory_order_release);
    }
  }
  return state.persisting;
}

template <int D, typename Real>
void World<D, Real>::join(const World& other, std::vector<HandlePair>& pairs) const {
  const State& left = *state_;
  const State& right = *other.state_;
  const auto finder = make_finder<D, Real>(default_algorithm);
  finder->set_workers(left.tracker->workers());
  pairs.clear();
  PairFunction collector([&](std::span<const Pair> found) {
    for (const Pair pair : found) {
      const Filter ours = left.uses_filters ? left.filters[index(pair.first)] : Filter{};
      const Filter theirs = right.uses_filters ? right.filters[index(pair.second)] : Filter{};
      if (accepts(ours, theirs)) pairs.push_back({left.handle(pair.first), right.handle(pair.second)});
    }
  });
  finder->find_between(left.boxes, right.boxes, collector);
  std::ranges::sort(pairs);
}

}  // namespace broadside
