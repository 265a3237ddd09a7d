// Measures statistics of the boxes, and which algorithm suits them.
#include "lab/advise/advise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "lab/advise/algorithm_choice.hpp"
#include "lab/advise/snippet.hpp"
#include "lab/measure/cases.hpp"
#include "lab/measure/ranking.hpp"
#include "lab/measure/reference.hpp"
#include "lab/measure/rounds.hpp"
#include "lab/measure/samples.hpp"

namespace broadside::lab {
namespace {

/// An algorithm slower than the best by more than this factor is not measured again.
constexpr double margin_of_finalists = 1.6;
constexpr std::size_t max_finalists = 4;

/// How many of the best algorithms are tried with other settings.
constexpr std::size_t max_with_variants = 2;

/// The first of `frames` consecutive frames in which the number of changed boxes is close to the history's
/// mean. Of such ranges, takes the one nearest the middle, where motion is typical.
template <int D, typename Real>
std::size_t typical_frames(const History<D, Real>& history, std::size_t frames) {
  const auto changes = [&](std::size_t step) {
    return static_cast<double>(history.steps[step].changed.size());
  };
  const std::size_t places = history.steps.size() - frames + 1;
  double all = 0;
  for (std::size_t i = 0; i < history.steps.size(); ++i) all += changes(i);
  const double expected = all * static_cast<double>(frames) / static_cast<double>(history.steps.size());
  std::vector<double> excess(places, 0.0);  // for each candidate first frame, the deviation in changed boxes
  double some = 0;
  for (std::size_t i = 0; i < history.steps.size(); ++i) {
    some += changes(i);
    if (i >= frames) some -= changes(i - frames);
    if (i + 1 >= frames) excess[i + 1 - frames] = std::max(std::abs(some - expected), 0.1 * expected);
  }
  std::size_t best = (places - 1) / 2;
  const std::size_t middle = best;
  for (std::size_t away = 1; away < places; ++away) {
    if (away <= middle && excess[middle - away] < excess[best]) best = middle - away;
    if (middle + away < places && excess[middle + away] < excess[best]) best = middle + away;
  }
  return best;
}

/// The frames of a history to measure: as many as the budget allows.
template <int D, typename Real>
History<D, Real> window(const History<D, Real>& history, double budget_seconds, Advice& advice) {
  const auto places = static_cast<double>(std::max<std::size_t>(places_of(history), 1));
  double max_frames = std::clamp(budget_seconds * 5e5 / places, 8.0, 240.0);
  // Brute force checks every frame.
  constexpr double max_places_by_definition = 5'000;
  if (places <= max_places_by_definition)
    max_frames = std::min(max_frames, std::max(budget_seconds * 2e8 / (places * places), 8.0));
  advice.frames = std::min(history.steps.size(), static_cast<std::size_t>(max_frames));
  if (advice.frames < history.steps.size()) advice.first_frame = typical_frames(history, advice.frames);
  History<D, Real> part{history.boxes, {}};
  for (std::size_t i = 0; i < advice.first_frame; ++i) apply(history.steps[i], part.boxes);
  const auto begin = history.steps.begin() + static_cast<std::ptrdiff_t>(advice.first_frame);
  part.steps.assign(begin, begin + static_cast<std::ptrdiff_t>(advice.frames));
  return part;
}

/// A box mirrored on the axes whose bits are set. Exact.
template <int D, typename Real>
Box<D, Real> mirrored(const Box<D, Real>& box, std::size_t axes) {
  Box<D, Real> image = box;
  for (std::size_t axis = 0; axis < D; ++axis) {
    if ((axes >> axis & 1) == 0) continue;
    image.min[axis] = -box.max[axis];
    image.max[axis] = -box.min[axis];
  }
  return image;
}

/// The boxes themselves, their mirror images, and each with the array rotated. On the same boxes again and
/// again, the branch predictor would learn what it never could from a user's boxes.
template <int D, typename Real>
std::vector<History<D, Real>> images_of(const History<D, Real>& history, std::size_t count) {
  std::vector<History<D, Real>> images;
  for (std::size_t i = 0; i < count; ++i) {
    History<D, Real> image = history;
    const auto mirror = [&](Box<D, Real>& box) { box = mirrored(box, i); };
    std::ranges::for_each(image.boxes, mirror);
    for (Step<D, Real>& step : image.steps) std::ranges::for_each(step.boxes, mirror);
    const std::size_t turn = image.boxes.size() * (i >> D) / ((count >> D) + 1);
    // Changes name places, so the array cannot be rotated.
    if (image.steps.empty())
      std::rotate(image.boxes.begin(), image.boxes.begin() + static_cast<std::ptrdiff_t>(turn),
                  image.boxes.end());
    images.push_back(std::move(image));
  }
  return images;
}

std::size_t image_count(std::size_t boxes, Mode mode) {
  if (mode == Mode::track) return boxes <= 20'000 ? 2 : 1;
  return boxes <= 200'000 ? inputs_in_rotation(boxes) : 1;
}

template <int D, typename Real>
class Adviser {
 public:
  Adviser(const Catalogue& catalogue, const std::string& input, const History<D, Real>& history,
          const AdviseOptions& options)
      : catalogue_(catalogue), options_(options) {
    advice_.input = input;
    options_.watch.at("looking at the boxes");
    advice_.signals = signals_of(history);
    check_pair_count<D, Real>(history.boxes);
    advice_.mode = history.steps.empty() ? Mode::find : Mode::track;
    const History<D, Real> part = window(history, options.budget_seconds, advice_);
    const std::size_t boxes = places_of(part);
    images_ = images_of(part, image_count(boxes, advice_.mode));
    case_ = {.scene = input,
             .parameters = {},
             .seeds = {},
             .dimension = D,
             .boxes = boxes,
             .frames = part.steps.size(),
             .moving = advice_.signals.motion ? advice_.signals.motion->moving : 0,
             .mode = advice_.mode};
    for (std::size_t i = 0; i < images_.size(); ++i) case_.seeds.push_back(i + 1);
  }

