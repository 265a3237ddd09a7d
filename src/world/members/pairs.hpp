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
  // The kept finder serves one reader at a time.
  const std::unique_lock lock(left.join_in_progress, std::try_to_lock);
  std::unique_ptr<PairFinder<D, Real>> another;
  std::unique_ptr<PairFinder<D, Real>>& finder = lock.owns_lock() ? left.join_finder : another;
  if (finder == nullptr)
    finder = make_finder<D, Real>(left.is_own_tracker ? left.options.algorithm : default_algorithm);
  finder->set_workers(left.tracker->workers());
  pairs.clear();
  PairFunction collector([&](std::span<const Pair> found) {
    for (const Pair pair : found) pairs.push_back({left.handle(pair.first), right.handle(pair.second)});
  });
  const auto filters_of = [](const State& state) {
    return state.uses_filters ? std::span<const Filter>(state.filters) : std::span<const Filter>();
  };
  finder->find_between(left.boxes, right.boxes, collector, {filters_of(left), filters_of(right)});
  std::ranges::sort(pairs);
}

}  // namespace broadside
