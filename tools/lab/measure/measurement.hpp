// The lab's records: cases, and measurements of algorithms on them.
#pragma once

#include <cmath>
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

/// Whether all pairs are searched for from nothing, or tracked from frame to frame.
enum class Mode { find, track };

/// The input on which algorithms were compared.
struct Case {
  std::string name{};                                           ///< in a list of cases; otherwise empty
  std::string scene;                                            ///< a spec, or the path of a file
  std::vector<std::pair<std::string, std::string>> parameters;  ///< of the scene, including defaults
  std::vector<std::uint64_t> seeds;
  int dimension = 2;
  std::size_t boxes = 0;             ///< the maximum number in any frame
  std::size_t frames = 0;            ///< after the first; 0 for a still scene
  double moving = 0;                 ///< mean fraction of the boxes that change from one frame to the next
  double left = 0;                   ///< in a search between two sets: the fraction of the boxes, those in
                                     ///< front, that is the left set; 0: pairs within one set
  bool filtered = false;             ///< whether boxes have filters, as in CaseRequest
  std::optional<double> drift{};     ///< how a scene without its own motion was set moving, as in
  std::optional<double> teleport{};  ///< SceneRequest; otherwise empty
  Mode mode = Mode::find;
};

/// The number of boxes in a left set that is this fraction of all boxes.
inline std::size_t left_count(double left, std::size_t boxes) noexcept {
  return static_cast<std::size_t>(std::llround(left * static_cast<double>(boxes)));
}

/// What to measure in a case. Counts and memory are always measured.
struct MeasureOptions {
  bool times = true;       ///< if false, each algorithm runs once on each seed
  bool phases = false;     ///< the time of each phase of a listing's calls or frames
  bool made_anew = false;  ///< each timed search uses a new searcher, made before the clock starts
  bool cold = false;       ///< nothing is in the caches when a call begins
};

/// The outcome of an algorithm in a case.
enum class Outcome {
  verified,  ///< it was timed, and every pair or event of every timed call was correct
  failed,    ///< it failed verification; its times are dropped
  skipped    ///< it did not take part, or ran out of memory
};

/// How the results of a measurement were verified; docs/benchmarking.md explains each term.
struct Evidence {
  bool by_definition = false;  ///< compared with brute force over all pairs
  std::size_t structures = 0;  ///< number of algorithms in the case with the same pairs, including this one,
  std::size_t libraries = 0;   ///< and of the libraries they are from; all of Broadside counts as one

  /// "by definition", or as in "cross-checked by 9 structures of 6 libraries".
  std::string text() const;
};

/// The weaker evidence of the two.
Evidence weaker(const Evidence& a, const Evidence& b);

/// A 95 % confidence interval.
struct Interval {
  double low;
  double high;

  bool includes(double number) const noexcept { return low <= number && number <= high; }
};

/// The ratio of one algorithm's time to another's, in the rounds that both took part in (paired_ratio.hpp).
struct PairedRatio {
  std::string of;  ///< the spec of the other algorithm
  double median;   ///< the median ratio of the rounds of each seed, then the median over seeds, of logarithms
  std::optional<Interval> interval;  ///< by bootstrap; empty if there are too few rounds
  std::size_t rounds;                ///< in which both took part
  double ms = 0;                     ///< the median time of these rounds, as measured
  double of_ms = 0;                  ///< likewise for the other algorithm; with fewer algorithms taking
                                     ///< turns, times are lower
};

/// Whether algorithms of this kind are not part of the library that users link: they are compared, but never
/// advised.
constexpr bool is_foreign(AlgorithmKind kind) noexcept {
  return kind == AlgorithmKind::literature || kind == AlgorithmKind::peer;
}

/// The measurement of one algorithm in one case. Counts (pairs, hash, statistics, bytes) are of the first
/// seed.
struct Measurement {
  std::string algorithm;  ///< its spec
  std::string version;    ///< of the library behind it
  AlgorithmKind kind = AlgorithmKind::own;
  std::size_t threads = 1;
  std::string target{};  ///< the instruction set of its kernels; empty for algorithms that are not
                         ///< Broadside's

  Outcome outcome = Outcome::skipped;
  std::optional<Evidence> evidence;    ///< empty if nothing was compared
  std::string reason;                  ///< why there is no time: the first divergence, or why it was skipped
  std::optional<double> estimated_ms;  ///< if it was skipped because of its budget: per call or frame

  std::vector<double> samples_ms;     ///< each a whole call, from boxes to pairs, or a frame
  std::size_t samples_per_round = 1;  ///< the number of a history's frames; round r of all entries uses the
                                      ///< same boxes
  std::optional<double> build_ms{};   ///< in motion: the first frame, in which all is new; the median
  std::optional<std::uint64_t> pairs;
  std::optional<std::uint64_t> pair_hash;
  std::optional<Statistics> statistics;
  std::vector<std::optional<Statistics>> statistics_by_seed{};  ///< of each measured seed
  std::vector<paper::Phases> phases{};                          ///< of each sample; empty if not requested
  std::string explanation{};                ///< of an algorithm that chooses: its choice and the reason; of a
                                            ///< peer: the cost of its library's build
  std::optional<std::uint64_t> own_bytes;   ///< memory that the algorithm holds between calls
  std::optional<std::uint64_t> peak_bytes;  ///< maximum memory at one moment, in or between calls

  std::optional<PairedRatio> to_fastest{};       ///< ratio of its time to that of the case's fastest,
  std::optional<PairedRatio> to_best_own{};      ///< to that of the fastest of Broadside's algorithms other
                                                 ///< than auto,
  std::optional<PairedRatio> to_fastest_peer{};  ///< and to that of the fastest other library
};

/// A case and its measurements, in the order of the entries.
struct CaseResult {
  Case of;
  std::vector<Measurement> measurements;
  std::vector<double> floor_ms{};  ///< times of the lower bound (floor.hpp) in each round; empty if it does
                                   ///< not apply
};

/// How much time an algorithm may take in a case. Each takes part in the first rounds of the case, without
/// gaps.
struct Effort {
  double budget_seconds = 0.25;       ///< per search; slower algorithms are skipped
  double history_seconds = 1;         ///< per history, from its first frame to its last; likewise
  double share_seconds = 0.1;         ///< an algorithm's timed calls end once they sum to this,
  std::size_t min_rounds = 8;         ///< but not before this many rounds,
  std::size_t max_rounds = 100;       ///< and at the latest after this many
  double slow_seconds = 0.1;          ///< a search that takes longer has slow_rounds rounds
  double slow_history_seconds = 0.8;  ///< a history that takes longer has slow_rounds rounds
  std::size_t slow_rounds = 5;
  std::size_t definition_boxes =
      20'000;  ///< searches of more boxes are not checked by brute force; nor are histories that
               ///< need more than four times the tests of such a search
  double limit_seconds =
      10;  ///< a call that takes longer than this and than ten times its budget counts as hanging
  double far_ratio = 1.5;  ///< an algorithm that takes more than this many times the time of both the fastest
                           ///< other library and our fastest (and more than far_from_seconds) has far_rounds
                           ///< rounds
  std::size_t far_rounds = 3;
  double case_seconds =
      std::numeric_limits<double>::infinity();  ///< no round begins after this, except the first two
};

/// Rounds shorter than this cost almost nothing, so no algorithm counts as far behind.
inline constexpr double far_from_seconds = 0.002;

}  // namespace broadside::lab
