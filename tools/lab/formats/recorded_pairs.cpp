// The pairs that an engine's own broad phase reported, frame by frame.
#include "lab/formats/recorded_pairs.hpp"

#include <algorithm>
#include <iterator>

namespace broadside::lab {
namespace {

/// Removes some pairs from sorted ones and inserts others.
void change(std::vector<Pair>& pairs, const std::vector<Pair>& ended, const std::vector<Pair>& begun) {
  if (ended.empty() && begun.empty()) return;
  std::vector<Pair> left;
  std::set_difference(pairs.begin(), pairs.end(), ended.begin(), ended.end(), std::back_inserter(left));
  pairs.clear();
  std::merge(left.begin(), left.end(), begun.begin(), begun.end(), std::back_inserter(pairs));
}

}  // namespace

void RecordedFrame::apply(const RecordedPairs& changes, std::size_t slots, std::span<const BoxId> emptied) {
  change(reported_, changes.ended, changes.begun);
  change(ignored_, changes.ended_ignored, changes.begun_ignored);
  for (const BoxId slot : emptied) filters_.erase(index(slot));
  std::erase_if(filters_, [slots](const auto& filter) { return filter.first >= slots; });
  for (const auto& [slot, filter] : changes.filters) {
    if (filter == Filter{})
      filters_.erase(index(slot));
    else
      filters_.insert_or_assign(index(slot), filter);
  }
}

std::size_t RecordedFrame::times_reported(Pair pair) const {
  // Not the std::ranges version: clang 14 cannot compile its result type.
  const auto [from, to] = std::equal_range(reported_.begin(), reported_.end(), pair);
  return static_cast<std::size_t>(to - from);
}

Filter RecordedFrame::filter(BoxId slot) const {
  const auto found = filters_.find(index(slot));
  return found == filters_.end() ? Filter{} : found->second;
}

bool RecordedFrame::must_report(Pair pair) const {
  return accepts(filter(pair.first), filter(pair.second)) &&
         !std::binary_search(ignored_.begin(), ignored_.end(), pair);
}

}  // namespace broadside::lab
