// The equivalence test on a history of boxes: every algorithm in every frame, and the smallest history on
// which one fails.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lab/catalogue.hpp"
#include "lab/scenes/scene.hpp"
#include "lab/verify/verify_file.hpp"

namespace broadside::lab {

/// The approximate number of frames of a history in which a reference other than brute force is sampled.
inline constexpr std::size_t sampled_frames = 20;

/// The maximum number of boxes for which the expected pairs in each of `frames` frames come from brute force.
std::size_t max_by_definition(std::size_t frames) noexcept;

/// The fault of an algorithm on a history; empty if there is none. The expected pairs of many boxes come from
/// an algorithm of `known`.
template <int D, typename Real>
std::string fault_on(const History<D, Real>& history, const Entry& entry, std::span<const Algorithm> known);

/// The smallest history found within about the budget on which the entry fails. In the given history it first
/// fails in frame `frame`. A single frame, if it fails there from nothing. Empty if it does not fail.
template <int D, typename Real>
std::optional<History<D, Real>> smallest_failure(const History<D, Real>& history, std::size_t frame,
                                                 const Entry& entry, std::span<const Algorithm> known,
                                                 const VerifyOptions& options);

/// The verdicts on a history.
struct HistoryVerdicts {
  std::vector<EntryVerdict> verdicts;    ///< in the order of the entries; then the reference's, if it failed
  std::optional<std::uint64_t> pairs{};  ///< in the last frame; empty if no algorithm reached it
};

/// Checks the entries as verify_file() does. References are taken from `known`.
template <int D, typename Real>
HistoryVerdicts verify_history(const History<D, Real>& history, std::span<const Entry> entries,
                               std::span<const Algorithm> known, const VerifyOptions& options);

}  // namespace broadside::lab
