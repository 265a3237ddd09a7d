// The law on a history of boxes: every algorithm in every frame.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lab/verify/verify_file.hpp"

namespace broadside::lab {

/// What came of a history.
struct HistoryVerdicts {
  std::vector<Verdict> verdicts;         ///< in the order of the entries; then the reference's, if it failed
  std::optional<std::uint64_t> pairs{};  ///< in the last frame; empty where nobody got there
};

/// Checks the entries as verify_file does. `known` is where references are taken from.
template <int D, typename Real>
HistoryVerdicts verify_history(const History<D, Real>& history, std::span<const Entry> entries,
                               std::span<const Algorithm> known, const VerifyOptions& options);

}  // namespace broadside::lab
