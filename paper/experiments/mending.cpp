// The paper's trackers on a history, frame by frame.
#include "paper/experiments/mending.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include <fmt/format.h>

#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"

#include "lab/measure/samples.hpp"
#include "paper/experiments/laboratory.hpp"
#include "paper/listings/coherent_tracker.hpp"

namespace broadside::lab {
namespace {

struct FrameEvents {
  std::vector<Pair> begun;
  std::vector<Pair> ended;

  friend bool operator==(const FrameEvents&, const FrameEvents&) = default;
};

template <int D>
std::vector<Pair> sorted_pairs(const std::vector<Box<D>>& boxes) {
  std::vector<Pair> pairs = find_pairs(boxes);
  for (Pair& pair : pairs) {
    if (pair.second < pair.first) std::swap(pair.first, pair.second);
  }
  std::ranges::sort(pairs);
  return pairs;
}

/// The events of each frame: what differs between the pairs that the library's own search finds.
template <int D>
std::vector<FrameEvents> expected_events(const History<D>& history) {
  std::vector<Box<D>> boxes = history.boxes;
  std::vector<Pair> before = sorted_pairs<D>(boxes);
  std::vector<FrameEvents> all;
  for (const Step<D>& step : history.steps) {
    apply(step, boxes);
    std::vector<Pair> now = sorted_pairs<D>(boxes);
    FrameEvents& events = all.emplace_back();
    std::ranges::set_difference(now, before, std::back_inserter(events.begun));
    std::ranges::set_difference(before, now, std::back_inserter(events.ended));
    before = std::move(now);
  }
  return all;
}

struct Samples {
  std::vector<double> mending_ms;
  std::vector<double> structure_ms;
  std::vector<double> searching_ms;
  std::vector<double> frame_ms;
  double moved = 0;
  double visited = 0;
  double movers = 0;
  double references = 0;
};

template <int D>
void play(const std::string& spec, const History<D>& history, const std::vector<FrameEvents>& expected,
          Samples& samples) {
  const auto tracker = make_tracker<D>(spec);
  const auto& coherent = dynamic_cast<const paper::CoherentTracker<D>&>(*tracker);
  std::vector<Box<D>> boxes = history.boxes;
  FrameEvents events;
  PairCollector begun(events.begun);
  PairCollector ended(events.ended);
  tracker->update({boxes, {}}, begun, ended);
  for (std::size_t i = 0; i < history.steps.size(); ++i) {
    apply(history.steps[i], boxes);
    events.begun.clear();
    events.ended.clear();
    const Stopwatch watch;
    tracker->update({boxes, history.steps[i].changed}, begun, ended);
    samples.frame_ms.push_back(watch.milliseconds());
    const paper::UpdateParts& parts = coherent.parts();
    samples.mending_ms.push_back(parts.detecting_ms + parts.mending_ms);
    samples.structure_ms.push_back(parts.mending_ms);
    samples.searching_ms.push_back(parts.searching_ms);
    samples.moved += static_cast<double>(parts.moved);
    samples.visited += static_cast<double>(parts.visited);
    samples.movers += static_cast<double>(parts.movers);
    samples.references +=
        static_cast<double>(tracker->statistics()->references) / static_cast<double>(boxes.size());
    if (events != expected[i])
      throw std::runtime_error(
          fmt::format("{}: events of frame {} are wrong; expected those of the library's "
                      "search",
                      spec, i + 1));
  }
}

}  // namespace

template <int D>
std::vector<MendingCost> measure_mending(const Laboratory& laboratory, const std::vector<std::string>& specs,
                                         const std::string& name, const History<D>& history) {
  const std::vector<FrameEvents> expected = expected_events<D>(history);
  std::vector<Samples> all(specs.size());
  const Stopwatch watch;
  const double budget_ms = laboratory.either(1000.0, 100.0) * static_cast<double>(specs.size());
  const std::size_t rounds = laboratory.either<std::size_t>(7, 2);
  for (std::size_t round = 0; round < rounds && (round < 2 || watch.milliseconds() < budget_ms); ++round) {
    for (std::size_t i = 0; i < specs.size(); ++i) {
      laboratory.at(fmt::format("{} on {} of {} boxes", specs[i], name, history.boxes.size()));
      play<D>(specs[i], history, expected, all[i]);
    }
  }
  std::vector<MendingCost> costs;
  for (const Samples& samples : all) {
    const auto frames = static_cast<double>(samples.frame_ms.size());
    const double mending = median(samples.mending_ms);
    costs.push_back({.mending_ms = mending,
                     .structure_ms = median(samples.structure_ms),
                     .searching_ms = median(samples.searching_ms),
                     .frame_ms = median(samples.frame_ms),
                     .moved = samples.moved / std::max(1.0, samples.movers),
                     .visited = samples.visited / std::max(1.0, samples.movers),
                     .references = samples.references / frames,
                     .mover_ns = 1e6 * mending / std::max(1.0, samples.movers / frames)});
  }
  return costs;
}

template <int D>
std::vector<MendingCost> measure_mending(const Laboratory& laboratory, const std::vector<std::string>& specs,
                                         const CaseRequest& request) {
  return measure_mending<D>(laboratory, specs, request.scene,
                            history_of<D>(request.scene, {.boxes = request.boxes,
                                                          .frames = request.frames,
                                                          .moving = request.moving,
                                                          .drift = request.drift,
                                                          .teleport = request.teleport}));
}

std::vector<std::string> sweeps_by(const std::vector<std::string>& updates) {
  std::vector<std::string> specs;
  for (const std::string& update : updates) specs.push_back("paper_sweep_and_prune:update=" + update);
  return specs;
}

template std::vector<MendingCost> measure_mending<2>(const Laboratory&, const std::vector<std::string>&,
                                                     const CaseRequest&);
template std::vector<MendingCost> measure_mending<3>(const Laboratory&, const std::vector<std::string>&,
                                                     const CaseRequest&);

template std::vector<MendingCost> measure_mending<2>(const Laboratory&, const std::vector<std::string>&,
                                                     const std::string&, const History<2>&);
template std::vector<MendingCost> measure_mending<3>(const Laboratory&, const std::vector<std::string>&,
                                                     const std::string&, const History<3>&);

}  // namespace broadside::lab
