// World: the pairs that hold, and those between two worlds.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <mutex>
#include <stdexcept>
#include <string>

#include "broadside/sinks.hpp"
#include "broadside/world.hpp"

#include "core/float_environment.hpp"
#include "core/message.hpp"
#include "kernels/overlap_flags.hpp"
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
void World<D, Real>::overlaps(std::span<const HandlePair> pairs, std::span<std::uint8_t> flags) const {
  const core::DefaultEnvironment environment;
  if (flags.size() != pairs.size()) {
    throw std::invalid_argument(
        core::message({flags.size(), " flags for ", pairs.size(), " pairs; expected one for each"}));
  }
  const State& state = *state_;
  const std::span<const Box<D, Real>> boxes = state.boxes;
  constexpr std::size_t at_once = 256;
  std::array<Pair, at_once> places;
  std::array<std::uint8_t, at_once> are_live;
  for (std::size_t begin = 0; begin < pairs.size(); begin += at_once) {
    const std::span<const HandlePair> some = pairs.subspan(begin, std::min(at_once, pairs.size() - begin));
    std::uint8_t* const its_flags = flags.data() + begin;
    if (boxes.empty()) {
      std::fill_n(its_flags, some.size(), std::uint8_t{0});
      continue;
    }
    for (std::size_t i = 0; i < some.size(); ++i) {
      are_live[i] = state.is_live(some[i].first) && state.is_live(some[i].second);
      places[i] = are_live[i] != 0 ? Pair{BoxId{some[i].first.slot}, BoxId{some[i].second.slot}} : Pair{};
    }
    kernels::set_overlap_flags(boxes, std::span<const Pair>(places).first(some.size()), its_flags);
    for (std::size_t i = 0; i < some.size(); ++i) its_flags[i] &= are_live[i];
  }
}

template <int D, typename Real>
void World<D, Real>::join_into(const World& other, detail::Output<HandlePair>& pairs) const {
  const State& left = *state_;
  const State& right = *other.state_;
  // The kept finder serves one reader at a time.
  const std::unique_lock lock(left.join_in_progress, std::try_to_lock);
  std::unique_ptr<PairFinder<D, Real>> another;
  std::unique_ptr<PairFinder<D, Real>>& finder = lock.owns_lock() ? left.join_finder : another;
  if (finder == nullptr)
    finder = make_finder<D, Real>(left.is_own_tracker ? left.options.algorithm : default_algorithm);
  finder->set_workers(left.tracker->workers());
  std::span<HandlePair> handles = pairs.resize(0);
  PairFunction collector([&](std::span<const Pair> found) {
    const std::size_t size = handles.size();
    handles = pairs.resize(size + found.size());
    std::ranges::transform(found, handles.begin() + static_cast<std::ptrdiff_t>(size), [&](Pair pair) {
      return HandlePair{left.handle(pair.first), right.handle(pair.second)};
    });
  });
  const auto filters_of = [](const State& state) {
    return state.uses_filters ? std::span<const Filter>(state.filters) : std::span<const Filter>();
  };
  finder->find_between(left.boxes, right.boxes, collector, {filters_of(left), filters_of(right)});
  std::ranges::sort(handles);
}

}  // namespace broadside
