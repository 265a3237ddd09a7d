// The law on a history of boxes: every algorithm in every frame, and the smallest history on which one fails.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "lab/measure/contest.hpp"
#include "lab/verify_file.hpp"

namespace broadside::lab {

/// What came of a history.
struct HistoryVerdicts {
  std::vector<Verdict> verdicts;  ///< in the order of the contenders; then the reference's, if it failed
  std::uint64_t pairs = 0;        ///< in the last frame
};

/// Checks the contenders as verify_file does. `known` is where references are taken from.
template <int D, typename Real>
HistoryVerdicts verify_history(const History<D, Real>& history, std::span<const Contender> contenders,
                               std::span<const Algorithm> known, const VerifyOptions& options);

/// What is wrong with an algorithm on a history; empty if nothing is. `known` is where the expected pairs of
/// many boxes come from.
template <int D, typename Real>
std::string fault_on(const History<D, Real>& history, const Contender& contender,
                     std::span<const Algorithm> known);

/// The smallest history found, in about the budget, on which the contender fails, given one whose frame
/// `frame` is the first on which it does: of a single frame if it fails there from nothing. Empty if it fails
/// on none.
template <int D, typename Real>
std::optional<History<D, Real>> smallest_failure(const History<D, Real>& history, std::size_t frame,
                                                 const Contender& contender, std::span<const Algorithm> known,
                                                 const VerifyOptions& options);

}  // namespace broadside::lab
