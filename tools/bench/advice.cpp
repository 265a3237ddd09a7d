// Measures how good `advise` is: advice [quick|long] [BUDGET] [SCENES]. For each case of a comparison plan
// (of the long plan, only cases of 5,000 to 100,000 boxes), it asks for advice on the boxes of the first
// seed. It then measures everything that could have been advised in alternating rounds, on all seeds of the
// comparison, and prints the time of the advised algorithm over the best time.
#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bench/guarded.hpp"
#include "lab/advise/advise.hpp"
#include "lab/catalogue.hpp"
#include "lab/measure/compare.hpp"
#include "lab/measure/ranking.hpp"
#include "lab/measure/samples.hpp"
#include "lab/numbers.hpp"
#include "lab/report/machine.hpp"

namespace broadside::bench {
namespace {

/// Algorithms that advice itself measured as slower than the best by this factor are not measured again.
constexpr double margin_of_rivals = 2;

template <int D>
lab::Advice advise(const lab::Catalogue& catalogue, const lab::CaseRequest& request, double budget) {
  const lab::NamedScene named = lab::find_scene(request.scene);
  const lab::History<D> history = lab::make_history<D>(named.scene, named.spec,
                                                       {.boxes = request.boxes,
                                                        .seed = 1,
                                                        .frames = request.frames,
                                                        .moving = request.moving,
                                                        .drift = request.drift,
                                                        .teleport = request.teleport});
  lab::AdviseOptions options;
  options.budget_seconds = budget;
  return lab::advise(catalogue, request.scene, history, options);
}

/// Prints one line of the table and returns its ratio.
double measure(const lab::Catalogue& catalogue, const lab::CaseRequest& request, double budget) {
  const lab::Advice advice =
      request.dimension == 2 ? advise<2>(catalogue, request, budget) : advise<3>(catalogue, request, budget);
  if (!advice.all_verified())
    throw std::runtime_error(request.scene + ": not verified; expected everything to be");
  std::vector<std::string> specs;
  for (const lab::RankedAlgorithm& ranked : advice.ranking) {
    if (ranked.milliseconds <= margin_of_rivals * advice.milliseconds)
      specs.push_back(ranked.measurement.algorithm);
  }
  lab::CompareOptions options;
  options.algorithms = fmt::format("{}", fmt::join(specs, ","));
  options.plan = {request};
  options.effort = {.budget_seconds = 10,
                    .history_seconds = 20,
                    .share_seconds = budget / static_cast<double>(specs.size()),
                    .min_rounds = 9,
                    .max_rounds = 400,
                    .slow_seconds = 5,
                    .slow_history_seconds = 5,
                    .slow_rounds = 1};
  const lab::Comparison comparison = lab::compare(catalogue, options);
  if (!comparison.all_verified())
    throw std::runtime_error(request.scene + ": not verified; expected everything to be");
  const lab::CaseResult& result = comparison.cases.at(0);
  const lab::Measurement* best = nullptr;
  const lab::Measurement* named = nullptr;
  const auto time = [&](const lab::Measurement& m) {
    const std::size_t inputs = result.of.seeds.size();
    return result.of.mode == lab::Mode::find ? lab::undisturbed(m.samples_ms, inputs)
                                             : lab::undisturbed_mean(m.samples_ms, inputs * result.of.frames);
  };
  for (const lab::Measurement& measurement : result.measurements) {
    if (measurement.algorithm == advice.spec) named = &measurement;
    if (best == nullptr || time(measurement) < time(*best)) best = &measurement;
  }
  const double ratio = time(*named) / time(*best);
  std::string name = lab::name_of(result.of);
  if (result.of.mode == lab::Mode::track) name += fmt::format(", {:.3g} % moving", result.of.moving * 100);
  fmt::print("{:<58} {:<28} {:>9} {:>6.2f}  {}\n", name, advice.spec, lab::duration(time(*named) / 1e3),
             ratio, best->algorithm);
  std::fflush(stdout);
  return ratio;
}

bool is_wanted(const lab::CaseRequest& request, bool is_long, const std::string& scenes) {
  if (!scenes.empty() && ("," + scenes + ",").find("," + request.scene + ",") == std::string::npos)
    return false;
  if (request.left > 0) return false;  // there is no advice for two sets
  return !is_long || (request.boxes >= 5'000 && request.boxes <= 100'000);
}

void run(bool is_long, double budget, const std::string& scenes) {
  const lab::Machine machine = lab::this_machine();
  fmt::print("{} comparison, {} s each; {}, {} cores; {}\n", is_long ? "long" : "quick", budget, machine.cpu,
             machine.cores, lab::this_build().compiler);
  fmt::print("{:<58} {:<28} {:>9} {:>6}  {}\n", "case", "advice", "time", "ratio", "the best");
  const lab::Catalogue catalogue;
  std::vector<double> ratios;
  for (const lab::CaseRequest& request : is_long ? lab::long_plan() : lab::quick_plan()) {
    if (is_wanted(request, is_long, scenes)) ratios.push_back(measure(catalogue, request, budget));
  }
  if (ratios.empty()) throw std::runtime_error("no case; expected scenes of the plan");
  fmt::print("{}: geometric mean {:.3f}, worst {:.3f}\n", lab::counted(ratios.size(), "case", "cases"),
             lab::geometric_mean(ratios), std::ranges::max(ratios));
}

}  // namespace
}  // namespace broadside::bench

int main(int count, char** arguments) {
  using namespace broadside::bench;
  return guarded("advice", 1, [&] {
    const std::string plan = text_at(count, arguments, 1, "quick");
    if (plan != "quick" && plan != "long")
      throw std::runtime_error("the plan is '" + plan + "'; expected quick or long");
    run(plan == "long", count > 2 ? std::stod(arguments[2]) : 3, text_at(count, arguments, 3, ""));
    return 0;
  });
}
