// Advice: measures the boxes and the algorithms on them to find the algorithm that suits them.
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
#include "lab/report/fold.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::lab {

/// Options of advise().
struct AdviseOptions {
  std::string algorithms = "own";          ///< as Catalogue::select reads it
  std::vector<std::size_t> threads = {1};  ///< numbers of threads that may be used besides 1. Plain
                                           ///< algorithms run with one thread. The best are also tried with
                                           ///< more, and are advised with them only if clearly faster.
  double budget_seconds = 6;               ///< approximate time limit, including checks
  Watch watch{};
};

/// A measured algorithm and its result.
struct RankedAlgorithm {
  Measurement measurement;
  double milliseconds = 0;   ///< per call or frame. Median over inputs (or frames) of each one's fastest
                             ///< sample; an estimate, or infinite, if not measured
  bool is_variant = false;   ///< whether it sets a tunable that the user did not ask for
  bool is_finalist = false;  ///< whether it was in the second, longer round, from which the choice is made
};

/// The advice and its reasons. Without a choice there is no advice: nothing was verified.
struct Advice {
  std::string input;           ///< name of the file or scene
  std::string warning;         ///< if the file was read in part; empty otherwise
  double processor_share = 1;  ///< ProcessorShare during the measurements
  bool is_withheld = false;    ///< since the machine was busy: text and JSON have the measurements alone
  Signals signals{};
  Mode mode = Mode::find;
  std::size_t first_frame = 0;  ///< only some frames of a long history are measured: from this one ...
  std::size_t frames = 0;       ///< ... for this many frames after it
  std::optional<double> floor_ms{};
  std::vector<RankedAlgorithm> ranking{};   ///< finalists first; within finalists and others by
                                            ///< time, fastest first, algorithms without a time last
  std::optional<AlgorithmChoice> choice{};  ///< holds indices into the ranking

  std::string spec{};     ///< the advised spec
  double milliseconds{};  ///< its time per call or frame, as in RankedAlgorithm
  double p99_ms{};
  std::vector<std::string> reasons{};  ///< sentences: why this algorithm, and why not the others
  std::vector<std::string> changes{};  ///< sentences: what would change the advice, as far as it was measured
  std::string snippet{};

  /// Whether every algorithm passed verification.
  bool all_verified() const;
};

/// Measures statistics of the boxes, then all algorithms briefly, then the best and variants of their
/// tunables for longer. Algorithms take turns, on these boxes and on their mirror images, so that the branch
/// predictor cannot learn the boxes. Checks every result.
///
/// Throws InvalidSpec, InvalidInput for invalid boxes, Stopped, and std::runtime_error if there are too many
/// pairs to keep.
template <int D, typename Real>
Advice advise(const Catalogue& catalogue, const std::string& input, const History<D, Real>& history,
              const AdviseOptions& options);

/// The values of Advice::reasons and Advice::changes, from the rest of the advice.
std::vector<std::string> reasons_of(const Advice& advice);
std::vector<std::string> changes_of(const Advice& advice);

/// The advice as text, folded to `width` except for its code. Says first whether the machine was busy.
std::string text_of(const Advice& advice, std::size_t width = any_width);

/// The advice as JSON, by the schema "broadside.advice/2" (docs/benchmarking.md). `command` holds the
/// program's arguments, starting with the program itself.
std::string json_of(const Advice& advice, std::span<const std::string> command);

}  // namespace broadside::lab
