// The worst-case hunt: inputs measured with every algorithm, over uniform boxes and over the best algorithm.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "bench/worst/measure.hpp"
#include "lab/catalogue.hpp"
#include "lab/worst/hard_input.hpp"

namespace broadside::bench {

/// The most that is let be.
struct Bounds {
  double auto_over_uniform = 12;
  double auto_over_best = 4;
  double over_uniform = 100;        ///< of every other algorithm
  double auto_bytes_per_box = 200;  ///< of a search
};

/// What is hunted with.
struct Hunt {
  std::vector<lab::Entry> algorithms;
  std::vector<lab::Entry> references{};  ///< asked in turn where only one algorithm finished
  HuntEffort effort{};
  double limit_seconds = 10;      ///< for a run
  double reference_seconds = 30;  ///< for that of a reference
  bool judges_auto = false;       ///< others are run only as long as they may be the best
  Bounds bounds{};
};

/// An algorithm on an input. Ratios are 0 where there is no time.
struct Finding {
  std::string algorithm;
  MeasuredRun run;
  double over_uniform = 0;        ///< its time over its own on uniform boxes; a limit where it was too slow
  double tests_over_uniform = 0;  ///< likewise; 0 where it does not count
  double over_best = 0;           ///< its time over the least on this input
};

/// An input, and how all algorithms did.
struct InputResult {
  enum class State { measured, too_many_pairs, unverified, differing };

  lab::HardInput input;
  State state = State::measured;
  std::vector<Finding> findings{};
  std::string best{};   ///< the fastest algorithm
  double pairs = 0;     ///< a box; of trackers those of the first frame
  double events = 0;    ///< of trackers, a box and frame
  std::string fault{};  ///< what differs, or which algorithm threw what
};

/// Whether the algorithm is above its bounds on this input. Memory is bounded for searches alone.
bool is_above(const Finding& finding, const InputResult& result, const Bounds& bounds);

/// Measures inputs. Uniform boxes are measured when they are needed first, once for each way of asking.
class Hunter {
 public:
  explicit Hunter(Hunt hunt) : hunt_(std::move(hunt)) {}

  /// Measures an input. Where an algorithm is above its bounds, all are measured once more, uniform boxes
  /// too, and the lesser times count: what else the machine does makes times longer and never shorter.
  InputResult measure(const lab::HardInput& input);

 private:
  /// The run of each algorithm on an input, the references not among them.
  using Runs = std::vector<MeasuredRun>;

  Runs run_all(const RunAlgorithm& run, bool is_uniform) const;
  const Runs& uniform(const lab::HardInput& input, bool again);
  void check(InputResult& result, const RunAlgorithm& run) const;
  InputResult judged(const lab::HardInput& input, const Runs& runs, const Runs& uniform) const;

  Hunt hunt_;
  std::map<std::string, Runs> uniform_;  // by the text of the input
};

}  // namespace broadside::bench
