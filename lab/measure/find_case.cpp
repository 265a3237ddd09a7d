// Measures finders: every contender on the same boxes, in turns, each result checked.
#include "lab/measure/find_case.hpp"

#include <algorithm>
#include <memory>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "broadside/sinks.hpp"

#include "lab/measure/allocation.hpp"
#include "lab/measure/floor.hpp"
#include "lab/measure/reference.hpp"

namespace broadside::lab {
namespace {

/// The most pairs that are kept to compare with one by one; more are compared by count and hash, and one by
/// one only where these differ.
constexpr std::size_t most_pairs_kept = 1'000'000;

/// In the place of the floor where boxes are of doubles, of which it has none.
struct NoFloor {
  template <typename Boxes>
  void run(const Boxes&, std::span<Pair>) const noexcept {}
};

/// What a search of one input must give.
struct Expectation {
  Reference reference;
  std::size_t input;
  std::size_t count;
  std::uint64_t hash;
  std::vector<Pair> pairs;  // sorted; empty if they are too many to keep
  std::string fault;        // of the reference itself
};

template <int D, typename Real>
struct Contestant {
  const Contender* contender;
  Measurement* entry;
  std::unique_ptr<PairFinder<D, Real>> finder{};
  std::vector<bool> compared{};  // for each input, whether the pairs were compared one by one
  double spent_ms = 0;           // in timed calls
  bool done = false;
};

template <int D, typename Real>
class FindCase {
 public:
  FindCase(const Case& of, Histories<D, Real> inputs, const Contest& contest)
      : case_(of), inputs_(inputs), contest_(contest) {
    for (const History<D, Real>& input : inputs) extremes_.template take<D, Real>(input.boxes);
  }

  CaseResult run() {
    std::vector<Measurement> entries;
    for (const Contender& contender : contest_.contenders) entries.push_back(entry_of(contender));
    for (std::size_t i = 0; i < entries.size(); ++i) {
      if (let_in(contest_.contenders[i], entries[i]))
        contestants_.push_back({&contest_.contenders[i], &entries[i]});
    }
    for (Contestant<D, Real>& contestant : contestants_) first_call(contestant);
    has_floor_ =
        std::is_same_v<Real, float> && !contestants_.empty() && boxes_of(0).size() >= least_boxes_of_floor;
    if (has_floor_) call_floor(0);  // to have it warm
    for (std::size_t round = 0; round < contest_.effort.most_samples; ++round) play(round);
    return {case_, std::move(entries), std::move(floor_ms_)};
  }

 private:
  std::span<const Box<D, Real>> boxes_of(std::size_t input) const { return inputs_[input].boxes; }

  /// Fills in why not, if the contender is not let in.
  bool let_in(const Contender& contender, Measurement& entry) {
    entry.reason = unfit(contender, D, extremes_);
    if (!entry.reason.empty()) return false;
    const double budget = contest_.effort.budget_seconds;
    const auto seconds_for = [&](std::size_t count) {
      contest_.watch.at(fmt::format("{}, trying {} boxes", entry.algorithm, count));
      std::vector<Box<D, Real>> some;
      for (const std::size_t i : sample_of(boxes_of(0).size(), count)) some.push_back(boxes_of(0)[i]);
      const auto finder = make_finder<D, Real>(*contender.algorithm, contender.spec);
      const double first = call(*finder, some);
      // Where the machine stalls for a moment, a short call seems many times as long as it is.
      constexpr double is_short_ms = 50;
      return (first < is_short_ms ? std::min(first, call(*finder, some)) : first) / 1e3;
    };
    const std::string fault = fault_of(entry, [&]() -> std::string {
      if (const auto estimate = estimate_above(budget, boxes_of(0).size(), seconds_for))
        skip(entry, *estimate, 1, budget);
      return {};
    });
    if (!fault.empty()) fail(entry, fault);
    return entry.reason.empty();
  }

  /// Makes the finder and calls it for the first time: to see what memory it takes, and to have it warm.
  /// Where this takes too long to be done again, it is the one sample.
  void first_call(Contestant<D, Real>& contestant) {
    Measurement& entry = *contestant.entry;
    contest_.watch.at(entry.algorithm + ", checking");
    const Expectation& expected = expectation(*contestant.contender->algorithm, 0);
    entry.verified_by = expected.reference.text();
    contestant.compared.resize(inputs_.size());
    pairs_.reserve(expected.count);
    settle(contestant, fault_of(entry, [&] {
             const AllocationMeter meter;
             contestant.finder =
                 make_finder<D, Real>(*contestant.contender->algorithm, contestant.contender->spec);
             const double milliseconds = call(*contestant.finder, boxes_of(0));
             count_memory(entry, *contestant.contender->algorithm, meter.read());
             entry.pairs = pairs_.size();
             entry.pair_hash = hash_of(pairs_);
             entry.statistics = contestant.finder->statistics();
             entry.explanation = contestant.finder->explanation();
             if (milliseconds > contest_.effort.single_sample_seconds * 1e3) {
               entry.samples_ms.push_back(milliseconds);
               contestant.done = true;
             }
             return check(contestant, 0);
           }));
  }

  /// One timed call of each contestant that is not done, on the same boxes, another one first in each round.
  /// The floor has the seat behind the last.
  void play(std::size_t round) {
    const std::size_t input = round % inputs_.size();
    const std::size_t seats = contestants_.size() + (has_floor_ ? 1 : 0);
    for (const std::size_t seat : turns(seats, round)) {
      if (seat < contestants_.size())
        sample(contestants_[seat], input, round);
      else
        sample_floor(input);
    }
  }

