// The pairs that an engine's own broad phase reported, stored beside the boxes in a trace
// (docs/trace-format.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "broadside/filter.hpp"
#include "broadside/pair.hpp"

namespace broadside::lab {

/// A frame's changes to the pairs. Each pair has the lower slot first, and each list is sorted.
struct RecordedPairs {
  double margin = 0;  ///< by which the engine may enlarge boxes; the same in every frame

  std::vector<std::pair<BoxId, Filter>> filters{};  ///< new filters, by slot
  std::vector<Pair> ended{};          ///< no longer reported; repeated if reported several times less
  std::vector<Pair> begun{};          ///< reported from now on; likewise repeated
  std::vector<Pair> ended_ignored{};  ///< must be reported again if boxes overlap
  std::vector<Pair> begun_ignored{};  ///< need not be reported from now on
};

/// The pairs and filters of one frame, updated from frame to frame.
class RecordedFrame {
 public:
  /// Moves on to the next frame, which has this many slots; `emptied` lists the slots that became empty in
  /// it.
  void apply(const RecordedPairs& changes, std::size_t slots, std::span<const BoxId> emptied);

  /// Sorted; a pair occurs as often as it is reported.
  const std::vector<Pair>& reported() const noexcept { return reported_; }

  std::size_t times_reported(Pair pair) const;

  /// Pairs that need not be reported; sorted, without duplicates.
  const std::vector<Pair>& ignored() const noexcept { return ignored_; }

  /// The filters that are not the default, by slot.
  const std::unordered_map<std::uint32_t, Filter>& filters() const noexcept { return filters_; }

  Filter filter(BoxId slot) const;

  /// Whether two overlapping boxes must be reported.
  bool must_report(Pair pair) const;

 private:
  std::vector<Pair> reported_;
  std::vector<Pair> ignored_;
  std::unordered_map<std::uint32_t, Filter> filters_;
};

}  // namespace broadside::lab
