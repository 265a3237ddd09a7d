// Checks the pairs that an engine's own broad phase reported against the boxes of each frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "lab/formats/recording.hpp"
#include "lab/verify/verify_file.hpp"

namespace broadside::lab {

/// The name of recorded pairs among the verdicts.
inline constexpr const char* recorded_pairs_name = "recorded pairs";

/// A pair that is wrong in consecutive frames.
struct RecordedFault {
  enum class Kind : std::uint8_t {
    missed,   ///< its boxes overlap and must be reported, but it is not reported
    stale,    ///< it is reported, but its boxes do not overlap even if each is enlarged by the margin
    repeated  ///< it is reported more than once
  };

  Kind kind;
  Pair pair;
  std::size_t first_frame;
  std::size_t last_frame;
};

/// The verdict on recorded pairs.
struct RecordedVerdict {
  EntryVerdict verdict;  ///< its reason describes the faults, the first one with its boxes
  std::optional<RecordedFault> first{};
};

/// Checks the recorded pairs, which must exist, in every frame until the budget is used up. Overlapping boxes
/// are found by brute force if there are few enough, otherwise by an algorithm of `known`, with a sample of
/// its pairs compared with brute force in up to twenty frames. A pair is called wrong only on the evidence of
/// its boxes.
template <int D, typename Real>
RecordedVerdict verify_recorded(const Recording<D, Real>& recording, std::span<const Algorithm> known,
                                const VerifyOptions& options);

/// The smallest recording with the same fault: its two boxes, in the frame where the pair is first wrong and
/// in the previous one, if there is one.
template <int D, typename Real>
Recording<D, Real> smallest_recording(const Recording<D, Real>& recording, const RecordedFault& fault);

}  // namespace broadside::lab
