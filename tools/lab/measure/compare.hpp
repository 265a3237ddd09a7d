// The comparison: algorithms against each other on many cases, every result checked.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lab/catalogue.hpp"
#include "lab/measure/benchmark.hpp"
#include "lab/measure/measurement.hpp"
#include "lab/measure/plan.hpp"

namespace broadside::lab {

/// What to compare, and callbacks.
struct CompareOptions {
  std::string algorithms = "all";          ///< as Catalogue::select reads it
  std::vector<std::size_t> threads = {1};  ///< that algorithms search with, as with_threads() takes them
  std::vector<CaseRequest> plan = quick_plan();
  std::uint64_t seed = 1;  ///< of a scene's first input; the others count up from it
  std::size_t seeds = 0;   ///< in rotation, where the scene has several; 0: by the number of boxes
  FindScene find = [](std::string_view text) { return find_scene(text); };
  Effort effort{};
  MeasureOptions measure_options{};
  Watch watch{};
  std::function<void(const CaseResult&)> finished{};  ///< called after each case; empty: nothing is called
};

/// A case that could not be generated.
struct NotCompared {
  CaseRequest request;
  std::string reason;
};

/// The results.
struct Comparison {
  std::vector<CaseResult> cases;
  std::vector<NotCompared> not_compared;
  std::vector<std::string> warnings;    ///< of files that were read in part, each once
  bool stopped = false;                 ///< by the watch; the case that was going on is left out
  double processor_share = 1;           ///< as ProcessorShare has it, of the whole run
  std::optional<double> load_before{};  ///< processes that ran or waited, over the last minute; empty where
  std::optional<double> load_after{};   ///< the system does not tell

  /// Whether something was measured and nothing broke the law.
  bool all_verified() const;
};

/// Compares the algorithms of the catalogue that the options name on each case of the plan, one after the
/// other, in this thread. Time and memory: those of the algorithms, and of the boxes and pairs of one case.
///
/// Throws before anything is measured: InvalidSpec if an algorithm or a required scene is unknown or a value
/// in a spec is wrong. Later: what making a required scene's boxes throws. A required case counts as one that
/// a user asked for by name; any other that cannot be made is reported in not_compared.
Comparison compare(const Catalogue& catalogue, const CompareOptions& options);

}  // namespace broadside::lab
