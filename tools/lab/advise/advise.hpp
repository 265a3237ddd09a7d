// Advice: which algorithm suits given boxes, by measuring them and the algorithms on them.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lab/advise/algorithm_choice.hpp"
#include "lab/advise/signals.hpp"
#include "lab/catalogue.hpp"
#include "lab/measure/benchmark.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::lab {

/// How to find out.
struct AdviseOptions {
  std::string algorithms = "own";          ///< as Catalogue::select reads it
  std::vector<std::size_t> threads = {1};  ///< that may be used besides one; plain algorithms have one, and
                                           ///< the best are tried with more, which must pay to be advised
  double budget_seconds = 6;               ///< about how long it may take, checks included
  Watch watch{};
};

/// An algorithm that was measured, and the result.
struct RankedAlgorithm {
  Measurement measurement;
  double milliseconds = 0;  ///< a call or a frame: of each input, or frame, the least of its samples, and the
                            ///< median of these; an estimate or infinite where it did not take part
  bool is_variant = false;  ///< whether a tunable is set that the user did not ask for
  bool is_finalist = false;  ///< whether it was in the second, longer round, from which is chosen
};

/// The advice and its grounds. Without a choice there is nothing to advise: nothing was verified.
struct Advice {
  std::string input;           ///< the file's or scene's name
  std::string warning;         ///< of a file that was read in part; empty otherwise
  double processor_share = 1;  ///< ProcessorShare of measuring
  Signals signals{};
  Mode mode = Mode::find;
  std::size_t first_frame = 0;  ///< of a long history only some frames are measured: from this one on ...
  std::size_t frames = 0;       ///< ... this many after it
  std::optional<double> floor_ms{};
  std::vector<RankedAlgorithm> ranking{};            ///< finalists first; of them and of the others the fastest first,
                                            ///< those without a time last
  std::optional<AlgorithmChoice> choice{};  ///< its indices are into the ranking

  std::string spec{};     ///< what is advised
  double milliseconds{};  ///< that it takes, a call or a frame, as in RankedAlgorithm
  double p99_ms{};
  std::vector<std::string> reasons{};  ///< sentences: why it, and why not the others
  std::vector<std::string> changes{};  ///< and what would change the advice, as far as it was measured
  std::string snippet{};

  /// Whether nothing broke the law.
  bool all_verified() const;
};

/// Measures what the boxes are like, then all algorithms briefly and the best of them, with variants of their
/// tunables, for longer: in turns, on these boxes and on their mirror images, which differ only in what
/// a branch predictor may learn. Every result is checked.
///
/// Throws InvalidSpec, InvalidInput for invalid boxes, Stopped, and std::runtime_error where there are too
/// many pairs to keep.
template <int D, typename Real>
Advice advise(const Catalogue& catalogue, const std::string& input, const History<D, Real>& history,
              const AdviseOptions& options);

/// Fills in Advice::reasons and Advice::changes from the rest of the advice.
std::vector<std::string> reasons_of(const Advice& advice);
std::vector<std::string> changes_of(const Advice& advice);

/// The advice as text for people.
std::string text_of(const Advice& advice);

/// The advice as JSON, by the schema "broadside.advice/2" (docs/benchmarking.md). `command` is the program's
/// arguments, the program itself first.
std::string json_of(const Advice& advice, std::span<const std::string> command);

}  // namespace broadside::lab