  void sample(Contestant<D, Real>& contestant, std::size_t input, std::size_t round) {
    if (contestant.done) return;
    Measurement& entry = *contestant.entry;
    contest_.watch.at(fmt::format("{}, round {}", entry.algorithm, round + 1));
    pairs_.reserve(expectation(*contestant.contender->algorithm, input).count);
    settle(contestant, fault_of(entry, [&] {
             const double milliseconds = call(*contestant.finder, boxes_of(input));
             entry.samples_ms.push_back(milliseconds);
             contestant.spent_ms += milliseconds;
             return check(contestant, input);
           }));
    contestant.done = contestant.done || is_enough(entry.samples_ms, contestant.spent_ms);
  }

  /// Goes on as long as any contestant does.
  void sample_floor(std::size_t input) {
    const bool last = std::ranges::all_of(contestants_, &Contestant<D, Real>::done);
    if (last && floor_ms_.size() >= contest_.effort.least_samples) return;
    contest_.watch.at("the floor");
    floor_ms_.push_back(call_floor(input));
  }

  /// Whether a contestant has had its share of samples.
  bool is_enough(const std::vector<double>& samples_ms, double spent_ms) const {
    return samples_ms.size() >= contest_.effort.least_samples &&
           spent_ms >= contest_.effort.share_seconds * 1e3;
  }

  /// Milliseconds for the floor's work, with as many pairs as a search must give.
  double call_floor(std::size_t input) {
    const auto known = std::ranges::find(expectations_, input, [](const auto& e) { return e->input; });
    const std::size_t count = known != expectations_.end()
                                  ? (*known)->count
                                  : expectation(*contestants_[0].contender->algorithm, input).count;
    pairs_.resize(count);
    const Stopwatch watch;
    floor_.run(boxes_of(input), pairs_);
    return watch.milliseconds();
  }

  /// Milliseconds for one search, whose pairs are then in pairs_.
  double call(PairFinder<D, Real>& finder, std::span<const Box<D, Real>> boxes) {
    pairs_.clear();
    PairCollector collector(pairs_);
    const Stopwatch watch;
    finder.find(boxes, collector);
    return watch.milliseconds();
  }

  void settle(Contestant<D, Real>& contestant, const std::string& fault) {
    contestant.entry->outcome = Outcome::verified;
    if (fault.empty()) return;
    fail(*contestant.entry, fault);
    contestant.done = true;
  }

  /// What is wrong with pairs_; empty if nothing is.
  std::string check(Contestant<D, Real>& contestant, std::size_t input) {
    const Expectation& expected = expectation(*contestant.contender->algorithm, input);
    if (!expected.fault.empty()) return expected.fault;
    const bool equal = pairs_.size() == expected.count && hash_of(pairs_) == expected.hash;
    const bool kept = expected.pairs.size() == expected.count;
    if (equal && (contestant.compared[input] || !kept)) return {};
    contestant.compared[input] = true;
    auto divergence =
        kept ? compare_pairs(pairs_, expected.pairs)
             : compare_pairs(pairs_, expected.reference.template pairs<D, Real>(boxes_of(input)));
    if (!divergence) return {};
    return explained<D, Real>(*std::move(divergence), contestant.entry->algorithm,
                              fmt::format("search of seed {}:", case_.seeds[input]), 0, boxes_of(input))
        .text;
  }

  /// What the contender must find in the input; computed when first asked for.
  const Expectation& expectation(const Algorithm& contender, std::size_t input) {
    const Reference reference(contender, contest_.known, boxes_of(0).size(), most_boxes_by_definition);
    for (const auto& known : expectations_) {
      if (known->reference == reference && known->input == input) return *known;
    }
    std::vector<Pair> pairs = reference.pairs<D, Real>(boxes_of(input));
    Expectation expected{reference, input, pairs.size(), hash_of(pairs), {}, {}};
    if (!reference.is_definition()) {
      if (auto divergence = check_sample<D, Real>(boxes_of(input), pairs))
        expected.fault =
            explained<D, Real>(*std::move(divergence), reference.text(), "reference:", 0, boxes_of(input))
                .text;
    }
    if (pairs.size() <= most_pairs_kept) expected.pairs = std::move(pairs);
    expectations_.push_back(std::make_unique<Expectation>(std::move(expected)));
    return *expectations_.back();
  }

  const Case& case_;
  Histories<D, Real> inputs_;
  const Contest& contest_;
  Extremes extremes_;
  std::vector<Contestant<D, Real>> contestants_;
  std::vector<std::unique_ptr<Expectation>> expectations_;
  std::vector<Pair> pairs_;  // of the last call; its memory serves all
  std::conditional_t<std::is_same_v<Real, float>, Floor<D>, NoFloor> floor_;
  bool has_floor_ = false;
  std::vector<double> floor_ms_;
};

}  // namespace

template <int D, typename Real>
CaseResult measure_find(const Case& of, Histories<D, Real> inputs, const Contest& contest) {
  return FindCase<D, Real>(of, inputs, contest).run();
}

template CaseResult measure_find<2, float>(const Case&, Histories<2, float>, const Contest&);
template CaseResult measure_find<3, float>(const Case&, Histories<3, float>, const Contest&);
template CaseResult measure_find<2, double>(const Case&, Histories<2, double>, const Contest&);
template CaseResult measure_find<3, double>(const Case&, Histories<3, double>, const Contest&);

}  // namespace broadside::lab
