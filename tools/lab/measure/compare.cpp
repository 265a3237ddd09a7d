// The comparison: measures algorithms on many cases, and checks every result.
#include "lab/measure/compare.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "lab/measure/cases.hpp"
#include "lab/measure/paired_ratio.hpp"
#include "lab/measure/reference.hpp"
#include "lab/measure/rounds.hpp"
#include "lab/measure/steadiness.hpp"
#include "lab/numbers.hpp"
#include "lab/platform/machine.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::lab {
namespace {

/// How many seeds of a case are taken in turn. A history's frames already differ.
std::size_t seeds_for(std::size_t boxes, Mode mode) {
  if (mode == Mode::find) return inputs_in_rotation(boxes);
  return boxes <= 2'000 ? 4 : boxes < 500'000 ? 2 : 1;
}

template <int D>
std::size_t max_boxes(const History<D>& history) {
  std::size_t max_size = history.boxes.size();
  for (const Step<D>& step : history.steps) max_size = std::max(max_size, step.size);
  return max_size;
}

template <int D>
double moving_fraction(const History<D>& history) {
  double sum = 0;
  for (const Step<D>& step : history.steps)
    sum +=
        static_cast<double>(step.changed.size()) / static_cast<double>(std::max<std::size_t>(step.size, 1));
  return history.steps.empty() ? 0 : sum / static_cast<double>(history.steps.size());
}

/// Refuses motion whose steps and expected events would exceed the memory.
template <int D>
void check_steps(const CaseRequest& request) {
  constexpr double max_bytes = 4e9;  // bytes
  const double moved =
      request.moving * static_cast<double>(request.boxes) * static_cast<double>(request.frames);
  // If boxes have some neighbours, about as many pairs begin or end in a frame as boxes move.
  const double taken = moved * static_cast<double>(sizeof(Box<D>) + sizeof(BoxId) + 2 * sizeof(Pair));
  if (taken > max_bytes) {
    throw std::runtime_error(fmt::format(
        "{} frames of {:.0f} boxes that move are about {:.1f} GB; expected at most {:.0f} GB, since "
        "they are kept to be followed again",
        request.frames, request.moving * static_cast<double>(request.boxes), taken / 1e9, max_bytes / 1e9));
  }
}

/// Moves a fraction of the boxes, drawn at random but always the same ones, to the front.
template <int D>
void split(std::vector<Box<D>>& boxes, double left) {
  std::vector<Box<D>> chosen;
  std::vector<Box<D>> others;
  const std::vector<std::size_t> sample = sample_of(boxes.size(), left_count(left, boxes.size()));
  auto next = sample.begin();
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const bool is_chosen = next != sample.end() && *next == i;
    if (is_chosen) ++next;
    (is_chosen ? chosen : others).push_back(boxes[i]);
  }
  std::ranges::copy(others, std::ranges::copy(chosen, boxes.begin()).out);
}

/// Filters of a game's boxes, by their places, as CaseRequest::filtered says.
std::vector<Filter> game_filters(std::size_t boxes) {
  enum Category : std::uint64_t { fixed = 1, body = 2, debris = 4, sensor = 8 };
  constexpr Filter of_fixed{.category = fixed, .mask = body | debris, .is_static = true};
  constexpr Filter of_body{.category = body, .mask = fixed | body | debris | sensor};
  constexpr Filter of_debris{.category = debris, .mask = fixed | body};
  constexpr Filter of_sensor{.category = sensor, .mask = body};
  constexpr std::array kinds = {of_fixed, of_fixed, of_body, of_body, of_debris, of_sensor};
  std::vector<Filter> filters;
  for (std::size_t i = 0; i < boxes; ++i) filters.push_back(kinds[detail::mixed(i) % kinds.size()]);
  return filters;
}

class Runner {
 public:
  Runner(const Catalogue& catalogue, const CompareOptions& options)
      : catalogue_(catalogue),
        options_(options),
        entries_(with_threads(catalogue.select(options.algorithms), options.threads)) {}

  Comparison run() {
    comparison_.load_before = platform::load();
    for (const CaseRequest& request : options_.plan) resolve(request);
    try {
      for (std::size_t i = 0; i < scenes_.size(); ++i) {
        if (!scenes_[i]) continue;
        place_ = fmt::format("[{}/{}] ", i + 1, scenes_.size());
        const CaseRequest& request = options_.plan[i];
        request.dimension == 2 ? run<2>(*scenes_[i], request) : run<3>(*scenes_[i], request);
      }
    } catch (const Stopped&) {
      comparison_.stopped = true;
    }
    comparison_.processor_share = share_.value();
    comparison_.load_after = platform::load();
    return std::move(comparison_);
  }

