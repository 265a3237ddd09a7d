// Chooses the advised algorithm, and the settings worth trying.
#include "lab/advise/algorithm_choice.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "lab/measure/paired_ratio.hpp"
#include "lab/measure/ranking.hpp"
#include "lab/measure/samples.hpp"

namespace broadside::lab {

namespace {

bool is_eligible(const Candidate& candidate) {
  return candidate.measurement->outcome == Outcome::verified && is_timed(*candidate.measurement);
}

bool is_peer(const Candidate& candidate) { return is_foreign(candidate.measurement->kind); }

/// The fastest sample of each input; inputs take turns in `samples`.
std::vector<double> min_samples(std::span<const double> samples, std::size_t inputs) {
  std::vector<double> minima(samples.begin(),
                             samples.begin() + static_cast<std::ptrdiff_t>(std::min(samples.size(), inputs)));
  for (std::size_t i = minima.size(); i < samples.size(); ++i)
    minima[i % inputs] = std::min(minima[i % inputs], samples[i]);
  return minima;
}

/// The fastest of the candidates that `counts` accepts; empty if there are none.
template <typename Counts>
std::optional<std::size_t> fastest(std::span<const Candidate> candidates, const Counts& counts) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (!is_eligible(candidates[i]) || !counts(candidates[i])) continue;
    if (!best || candidates[i].milliseconds < candidates[*best].milliseconds) best = i;
  }
  return best;
}

/// Whether it is "auto", with any number of threads.
bool is_auto(const Candidate& candidate) {
  const std::string& spec = candidate.measurement->algorithm;
  return !candidate.is_variant && spec.substr(0, spec.find(':')) == default_algorithm;
}

bool is_clearly_faster(const Candidate& variant, const Candidate& plain) {
  return variant.milliseconds * margin_of_variants <= plain.milliseconds &&
         plain.milliseconds - variant.milliseconds > indifferent_ms &&
         part_of_rounds(*variant.measurement, *plain.measurement) >= rounds_of_variants;
}

}  // namespace

double undisturbed(std::span<const double> samples, std::size_t inputs) {
  return median(min_samples(samples, inputs));
}

double undisturbed_mean(std::span<const double> samples, std::size_t inputs) {
  const std::vector<double> minima = min_samples(samples, inputs);
  if (minima.empty()) throw std::invalid_argument("0 samples; expected at least 1");
  return std::accumulate(minima.begin(), minima.end(), 0.0) / static_cast<double>(minima.size());
}

double part_of_rounds(const Measurement& a, const Measurement& b) {
  const std::vector<double> of_a = round_times(a);
  const std::vector<double> of_b = round_times(b);
  const std::size_t rounds = std::min(of_a.size(), of_b.size());
  std::size_t longer = 0;
  for (std::size_t i = 0; i < rounds; ++i) longer += static_cast<std::size_t>(of_b[i] > of_a[i]);
  return rounds == 0 ? 0 : static_cast<double>(longer) / static_cast<double>(rounds);
}

std::optional<AlgorithmChoice> choose(std::span<const Candidate> candidates, bool by_time) {
  const auto plain = fastest(
      candidates, [](const Candidate& candidate) { return !candidate.is_variant && !is_peer(candidate); });
  if (!plain) return std::nullopt;
  const double min_time = candidates[*plain].milliseconds;
  AlgorithmChoice choice{
      *plain, is_auto(candidates[*plain]) ? ChoiceReason::automatic : ChoiceReason::fastest, *plain, {}};
  const auto automatic = fastest(candidates, is_auto);
  if (automatic && !by_time) return AlgorithmChoice{*automatic, ChoiceReason::automatic, *plain, {}};
  if (automatic) {
    const double time = candidates[*automatic].milliseconds;
    if (time <= min_time * margin_of_auto || time - min_time <= indifferent_ms) {
      choice.chosen = *automatic;
      choice.why = ChoiceReason::automatic;
    }
  }
  const auto variant = fastest(candidates, [&](const Candidate& candidate) {
    return candidate.is_variant && !is_peer(candidate) && is_clearly_faster(candidate, candidates[*plain]);
  });
  if (variant) {
    choice.chosen = *variant;
    choice.why = ChoiceReason::variant;
  }
  const auto peer = fastest(candidates, is_peer);
  if (peer && candidates[*peer].milliseconds < candidates[choice.chosen].milliseconds) choice.peer = peer;
  return choice;
}

namespace {

/// A tunable and the values to try.
struct Trial {
  std::string_view tunable;
  std::vector<std::string> values;
};

/// Cell sizes to try: multiples of the upper quartile of the boxes' longest sides.
std::vector<std::string> cells(const Signals& signals) {
  const double side = signals.sizes[3];
  std::vector<std::string> values;
  if (!(side > 0)) return values;
  // Specs give cell sizes as floats.
  for (const double times : {1.0, 2.0, 4.0, 8.0, 16.0}) {
    if (side * times > 1e-30 && side * times < 1e30) values.push_back(fmt::format("{:.3g}", side * times));
  }
  return values;
}

/// The tunables of an algorithm worth trying for boxes at rest, or for moving boxes.
std::vector<Trial> trials_of(std::string_view algorithm, const Signals& signals) {
  const bool moves = signals.motion.has_value();
  std::vector<Trial> trials;
  if (moves) trials.push_back({"update", {"follow", "rebuild"}});
  if (algorithm == "grid") trials.push_back({"cell", cells(signals)});
  if (algorithm == "quadtree") trials.push_back({"capacity", {"8", "16", "32", "64", "128"}});
  if (algorithm == "sweep_and_prune") {
    std::vector<std::string> axes;
    for (std::size_t axis = 0; axis < signals.axis_tests.size(); ++axis)
      axes.emplace_back(1, axis_name(axis));
    trials.push_back({"axis", axes});
    trials.push_back({"axes", {"1", "2"}});
  }
  return trials;
}

}  // namespace

std::vector<Entry> variants_of(const Entry& entry, const Signals& signals) {
  std::vector<Entry> variants;
  if (entry.algorithm->kind != AlgorithmKind::own) return variants;
  for (const Trial& trial : trials_of(entry.algorithm->name, signals)) {
    const auto is_it = [&](const auto& value) { return value.first == trial.tunable; };
    const auto has_it = [&](const Tunable& tunable) { return tunable.name == trial.tunable; };
    if (std::ranges::any_of(entry.spec.values, is_it) ||
        std::ranges::none_of(entry.algorithm->tunables, has_it))
      continue;
    for (const std::string& value : trial.values) {
      variants.push_back(entry);
      variants.back().spec.values.emplace_back(trial.tunable, value);
    }
  }
  return variants;
}

}  // namespace broadside::lab
