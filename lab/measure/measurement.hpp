// The lab's records: what was compared, and what came of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "broadside/algorithm.hpp"

namespace broadside::lab {

/// Whether all pairs are found from nothing, or followed from frame to frame.
enum class Mode { find, track };

/// What algorithms were compared on.
struct Case {
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

/// What came of letting an algorithm into a case.
enum class Outcome {
  verified,  ///< it was timed, and every pair or event of every timed call was right
  failed,    ///< it broke the law; its times are of no interest and not kept
  skipped    ///< it was not let in
};

/// One algorithm in one case. What was counted (pairs, hash, statistics, bytes) is of the first seed.
struct Measurement {
  std::string algorithm;  ///< its spec
  std::string version;    ///< of the library behind it
  AlgorithmKind kind = AlgorithmKind::own;
  std::size_t threads = 1;

  Outcome outcome = Outcome::skipped;
  std::string verified_by;             ///< what the pairs were compared with; empty where they were not
  std::string reason;                  ///< why there is no time: what diverged first, or why it was skipped
  std::optional<double> estimated_ms;  ///< where it was skipped for its budget: a call or a frame

  std::vector<double> samples_ms;    ///< each a whole call, from boxes to pairs, or a frame
  std::optional<double> build_ms{};  ///< in motion: the first frame, in which all is new; the median
  std::optional<std::uint64_t> pairs;
  std::optional<std::uint64_t> pair_hash;
  std::optional<Statistics> statistics;
  std::string explanation{};                ///< of an algorithm that chooses: what it chose, and why
  std::optional<std::uint64_t> own_bytes;   ///< what the algorithm holds between calls
  std::optional<std::uint64_t> peak_bytes;  ///< the most it holds at one moment, in or between calls
};

/// A case and its measurements, in the order of the contenders.
struct CaseResult {
  Case of;
  std::vector<Measurement> measurements;
  std::vector<double> floor_ms{};  ///< samples of the floor (floor.hpp); none where it makes no sense
};

/// How much time an algorithm may take in a case.
struct Effort {
  double budget_seconds = 0.25;        ///< for one search; above it the algorithm is skipped
  double history_seconds = 0.3;        ///< likewise for a whole history, from its first frame to its last
  double share_seconds = 0.02;         ///< timed calls go on until they have taken this long together ...
  std::size_t least_samples = 3;       ///< ... and are at least so many ...
  std::size_t most_samples = 100;      ///< ... and at most so many ...
  double single_sample_seconds = 0.3;  ///< ... unless one takes so long that it is left at one
};

}  // namespace broadside::lab
