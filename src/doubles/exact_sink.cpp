// Which pairs of rounded boxes are pairs of boxes of doubles.
#include "doubles/exact_sink.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "core/prefetch.hpp"

namespace broadside::core {
namespace {

/// How many pairs ahead of its use a box is prefetched.
constexpr std::size_t looked_ahead = 32;

/// Whether the floats tell that two boxes are a pair: they do unless the boxes touch.
template <int D>
bool is_pair_for_certain(const Box<D>& a, const Box<D>& b) {
  bool certain = true;
  for (int axis = 0; axis < D; ++axis) {
    certain &= a.min[axis] < b.max[axis];
    certain &= b.min[axis] < a.max[axis];
  }
  return certain;
}

}  // namespace

template <int D>
void ExactSink<D>::consume(std::span<const Pair> pairs) {
  while (!pairs.empty()) {
    const std::size_t count = std::min(pairs.size(), max_room);
    Pair* const out = target().room(count);
    target().commit(keep(pairs.first(count), out));
    pairs = pairs.subspan(count);
  }
}

/// Writes those of up to max_room pairs that are to be kept, as ids, and returns how many.
template <int D>
std::size_t ExactSink<D>::keep(std::span<const Pair> pairs, Pair* out) const {
  // Without branches: no predictor can know the order of ids or, where many boxes touch, which pairs are
  // certain.
  std::array<Pair, max_room> uncertain;
  std::array<std::uint32_t, max_room> before;  // how many are kept before it
  std::size_t uncertain_count = 0;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Pair ahead = pairs[std::min(i + looked_ahead, pairs.size() - 1)];
    fetch(index(ahead.first));
    fetch(of_.left_count + index(ahead.second));
    const std::size_t a = index(pairs[i].first);
    const std::size_t b = of_.left_count + index(pairs[i].second);
    const std::uint32_t first = of_.ids[a];
    const std::uint32_t second = of_.ids[b];
    const std::uint32_t lesser = std::min(first, second);
    const Pair pair = {BoxId{lesser}, BoxId{first ^ second ^ lesser}};
    const bool certain = of_.exact || is_pair_for_certain(of_.floats[a], of_.floats[b]);
    uncertain[uncertain_count] = pair;
    before[uncertain_count] = static_cast<std::uint32_t>(kept);
    uncertain_count += static_cast<std::size_t>(!certain);
    out[kept] = pair;
    kept += static_cast<std::size_t>(certain);
  }
  std::size_t accepted = 0;
  for (std::size_t i = 0; i < uncertain_count; ++i) {
    const Pair pair = uncertain[i];
    uncertain[accepted] = pair;
    before[accepted] = before[i];
    accepted +=
        static_cast<std::size_t>(overlap(of_.boxes[index(pair.first)], of_.boxes[index(pair.second)]));
  }
  // They go where they were found, so that the order does not depend on where a chunk of pairs ends.
  std::size_t end = kept;
  for (std::size_t i = accepted; i > 0; --i) {
    const std::size_t begin = before[i - 1];
    std::move_backward(out + begin, out + end, out + end + i);
    out[begin + i - 1] = uncertain[i - 1];
    end = begin;
  }
  return kept + accepted;
}

/// Prefetches what is looked up of a box.
template <int D>
void ExactSink<D>::fetch(std::size_t place) const {
  prefetch(&of_.ids[place]);
  prefetch(&of_.floats[place]);
}

template class ExactSink<2>;
template class ExactSink<3>;

}  // namespace broadside::core