  Advice run() {
    const std::vector<Entry> plain = catalogue_.select(options_.algorithms);
    std::vector<Measurement> first = measure(plain, first_effort(plain.size()));
    std::vector<bool> variant;
    const std::vector<Entry> finalists = finalists_of(plain, first, variant);
    if (!finalists.empty()) {
      std::vector<Measurement> second = measure(finalists, final_effort(finalists.size()));
      for (std::size_t i = 0; i < second.size(); ++i) add(std::move(second[i]), variant[i], true);
    }
    for (Measurement& measurement : first) {
      const auto same = [&](const RankedAlgorithm& ranked) {
        return ranked.measurement.algorithm == measurement.algorithm;
      };
      if (std::ranges::none_of(advice_.ranking, same)) add(std::move(measurement), false, false);
    }
    std::ranges::stable_sort(advice_.ranking, {}, [](const RankedAlgorithm& ranked) {
      return std::tuple(!ranked.is_finalist, !is_timed(ranked.measurement), ranked.milliseconds);
    });
    conclude();
    return std::move(advice_);
  }

 private:
  /// The time by which a measurement is ranked.
  double time(const Measurement& measurement) const {
    if (!is_timed(measurement)) return time_of(measurement);
    if (advice_.mode == Mode::find) return undisturbed(measurement.samples_ms, images_.size());
    return undisturbed_mean(measurement.samples_ms, images_.size() * case_.frames);
  }

  void add(Measurement measurement, bool is_variant, bool is_finalist) {
    const double milliseconds = time(measurement);
    advice_.ranking.push_back({std::move(measurement), milliseconds, is_variant, is_finalist});
  }

  Effort first_effort(std::size_t entries) const {
    const double budget = options_.budget_seconds;
    return {.budget_seconds = budget / 12,
            .history_seconds = budget / 3,
            .share_seconds = 0.3 * budget / static_cast<double>(entries),
            .min_rounds = advice_.mode == Mode::find ? std::size_t{6} : std::size_t{2},
            .max_rounds = 64,
            .slow_seconds = budget / 20,
            .slow_history_seconds = budget / 20,
            .slow_rounds = 1,
            .far_ratio = std::numeric_limits<double>::infinity(),
            .case_seconds = 0.4 * budget};
  }

  Effort final_effort(std::size_t entries) const {
    const double budget = options_.budget_seconds;
    return {.budget_seconds = budget,
            .history_seconds = budget,
            .share_seconds = 0.6 * budget / static_cast<double>(entries),
            .min_rounds = advice_.mode == Mode::find ? std::size_t{9} : std::size_t{3},
            .max_rounds = 400,
            .slow_seconds = budget / 8,
            .slow_history_seconds = budget / 8,
            .slow_rounds = 3,
            .far_ratio = std::numeric_limits<double>::infinity(),
            .case_seconds = std::max(budget - watch_.milliseconds() / 1e3, 0.0)};
  }

  std::vector<Measurement> measure(std::span<const Entry> entries, const Effort& effort) {
    const Benchmark benchmark{entries, catalogue_.algorithms(), effort, options_.watch};
    CaseResult result = measure_case<D, Real>(case_, images_, benchmark, hung_);
    if (!result.floor_ms.empty()) advice_.floor_ms = median(result.floor_ms);
    return std::move(result.measurements);
  }

