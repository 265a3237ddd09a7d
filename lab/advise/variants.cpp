// Which settings of an algorithm's tunables may suit given boxes better than those it chooses itself.
#include "lab/advise/variants.hpp"

#include <algorithm>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace broadside::lab {
namespace {

/// A tunable and the values to try.
struct Trial {
  std::string_view tunable;
  std::vector<std::string> values;
};

/// Cells so many times as long as the longest side that three quarters of the boxes do not exceed.
std::vector<std::string> cells(const Signals& signals) {
  const double side = signals.sizes[3];
  std::vector<std::string> values;
  if (!(side > 0)) return values;
  // A cell is given in float.
  for (const double times : {1.0, 2.0, 4.0, 8.0, 16.0}) {
    if (side * times > 1e-30 && side * times < 1e30) values.push_back(fmt::format("{:.3g}", side * times));
  }
  return values;
}

/// What one may set of an algorithm when all is still, or when boxes move.
std::vector<Trial> trials_of(std::string_view algorithm, const Signals& signals) {
  const bool moves = signals.motion.has_value();
  std::vector<Trial> trials;
  if (algorithm == "auto" && moves) trials.push_back({"way", {"rebuild", "incremental"}});
  if (algorithm == "brute_force" && moves) trials.push_back({"update", {"changed", "all"}});
  if (algorithm == "bvh" && moves) trials.push_back({"update", {"reinsert", "rebuild"}});
  if (algorithm == "grid") {
    trials.push_back({"cell", cells(signals)});
    if (moves) trials.push_back({"update", {"reinsert", "translate", "rebuild"}});
  }
  if (algorithm == "quadtree") {
    trials.push_back({"capacity", {"8", "16", "32", "64", "128"}});
    if (moves) trials.push_back({"update", {"root", "relative", "rebuild"}});
  }
  if (algorithm == "sweep_and_prune") {
    std::vector<std::string> axes;
    for (std::size_t axis = 0; axis < signals.axis_tests.size(); ++axis)
      axes.emplace_back(1, axis_name(axis));
    trials.push_back({"axis", axes});
    trials.push_back({"axes", {"1", "2"}});
    if (moves) trials.push_back({"update", {"insertion", "binary", "merge", "heap", "rebuild"}});
  }
  return trials;
}

}  // namespace

std::vector<Contender> variants_of(const Contender& contender, const Signals& signals) {
  std::vector<Contender> variants;
  if (contender.algorithm->kind != AlgorithmKind::own) return variants;
  for (const Trial& trial : trials_of(contender.algorithm->name, signals)) {
    const auto is_it = [&](const auto& value) { return value.first == trial.tunable; };
    const auto has_it = [&](const Tunable& tunable) { return tunable.name == trial.tunable; };
    if (std::ranges::any_of(contender.spec.values, is_it) ||
        std::ranges::none_of(contender.algorithm->tunables, has_it))
      continue;
    for (const std::string& value : trial.values) {
      variants.push_back(contender);
      variants.back().spec.values.emplace_back(trial.tunable, value);
    }
  }
  return variants;
}

}  // namespace broadside::lab
