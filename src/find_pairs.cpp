// find_pairs: a finder made, used once and dropped.
#include "broadside/find_pairs.hpp"

#include "broadside/sinks.hpp"

namespace broadside {
namespace {

template <int D>
std::vector<Pair> collect(std::span<const Box<D>> boxes, std::string_view spec) {
  std::vector<Pair> pairs;
  PairCollector collector(pairs);
  make_finder<D>(spec)->find(boxes, collector);
  return pairs;
}

}  // namespace

std::vector<Pair> find_pairs(std::span<const Box2> boxes, std::string_view spec) {
  return collect(boxes, spec);
}

std::vector<Pair> find_pairs(std::span<const Box3> boxes, std::string_view spec) {
  return collect(boxes, spec);
}

void find_pairs(std::span<const Box2> boxes, PairSink& pairs, std::string_view spec) {
  make_finder<2>(spec)->find(boxes, pairs);
}

void find_pairs(std::span<const Box3> boxes, PairSink& pairs, std::string_view spec) {
  make_finder<3>(spec)->find(boxes, pairs);
}

}  // namespace broadside
