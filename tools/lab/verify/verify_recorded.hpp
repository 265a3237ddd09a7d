// The pairs that an engine's own broad phase reported, checked against the boxes of each frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "lab/formats/recording.hpp"
#include "lab/verify/verify_file.hpp"

namespace broadside::lab {

/// What the verdict on recorded pairs is called.
inline constexpr const char* recorded_pairs_name = "recorded pairs";

/// A pair that is wrong in consecutive frames.
struct RecordedFault {
  enum class Kind : std::uint8_t {
    missed,   ///< its boxes overlap and must be reported, and it is not
    stale,    ///< it is reported, and its boxes do not overlap even if each is enlarged by the margin
    repeated  ///< it is reported more than once
  };

  Kind kind;
  Pair pair;
  std::size_t first_frame;
  std::size_t last_frame;
};

/// What is wrong with recorded pairs.
struct RecordedVerdict {
  EntryVerdict verdict;  ///< its reason tells the faults, the first one with its boxes
  std::optional<RecordedFault> first{};
};

/// Checks the pairs of a recording, which has some, in every frame until the budget is used up. Overlapping
/// boxes are found by the definition where they are few enough, and else by an algorithm of `known`, of which
/// a sample is compared with the definition in up to twenty frames. No pair is called wrong but by its boxes.
template <int D, typename Real>
RecordedVerdict verify_recorded(const Recording<D, Real>& recording, std::span<const Algorithm> known,
                                const VerifyOptions& options);

/// The smallest recording with the same fault: its two boxes, in the frame where it is first wrong and in the
/// one before, if there is one.
template <int D, typename Real>
Recording<D, Real> smallest_recording(const Recording<D, Real>& recording, const RecordedFault& fault);

}  // namespace broadside::lab
