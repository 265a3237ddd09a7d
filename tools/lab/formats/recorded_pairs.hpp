// The pairs that an engine's own broad phase reported, as a trace holds them beside the boxes
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

/// What a frame changes of the pairs. Each has the lesser slot first, and each list is sorted.
struct RecordedPairs {
  double margin = 0;  ///< by which the engine may enlarge boxes; the same in every frame

  std::vector<std::pair<BoxId, Filter>> filters{};  ///< of slots whose filters change
  std::vector<Pair> ended{};          ///< no longer reported; repeated where reported several times less
  std::vector<Pair> begun{};          ///< reported from now on; likewise
  std::vector<Pair> ended_ignored{};  ///< to be reported again where boxes overlap
  std::vector<Pair> begun_ignored{};  ///< need not be reported from now on
};

/// The pairs and filters of one frame, kept up from frame to frame.
class RecordedFrame {
 public:
  /// Goes on to the next frame, which has this many slots, of which some were emptied in it.
  void apply(const RecordedPairs& changes, std::size_t slots, std::span<const BoxId> emptied);

  /// Sorted; a pair stands as often as it is reported.
  const std::vector<Pair>& reported() const noexcept { return reported_; }

  std::size_t times_reported(Pair pair) const;

  /// Pairs that need not be reported; sorted, each once.
  const std::vector<Pair>& ignored() const noexcept { return ignored_; }

  /// The filters that are not the standard one, by slot.
  const std::unordered_map<std::uint32_t, Filter>& filters() const noexcept { return filters_; }

  Filter filter(BoxId slot) const;

  /// Whether two boxes that overlap must be reported.
  bool must_report(Pair pair) const;

 private:
  std::vector<Pair> reported_;
  std::vector<Pair> ignored_;
  std::unordered_map<std::uint32_t, Filter> filters_;
};

}  // namespace broadside::lab