 private:
  /// Finds the scene and checks its values before anything is measured.
  void resolve(const CaseRequest& request) {
    scenes_.emplace_back();
    // Reads each file once.
    for (std::size_t i = 0; i + 1 < scenes_.size(); ++i) {
      if (options_.plan[i].scene == request.scene && scenes_[i]) scenes_.back() = scenes_[i];
    }
    if (scenes_.back()) return;
    try {
      scenes_.back() = options_.find(request.scene);
      if (const std::string& warning = scenes_.back()->scene.warning; !warning.empty())
        comparison_.warnings.push_back(warning);
    } catch (const std::exception& thrown) {
      if (request.required) throw;
      comparison_.not_compared.push_back({request, thrown.what()});
    }
  }

  template <int D>
  void run(const NamedScene& named, const CaseRequest& request) {
    std::string name = fmt::format("{}{} {}D", place_, request.scene, D);
    if (request.boxes > 0) name += fmt::format(", {} boxes", grouped(request.boxes));
    const Watch watch{options_.watch.stop, [&](std::string_view what) {
                        if (options_.watch.progress)
                          options_.watch.progress(fmt::format("{}: {}", name, what));
                      }};
    Case of;
    std::vector<History<D>> inputs;
    try {
      make_inputs(named, request, watch, of, inputs);
    } catch (const Stopped&) {
      throw;
    } catch (const std::exception& thrown) {
      if (request.required) throw;
      comparison_.not_compared.push_back({request, thrown.what()});
      return;
    }
    Effort effort = options_.effort;
    if (!options_.measure_options.times)
      effort.min_rounds = effort.max_rounds = effort.slow_rounds = effort.far_rounds = inputs.size();
    const Benchmark benchmark{entries_, catalogue_.algorithms(), effort, watch, options_.measure_options};
    comparison_.cases.push_back(measure_case<D>(of, inputs, benchmark, hung_));
    add_ratios(comparison_.cases.back());
    if (options_.finished) options_.finished(comparison_.cases.back());
  }

  template <int D>
  void make_inputs(const NamedScene& named, const CaseRequest& request, const Watch& watch, Case& of,
                   std::vector<History<D>>& inputs) {
    watch.at("making the boxes");
    const auto make = [&](std::uint64_t seed) {
      of.seeds.push_back(seed);
      inputs.push_back(make_history<D>(named.scene, named.spec,
                                       {.boxes = request.boxes,
                                        .seed = seed,
                                        .frames = request.frames,
                                        .moving = request.moving,
                                        .drift = request.drift,
                                        .teleport = request.teleport}));
      History<D>& input = inputs.back();
      if (request.left > 0 || request.filtered) input.steps.clear();
      if (request.left > 0) split(input.boxes, request.left);
      if (request.filtered) {
        const std::vector<Filter> filters = game_filters(input.boxes.size());
        input.filters.assign(filters.begin(), filters.end());
      }
    };
    check_steps<D>(request);
    make(options_.seed);
    check_pair_count<D>(inputs[0].boxes);
    of.scene = named.spec.text();
    const Settings settings(named.spec, named.scene.tunables);
    for (const Tunable& tunable : named.scene.tunables)
      of.parameters.emplace_back(tunable.name, settings.text(tunable.name));
    of.dimension = D;
    of.boxes = max_boxes(inputs[0]);
    of.frames = inputs[0].steps.size();
    of.moving = moving_fraction(inputs[0]);
    of.left = request.left;
    of.filtered = request.filtered;
    of.mode = of.frames == 0 ? Mode::find : Mode::track;
    if (of.mode == Mode::track && request.moving > 0) {
      of.drift = request.drift;
      of.teleport = request.teleport;
    }
    const std::size_t wanted = options_.seeds > 0 ? options_.seeds : seeds_for(of.boxes, of.mode);
    const std::size_t seeds = named.scene.fixed_seed ? 1 : wanted;
    for (std::size_t i = 1; i < seeds; ++i) make(options_.seed + i);
  }

  const Catalogue& catalogue_;
  const CompareOptions& options_;
  std::vector<Entry> entries_;
  std::vector<std::optional<NamedScene>> scenes_;  // of the plan's cases; empty if it does not exist
  std::string place_;                              // position of the current case in the plan
  std::vector<std::string> hung_;                  // algorithms that did not return in an earlier case
  Comparison comparison_;
  ProcessorShare share_;
};

}  // namespace

bool Comparison::all_verified() const {
  bool any_verified = false;
  for (const CaseResult& result : cases) {
    for (const Measurement& measurement : result.measurements) {
      if (measurement.outcome == Outcome::failed) return false;
      any_verified = any_verified || measurement.outcome == Outcome::verified;
    }
  }
  return any_verified;
}

Comparison compare(const Catalogue& catalogue, const CompareOptions& options) {
  return Runner(catalogue, options).run();
}

}  // namespace broadside::lab
