// What differs between the pairs of two frames, seen from their boxes.
#include "core/pair_difference.hpp"

#include <cstddef>

namespace broadside::core {
namespace {

/// How many pairs ahead boxes are called for: finders write neighbours one after the other, but boxes stand
/// anywhere in their array.
constexpr std::size_t ahead = 16;

template <typename Box>
void call_for(std::span<const Box> boxes, Pair pair) {
  __builtin_prefetch(&boxes[index(pair.first)]);
  __builtin_prefetch(&boxes[index(pair.second)]);
}

}  // namespace

template <int D, typename Real>
void report_differences(const Change<D, Real>& change, std::span<const Pair> found,
                        std::span<const Pair> kept, PairSink& begun, PairSink& ended) {
  const auto rested = [&change](Pair pair) {
    return (change.flags[index(pair.first)] | change.flags[index(pair.second)]) == 0;
  };
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (i + ahead < found.size()) call_for(change.before, found[i + ahead]);
    const Pair pair = found[i];
    if (rested(pair) || change.held(pair.first, pair.second)) continue;
    if (change.holds(pair.first, pair.second)) begun.add(pair.first, pair.second);
  }
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (i + ahead < kept.size()) call_for(change.now, kept[i + ahead]);
    const Pair pair = kept[i];
    if (rested(pair) || change.holds(pair.first, pair.second)) continue;
    if (change.held(pair.first, pair.second)) ended.add(pair.first, pair.second);
  }
}

template void report_differences(const Change<2>&, std::span<const Pair>, std::span<const Pair>, PairSink&,
                                 PairSink&);
template void report_differences(const Change<3>&, std::span<const Pair>, std::span<const Pair>, PairSink&,
                                 PairSink&);
template void report_differences(const Change<2, double>&, std::span<const Pair>, std::span<const Pair>,
                                 PairSink&, PairSink&);
template void report_differences(const Change<3, double>&, std::span<const Pair>, std::span<const Pair>,
                                 PairSink&, PairSink&);

}  // namespace broadside::core