  /// The best algorithms, auto, and variants of the best; for each, whether it is a variant.
  std::vector<Entry> finalists_of(const std::vector<Entry>& plain, const std::vector<Measurement>& first,
                                  std::vector<bool>& variant) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < first.size(); ++i) {
      if (first[i].outcome == Outcome::verified) order.push_back(i);
    }
    std::ranges::sort(order, {}, [&](std::size_t i) { return std::pair(time(first[i]), i); });
    const auto is_auto = [&](std::size_t i) { return plain[i].algorithm->name == default_algorithm; };
    const auto is_peer = [&](std::size_t i) { return is_foreign(plain[i].algorithm->kind); };
    const auto best = std::ranges::find_if_not(order, is_peer);
    if (best == order.end()) return {};
    std::vector<Entry> finalists;
    std::vector<Entry> tried;
    std::size_t ours = 0;
    std::size_t with_variants = 0;
    for (const std::size_t i : order) {
      const bool is_near = time(first[i]) <= margin_of_finalists * time(first[*best]) &&
                           (is_peer(i) || ours++ < max_finalists);
      if (!is_near && !is_auto(i)) continue;
      finalists.push_back(plain[i]);
      if (!is_peer(i)) add_threads(plain[i], tried);
      if (is_auto(i) || (!is_peer(i) && with_variants++ < max_with_variants)) add_variants(plain[i], tried);
    }
    std::erase_if(tried, [&](const Entry& entry) {
      return std::ranges::any_of(plain,
                                 [&](const Entry& other) { return other.spec.text() == entry.spec.text(); });
    });
    variant.assign(finalists.size(), false);
    for (Entry& entry : tried) {
      finalists.push_back(std::move(entry));
      variant.push_back(true);
    }
    return finalists;
  }

  void add_variants(const Entry& entry, std::vector<Entry>& tried) const {
    for (Entry& other : variants_of(entry, advice_.signals)) tried.push_back(std::move(other));
  }

  /// Adds the entry with more than one thread, unless the user set the number in its spec.
  void add_threads(const Entry& entry, std::vector<Entry>& tried) const {
    for (Entry& other : with_threads({entry}, options_.threads)) {
      if (other.spec.text() != entry.spec.text()) tried.push_back(std::move(other));
    }
  }

  void conclude() {
    std::vector<Candidate> candidates;
    for (const RankedAlgorithm& ranked : advice_.ranking) {
      if (!ranked.is_finalist) break;
      candidates.push_back({&ranked.measurement, ranked.milliseconds, ranked.is_variant});
    }
    for (const RankedAlgorithm& ranked : advice_.ranking) {
      const auto& pairs = ranked.measurement.pairs;
      if (ranked.measurement.outcome != Outcome::verified || !pairs || advice_.signals.boxes == 0) continue;
      advice_.signals.overlaps = 2 * static_cast<double>(*pairs) / static_cast<double>(advice_.signals.boxes);
      break;
    }
    advice_.choice = choose(candidates, advice_.signals.boxes >= 2 || advice_.signals.motion.has_value());
    if (!advice_.choice) return;
    const Measurement& chosen = advice_.ranking[advice_.choice->chosen].measurement;
    advice_.spec = chosen.algorithm;
    advice_.milliseconds = advice_.ranking[advice_.choice->chosen].milliseconds;
    advice_.p99_ms = percentile(chosen.samples_ms, 0.99);
    advice_.reasons = reasons_of(advice_);
    advice_.changes = changes_of(advice_);
    advice_.snippet = snippet(advice_.spec, advice_.mode, D, precision_of<Real>);
  }

  const Catalogue& catalogue_;
  const AdviseOptions& options_;
  std::vector<History<D, Real>> images_;
  Case case_;
  std::vector<std::string> hung_;  // algorithms that did not return
  Advice advice_;
  Stopwatch watch_;  // for the whole budget
};

}  // namespace

bool Advice::all_verified() const {
  const auto failed = [](const RankedAlgorithm& ranked) {
    return ranked.measurement.outcome == Outcome::failed;
  };
  return choice.has_value() && std::ranges::none_of(ranking, failed);
}

template <int D, typename Real>
Advice advise(const Catalogue& catalogue, const std::string& input, const History<D, Real>& history,
              const AdviseOptions& options) {
  return Adviser<D, Real>(catalogue, input, history, options).run();
}

template Advice advise(const Catalogue&, const std::string&, const History<2, float>&, const AdviseOptions&);
template Advice advise(const Catalogue&, const std::string&, const History<3, float>&, const AdviseOptions&);
template Advice advise(const Catalogue&, const std::string&, const History<2, double>&, const AdviseOptions&);
template Advice advise(const Catalogue&, const std::string&, const History<3, double>&, const AdviseOptions&);

}  // namespace broadside::lab
