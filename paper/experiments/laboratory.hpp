// What experiments measure with: algorithms in turns on a scene, every result checked.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "broadside/box.hpp"

#include "lab/catalogue.hpp"
#include "lab/measure/benchmark.hpp"
#include "lab/measure/measurement.hpp"
#include "lab/measure/plan.hpp"
#include "lab/measure/steadiness.hpp"
#include "lab/scenes/scene.hpp"
#include "paper/experiments/table.hpp"

namespace broadside::lab {

/// Where an experiment is done: how thorough it is, and what watches it.
class Laboratory {
 public:
  /// `quick` for a first impression: smaller numbers and fewer samples. All experiments then take
  /// less than three minutes on two cores, and less than twenty otherwise.
  Laboratory(const Catalogue& catalogue, bool quick, Watch watch = {})
      : catalogue_(&catalogue), quick_(quick), watch_(std::move(watch)) {}

  bool is_quick() const noexcept { return quick_; }

  /// The algorithms there are to measure.
  const Catalogue& catalogue() const noexcept { return *catalogue_; }

  /// One of two values, by how thorough the experiment is.
  template <typename Value>
  Value either(Value thorough, Value quick) const {
    return quick_ ? quick : thorough;
  }

  /// The time that a call of measure() may take, an algorithm: what is slower than its budget is skipped.
  Effort effort() const;

  /// Measures the algorithms that the list names (specs, as Catalogue::select reads them) in turns on a
  /// scene. Throws std::runtime_error if one of them breaks the law, and Stopped.
  CaseResult measure(const std::string& algorithms, const CaseRequest& request) const;
  CaseResult measure(const std::string& algorithms, const CaseRequest& request, const Effort& effort) const;

  /// The same on a scene of the experiment's own; `request.scene` is what it is called.
  CaseResult measure(const std::string& algorithms, const Scene& scene, const CaseRequest& request) const;

  /// The same of algorithms of the experiment's own.
  CaseResult measure(const Catalogue& catalogue, const std::string& algorithms, const CaseRequest& request,
                     const Effort& effort) const;

  /// How steady everything was that it has measured until now.
  const Steadiness& steadiness() const noexcept { return steadiness_; }

  /// Shows what is going on and asks whether to go on. Throws Stopped.
  void at(std::string_view what) const { watch_.at(what); }

 private:
  CaseResult measure(const Catalogue& catalogue, const std::string& algorithms, const CaseRequest& request,
                     const Effort& effort, const FindScene& find) const;

  const Catalogue* catalogue_;
  bool quick_;
  Watch watch_;
  mutable Steadiness steadiness_;  // measuring changes nothing else, and experiments only measure
};

/// These specs as the list that Laboratory::measure reads.
std::string list_of(const std::vector<std::string>& specs);

/// The measurement of the algorithm with this spec. Throws std::invalid_argument if it is not among them.
const Measurement& measurement_of(const CaseResult& result, std::string_view spec);

/// The median time in milliseconds; nothing where it was skipped.
Cell time_cell(const Measurement& measurement);

/// The time of one over that of another of the same case, in the rounds of both: three cells for the columns
/// of ratio_columns(). Nothing where one was skipped.
std::vector<Cell> ratio_cells(const CaseResult& result, const Measurement& measurement,
                              const Measurement& other);

/// Tests of pairs, and references, a call or a frame; nothing where they are not counted.
Cell tests_cell(const Measurement& measurement);
Cell references_cell(const Measurement& measurement);

/// What the algorithm holds between calls, in bytes; nothing where that is not counted.
Cell bytes_cell(const Measurement& measurement);

/// A number over another one, such as tests over boxes; nothing and text stay what they are.
Cell over(const Cell& cell, double divisor);

/// The boxes of the scene that `scene` names, in motion if the request has frames; throws as find_scene() and
/// make_history().
template <int D>
History<D> history_of(std::string_view scene, const SceneRequest& request) {
  const NamedScene named = find_scene(scene);
  return make_history<D>(named.scene, named.spec, request);
}

/// The least box that holds all of these; of none, the absent box.
template <int D>
Box<D> bounds_of(std::span<const Box<D>> boxes) {
  Box<D> bounds = absent_box<D>();
  for (const Box<D>& box : boxes) bounds = merged(bounds, box);
  return bounds;
}

}  // namespace broadside::lab
