// The worst-case hunt: measures inputs with every algorithm, over uniform boxes and over the best algorithm.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "bench/worst/measure.hpp"
#include "lab/catalogue.hpp"
#include "lab/worst/hard_input.hpp"

namespace broadside::bench {

/// Limits that are still acceptable.
struct Bounds {
  double auto_over_uniform = 12;
  double auto_over_best = 4;
  double over_uniform = 100;        ///< for every other algorithm
  double auto_bytes_per_box = 200;  ///< for a search
};

/// Settings of a hunt.
struct Hunt {
  std::vector<lab::Entry> algorithms;
  std::vector<lab::Entry> references{};  ///< tried in turn if only one algorithm finished
  HuntEffort effort{};
  double limit_seconds = 10;      ///< for a run
  double reference_seconds = 30;  ///< for a run of a reference
  bool judges_auto = false;       ///< others run only as long as they may still be the best
  Bounds bounds{};
};

/// An algorithm on an input. A ratio is 0 if there is no time.
struct Finding {
  std::string algorithm;
  MeasuredRun run;
  double over_uniform = 0;  ///< its time over its own time on uniform boxes; a lower bound if it was too slow
  double tests_over_uniform =
      0;                 ///< its tests over its own tests on uniform boxes; 0 if it does not count them
  double over_best = 0;  ///< its time over the shortest time on this input
};

/// An input, and the results of all algorithms.
struct InputResult {
  enum class State { measured, too_many_pairs, unverified, differing };

  lab::HardInput input;
  State state = State::measured;
  std::vector<Finding> findings{};
  std::string best{};   ///< the fastest algorithm
  double pairs = 0;     ///< per box; for trackers, pairs of the first frame
  double events = 0;    ///< for trackers, per box and frame
  std::string fault{};  ///< what differs, or which algorithm threw what
};

/// Whether the algorithm is above its bounds on this input. Memory is bounded for searches only.
bool is_above(const Finding& finding, const InputResult& result, const Bounds& bounds);

/// Measures inputs. Uniform boxes are measured on first use, once for each kind of call.
class Hunter {
 public:
  explicit Hunter(Hunt hunt) : hunt_(std::move(hunt)) {}

  /// Measures an input. If an algorithm is above its bounds, all are measured once more, uniform boxes too,
  /// and the shorter times count: other load on the machine only makes times longer.
  InputResult measure(const lab::HardInput& input);

 private:
  /// The run of each algorithm on an input, without the references.
  using Runs = std::vector<MeasuredRun>;

  Runs run_all(const RunAlgorithm& run, bool is_uniform) const;
  const Runs& uniform(const lab::HardInput& input, bool again);
  void check(InputResult& result, const RunAlgorithm& run) const;
  InputResult judged(const lab::HardInput& input, const Runs& runs, const Runs& uniform) const;

  Hunt hunt_;
  std::map<std::string, Runs> uniform_;  // by the text of the input
};

}  // namespace broadside::bench
