// The comparison: measures algorithms on many cases, and checks every result.
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

/// Options of compare(), and callbacks.
struct CompareOptions {
  std::string algorithms = "all";          ///< as for Catalogue::select()
  std::vector<std::size_t> threads = {1};  ///< numbers of threads, as for with_threads()
  std::vector<CaseRequest> plan = quick_plan();
  std::uint64_t seed = 1;  ///< of a scene's first input; the others count up from it
  std::size_t seeds = 0;   ///< taken in turn, if the scene has several; 0: by the number of boxes
  FindScene find = [](std::string_view text) { return find_scene(text); };
  Effort effort{};
  MeasureOptions measure_options{};
  Watch watch{};
  std::function<void(const CaseResult&)> finished{};  ///< called after each case; may be empty
};

/// A case that could not be generated.
struct NotCompared {
  CaseRequest request;
  std::string reason;
};

/// The results of a comparison.
struct Comparison {
  std::vector<CaseResult> cases;
  std::vector<NotCompared> not_compared;
  std::vector<std::string> warnings;    ///< about files that were read in part, each once
  bool stopped = false;                 ///< by the watch; the unfinished case is left out
  double processor_share = 1;           ///< ProcessorShare of the whole run
  std::optional<double> load_before{};  ///< processes that ran or waited, mean of the last minute; empty if
  std::optional<double> load_after{};   ///< the system does not report it

  /// Whether something was measured and every algorithm passed verification.
  bool all_verified() const;
};

/// Measures the catalogue's algorithms that the options select on each case of the plan, in sequence, in this
/// thread. Time and memory: those of the algorithms, and of the boxes and pairs of one case.
///
/// Throws before any measurement: InvalidSpec if an algorithm or a required scene is unknown or a value in a
/// spec is invalid. Later: exceptions from making a required scene's boxes. A case is required if a user
/// asked for it by name; any other case that cannot be made is reported in not_compared.
Comparison compare(const Catalogue& catalogue, const CompareOptions& options);

}  // namespace broadside::lab
