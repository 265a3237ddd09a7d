// The law on a history of boxes: every algorithm in every frame, and the smallest history on which one fails.
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

/// In about how many frames of a history a reference is sampled that is not the definition.
inline constexpr std::size_t sampled_frames = 20;

/// The most boxes whose expected pairs are the definition's in each of `frames` frames.
std::size_t max_by_definition(std::size_t frames) noexcept;

/// The fault of an algorithm on a history; empty if there is none. `known` is where the expected pairs of
/// many boxes come from.
template <int D, typename Real>
std::string fault_on(const History<D, Real>& history, const Entry& entry, std::span<const Algorithm> known);

/// The smallest history found, in about the budget, on which the entry fails, given one whose frame
/// `frame` is the first on which it does: of a single frame if it fails there from nothing. Empty if it fails
/// on none.
template <int D, typename Real>
std::optional<History<D, Real>> smallest_failure(const History<D, Real>& history, std::size_t frame,
                                                 const Entry& entry, std::span<const Algorithm> known,
                                                 const VerifyOptions& options);

/// The verdicts on a history.
struct HistoryVerdicts {
  std::vector<EntryVerdict> verdicts;    ///< in the order of the entries; then the reference's, if it failed
  std::optional<std::uint64_t> pairs{};  ///< in the last frame; empty where no algorithm got there
};

/// Checks the entries as verify_file does. `known` is where references are taken from.
template <int D, typename Real>
HistoryVerdicts verify_history(const History<D, Real>& history, std::span<const Entry> entries,
                               std::span<const Algorithm> known, const VerifyOptions& options);

}  // namespace broadside::lab
