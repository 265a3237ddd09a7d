// The paper's followers on a history, frame by frame.
#include "paper/experiments/mending.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "broadside/find_pairs.hpp"
#include "broadside/sinks.hpp"
#include "broadside/tracker.hpp"

#include "lab/measure/paired_ratio.hpp"
#include "lab/measure/samples.hpp"
#include "paper/experiments/laboratory.hpp"
#include "paper/listings/coherent_follower.hpp"

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

template <int D>
void play(const std::string& spec, const History<D>& history, const std::vector<FrameEvents>& expected,
          MendingCost& cost) {
  const Spec parsed(spec);
  const Algorithm& algorithm = *find_algorithm(parsed.name);
  std::unique_ptr<Follower<D>> follower =
      algorithm.in<D>().followers.front().make(Settings(parsed, algorithm.tunables));
  auto& coherent = dynamic_cast<paper::CoherentFollower<D>&>(*follower);
  coherent.record_phases();
  Tracker<D> tracker(std::move(follower));
  std::vector<Box<D>> boxes = history.boxes;
  FrameEvents events;
  PairCollector begun(events.begun);
  PairCollector ended(events.ended);
  tracker.update({boxes, {}}, begun, ended);
  for (std::size_t i = 0; i < history.steps.size(); ++i) {
    apply(history.steps[i], boxes);
    events.begun.clear();
    events.ended.clear();
    const Stopwatch watch;
    const std::optional<Statistics> statistics =
        tracker.update({boxes, history.steps[i].changed}, begun, ended);
    cost.frame.all.push_back(watch.milliseconds());
    const paper::Phases& parts = coherent.phases();
    cost.detecting.all.push_back(parts.detecting_ms);
    cost.mending.all.push_back(parts.mending_ms);
    cost.searching.all.push_back(parts.searching_ms);
    cost.moved += static_cast<double>(parts.moved);
    cost.visited += static_cast<double>(parts.visited);
    cost.movers += static_cast<double>(parts.movers);
    cost.references += static_cast<double>(statistics.value().references) / static_cast<double>(boxes.size());
    if (events != expected[i])
      throw std::runtime_error(
          fmt::format("{}: events of frame {} are wrong; expected those of the library's "
                      "search",
                      spec, i + 1));
  }
}

/// The times, none of them nothing: what a clock of whole nanoseconds did not see took less than one.
std::vector<double> positive(std::vector<double> times) {
  for (double& time : times) time = std::max(time, 1e-6);
  return times;
}

}  // namespace

double FrameTimes::median() const { return lab::median(all); }

FrameTimes operator+(const FrameTimes& a, const FrameTimes& b) {
  FrameTimes sum = a;
  for (std::size_t i = 0; i < sum.all.size(); ++i) sum.all[i] += b.all[i];
  return sum;
}

double MendingCost::mover_ns() const { return 1e6 * mending.median() / std::max(1.0, movers); }

std::vector<Cell> ratio_cells(const FrameTimes& times, const FrameTimes& others) {
  // Frames are to a history what seeds are to a scene.
  const RatiosBySeed ratios(positive(times.all), positive(others.all), times.frames);
  const double middle = ratios.median();
  const Interval interval = ratios.interval().value_or(Interval{middle, middle});
  return {middle, interval.low, interval.high};
}

template <int D>
std::vector<MendingCost> measure_mending(const Laboratory& laboratory, const std::vector<std::string>& specs,
                                         const std::string& name, const History<D>& history) {
  const std::vector<FrameEvents> expected = expected_events<D>(history);
  std::vector<MendingCost> costs(specs.size());
  const Stopwatch watch;
  const double budget_ms = laboratory.either(1000.0, 100.0) * static_cast<double>(specs.size());
  const std::size_t rounds = laboratory.either<std::size_t>(7, 2);
  for (std::size_t round = 0; round < rounds && (round < 2 || watch.milliseconds() < budget_ms); ++round) {
    for (std::size_t i = 0; i < specs.size(); ++i) {
      laboratory.at(fmt::format("{} on {} of {} boxes", specs[i], name, history.boxes.size()));
      play<D>(specs[i], history, expected, costs[i]);
    }
  }
  for (MendingCost& cost : costs) {
    const auto frames = static_cast<double>(cost.frame.all.size());
    for (FrameTimes* const times : {&cost.detecting, &cost.mending, &cost.searching, &cost.frame})
      times->frames = history.steps.size();
    cost.moved /= std::max(1.0, cost.movers);
    cost.visited /= std::max(1.0, cost.movers);
    cost.movers /= frames;
    cost.references /= frames;
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
