// Finds the smallest recording in which an engine's pair is wrong.
#include <algorithm>
#include <array>
#include <utility>

#include "lab/verify/playback.hpp"
#include "lab/verify/verify_recorded.hpp"

namespace broadside::lab {
namespace {

/// Two boxes in a frame, and the pairs reported of them.
template <int D, typename Real>
struct Moment {
  std::array<Box<D, Real>, 2> boxes = {absent_box<D, Real>(), absent_box<D, Real>()};
  std::array<Filter, 2> filters{};
  std::size_t reported = 0;
  bool is_ignored = false;

  Moment() = default;
  Moment(const Playback<D, Real>& playback, Pair pair) {
    const std::array<BoxId, 2> ids = {pair.first, pair.second};
    for (std::size_t i = 0; i < 2; ++i) {
      if (index(ids[i]) < playback.boxes().size()) boxes[i] = playback.boxes()[index(ids[i])];
      filters[i] = playback.pairs().filter(ids[i]);
    }
    reported = playback.pairs().times_reported(pair);
    is_ignored = std::ranges::binary_search(playback.pairs().ignored(), pair);
  }

  /// The changes since the previous frame, with the boxes in slots 0 and 1.
  RecordedPairs since(const Moment& before, double margin) const {
    constexpr Pair pair{BoxId{0}, BoxId{1}};
    RecordedPairs changes{.margin = margin};
    for (std::uint32_t i = 0; i < 2; ++i) {
      if (filters[i] != before.filters[i] && !is_absent(boxes[i]))
        changes.filters.emplace_back(BoxId(i), filters[i]);
    }
    if (reported > before.reported) changes.begun.assign(reported - before.reported, pair);
    if (reported < before.reported) changes.ended.assign(before.reported - reported, pair);
    if (is_ignored && !before.is_ignored) changes.begun_ignored.push_back(pair);
    if (!is_ignored && before.is_ignored) changes.ended_ignored.push_back(pair);
    return changes;
  }
};

}  // namespace

template <int D, typename Real>
Recording<D, Real> smallest_recording(const Recording<D, Real>& recording, const RecordedFault& fault) {
  const double margin = recording.pairs.front().margin;
  Playback<D, Real> playback(recording);
  while (playback.frame() + 1 < fault.first_frame) playback.next();
  const Moment<D, Real> first(playback, fault.pair);
  Recording<D, Real> small{{{first.boxes.begin(), first.boxes.end()}, {}}, {first.since({}, margin)}};
  if (playback.frame() == fault.first_frame) return small;
  playback.next();
  const Moment<D, Real> second(playback, fault.pair);
  Step<D, Real> step{2, {}, {}};
  for (std::uint32_t i = 0; i < 2; ++i) {
    if (second.boxes[i] == first.boxes[i]) continue;
    step.changed.push_back(BoxId(i));
    step.boxes.push_back(second.boxes[i]);
  }
  small.history.steps.push_back(std::move(step));
  small.pairs.push_back(second.since(first, margin));
  return small;
}

template Recording<2, float> smallest_recording(const Recording<2, float>&, const RecordedFault&);
template Recording<3, float> smallest_recording(const Recording<3, float>&, const RecordedFault&);
template Recording<2, double> smallest_recording(const Recording<2, double>&, const RecordedFault&);
template Recording<3, double> smallest_recording(const Recording<3, double>&, const RecordedFault&);

}  // namespace broadside::lab
