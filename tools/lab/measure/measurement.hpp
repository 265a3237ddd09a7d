// The lab's records: cases, and measurements of algorithms in them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "broadside/algorithm.hpp"

#include "paper/listings/phases.hpp"

namespace broadside::lab {

/// Whether all pairs are found from nothing, or followed from frame to frame.
enum class Mode { find, track };

/// What algorithms were compared on.
struct Case {
  std::string name{};                                           ///< in a list of cases; empty elsewhere
  std::string scene;                                            ///< as a spec, or the path of a file
  std::vector<std::pair<std::string, std::string>> parameters;  ///< of the scene, the standard ones too
  std::vector<std::uint64_t> seeds;
  int dimension = 2;
  std::size_t boxes = 0;          ///< the most there are in any frame
  std::size_t frames = 0;         ///< after the first; 0 in a still scene
  double moving = 0;              ///< the mean fraction of the boxes that change from one frame to the next
  std::optional<double> drift{};  ///< how a scene that does not move by itself was set moving, as in
  std::optional<double> teleport{};  ///< SceneRequest; empty for others
  Mode mode = Mode::find;
};

/// What is taken of a case. Counts and memory always are.
struct MeasureOptions {
  bool times = true;       ///< otherwise each algorithm runs once on each seed
  bool phases = false;     ///< where the time of each call or frame of a listing goes
  bool made_anew = false;  ///< each timed search is by a new searcher, which is made before the clock starts
};

/// The outcome of an algorithm in a case.
enum class Outcome {
  verified,  ///< it was timed, and every pair or event of every timed call was right
  failed,    ///< it broke the law; its times are dropped
  skipped    ///< it did not take part, or ran out of memory
};

/// How the results of a measurement were verified; docs/benchmarking.md says what each word is worth.
struct Evidence {
  bool by_definition = false;  ///< compared with every pair tested by the definition
  std::size_t structures = 0;  ///< algorithms of the case that gave the same pairs, this one included,
  std::size_t libraries = 0;   ///< and libraries that these are from, Broadside with all of its being one

  /// "by definition", or as in "cross-checked by 9 structures of 6 libraries".
  std::string text() const;
};

/// What holds of both.
Evidence weaker(const Evidence& a, const Evidence& b);

/// A 95 % confidence interval.
struct Interval {
  double low;
  double high;

  bool includes(double number) const noexcept { return low <= number && number <= high; }
};

/// The time of one algorithm over that of another, in the rounds that both took part in (paired_ratio.hpp).
struct PairedRatio {
  std::string of;  ///< the spec of the other one
  double median;   ///< over the seeds, of each seed's median ratio of its rounds, by logarithms
  std::optional<Interval> interval;  ///< by bootstrap; empty where there are too few rounds for one
  std::size_t rounds;                ///< that both took part in
  double ms = 0;                     ///< the median time of these rounds, and the other one's: measured
  double of_ms = 0;                  ///< with fewer others around, a time is less
};

/// Whether algorithms of this kind are no part of what users link: they are compared, and never advised.
constexpr bool is_foreign(AlgorithmKind kind) noexcept {
  return kind == AlgorithmKind::literature || kind == AlgorithmKind::peer;
}

/// One algorithm in one case. What was counted (pairs, hash, statistics, bytes) is of the first seed.
struct Measurement {
  std::string algorithm;  ///< its spec
  std::string version;    ///< of the library behind it
  AlgorithmKind kind = AlgorithmKind::own;
  std::size_t threads = 1;
  std::string target{};  ///< the instruction set of its kernels; empty for what is not Broadside's own

  Outcome outcome = Outcome::skipped;
  std::optional<Evidence> evidence;    ///< empty where nothing was compared
  std::string reason;                  ///< why there is no time: what diverged first, or why it was skipped
  std::optional<double> estimated_ms;  ///< where it was skipped for its budget: a call or a frame

  std::vector<double> samples_ms;     ///< each a whole call, from boxes to pairs, or a frame
  std::size_t samples_per_round = 1;  ///< the frames of a history; round r of all is on the same boxes
  std::optional<double> build_ms{};   ///< in motion: the first frame, in which all is new; the median
  std::optional<std::uint64_t> pairs;
  std::optional<std::uint64_t> pair_hash;
  std::optional<Statistics> statistics;
  std::vector<std::optional<Statistics>> statistics_by_seed{};  ///< of each seed that was measured
  std::vector<paper::Phases> phases{};      ///< of each sample; empty where they were not asked for
  std::string explanation{};                ///< of an algorithm that chooses: what it chose, and why; of a
                                            ///< peer: what its build costs it
  std::optional<std::uint64_t> own_bytes;   ///< what the algorithm holds between calls
  std::optional<std::uint64_t> peak_bytes;  ///< the most it holds at one moment, in or between calls

  std::optional<PairedRatio> to_fastest{};       ///< its time over that of the case's fastest,
  std::optional<PairedRatio> to_best_own{};      ///< of the fastest of our own other than auto,
  std::optional<PairedRatio> to_fastest_peer{};  ///< and of the fastest other library
};

/// A case and its measurements, in the order of the entries.
struct CaseResult {
  Case of;
  std::vector<Measurement> measurements;
  std::vector<double> floor_ms{};  ///< of the floor (floor.hpp) in each round; none where it makes no sense
};

/// How much time an algorithm may take in a case. Each takes part in the first rounds of the case, without a
/// gap.
struct Effort {
  double budget_seconds = 0.25;       ///< for one search; a slower algorithm is skipped
  double history_seconds = 1;         ///< for a whole history, from its first frame to its last; likewise
  double share_seconds = 0.1;         ///< timed calls of an algorithm end once they sum to this
  std::size_t min_rounds = 8;         ///< even if that takes longer
  std::size_t max_rounds = 100;       ///< even if that takes less time
  double slow_seconds = 0.1;          ///< a search that takes longer has slow_rounds rounds
  double slow_history_seconds = 0.8;  ///< a history that takes longer has slow_rounds rounds
  std::size_t slow_rounds = 5;
  std::size_t definition_boxes =
      20'000;              ///< searches of more boxes are not checked by the definition, nor are
                           ///< histories that take over four times the tests of such a search
  double far_ratio = 1.5;  ///< an algorithm that takes this many times the time of both the fastest other
                           ///< library and our fastest (and over far_from_seconds) has far_rounds rounds
  std::size_t far_rounds = 3;
  double case_seconds =
      std::numeric_limits<double>::infinity();  ///< no round begins after this, but for the first two
};

/// Rounds shorter than this cost next to nothing, so no algorithm counts as far behind.
inline constexpr double far_from_seconds = 0.002;

}  // namespace broadside::lab
