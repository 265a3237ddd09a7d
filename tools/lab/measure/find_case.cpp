// Measures searches: every algorithm on the same boxes, in rounds, with each result checked.
#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"

#include "lab/measure/cases.hpp"
#include "lab/measure/evidence.hpp"
#include "lab/measure/floor.hpp"
#include "lab/measure/memory.hpp"
#include "lab/measure/reference.hpp"
#include "lab/measure/rounds.hpp"
#include "lab/measure/seen_algorithm.hpp"
#include "lab/pair_filter.hpp"
#include "lab/peers/peers.hpp"

namespace broadside::lab {
namespace {

/// The maximum number of an input's pairs kept for comparison one by one.
constexpr std::size_t max_pairs_kept = 1'000'000;

/// Replaces the lower bound (floor.hpp) for boxes of doubles, which do not have one.
struct NoFloor {
  template <typename Boxes>
  void run(const Boxes&, std::span<Pair>, Stores) const noexcept {}
};

/// Whether the algorithm joins two sets. An algorithm that finds the pairs of one set would be timed for
/// pairs that do not count.
bool joins_sets(const Algorithm& algorithm) {
  return algorithm.kind == AlgorithmKind::own || peers::joins_sets(algorithm.name);
}

/// Collects the pairs that filters accept: what the callback of a peer does, which gets all of them, or those
/// that the peer's own filter leaves.
class AcceptedPairs final : public PairSink {
 public:
  AcceptedPairs(std::span<const Filter> filters, PairSink& pairs) : filters_(filters), pairs_(pairs) {}

 private:
  void consume(std::span<const Pair> found) override {
    write_if(found, pairs_, [this](Pair pair) {
      return accepts(filters_[index(pair.first)], filters_[index(pair.second)]);
    });
  }

  std::span<const Filter> filters_;
  PairSink& pairs_;
};

/// The expected result of a search of one input.
struct ExpectedPairs {
  Reference reference;
  std::size_t input;
  std::size_t count;
  std::uint64_t hash;
  std::vector<Pair> pairs;  // sorted; of the first input only, and empty if there are too many to keep
  std::string fault;        // of the reference itself
};

/// An algorithm that takes part.
template <int D, typename Real>
struct FindParticipant {
  const Entry* entry;
  Measurement* measurement;
  std::unique_ptr<SeenAlgorithm> seen{};
  std::optional<Finder<D, Real>> finder{};
  std::size_t max_rounds = no_limit;
};

template <int D, typename Real>
class FindCase {
 public:
  FindCase(const Case& measured, Histories<D, Real> inputs, const Benchmark& benchmark)
      : case_(measured), inputs_(inputs), benchmark_(benchmark), caches_(benchmark.measure_options.cold) {
    for (const History<D, Real>& input : inputs) extremes_.template take<D, Real>(input.boxes);
  }

  CaseResult run() {
    keep_freed_memory();
    for (const Entry& entry : benchmark_.entries) measurements_.push_back(measurement_of(entry));
    for (std::size_t i = 0; i < measurements_.size(); ++i) {
      if (is_eligible(benchmark_.entries[i], measurements_[i]))
        participants_.push_back({&benchmark_.entries[i], &measurements_[i], seen(benchmark_.entries[i])});
    }
    for (FindParticipant<D, Real>& participant : participants_) warm_up(participant);
    has_floor_ =
        std::is_same_v<Real, float> && !participants_.empty() && boxes_of(0).size() >= min_boxes_of_floor;
    if (has_floor_) call_floor(0);  // the first call allocates its memory
    for (std::size_t round = 0; has_time(benchmark_.effort, round, watch_.milliseconds()) && play(round);
         ++round) {
    }
    for (FindParticipant<D, Real>& participant : participants_) {
      benchmark_.watch.at(participant.measurement->algorithm + ", tearing down");
      participant.finder.reset();
    }
    benchmark_.watch.at("counting agreement");
    count_agreement(measurements_, references());
    return {case_, std::move(measurements_), std::move(floor_ms_)};
  }

 private:
  std::span<const Box<D, Real>> boxes_of(std::size_t input) const { return inputs_[input].boxes; }

  /// The number of boxes in the left set of an input; 0 if there is only one set.
  std::size_t left_of(std::size_t input) const { return left_count(case_.left, boxes_of(input).size()); }

  /// The filters of an input's boxes; empty if there are none.
  std::span<const Filter> filters_of(std::size_t input) const { return inputs_[input].filters; }

  /// The pairs that count: all of them; in a case of two sets, those across the sets; in a case with filters,
  /// those that these accept.
  std::vector<Pair> counting(std::vector<Pair> pairs, std::size_t input) const {
    if (case_.left > 0) {
      std::erase_if(pairs, [left = left_of(input)](Pair pair) {
        return index(pair.second) < left || index(pair.first) >= left;
      });
    }
    if (case_.filtered) {
      std::erase_if(pairs, [filters = filters_of(input)](Pair pair) {
        return !accepts(filters[index(pair.first)], filters[index(pair.second)]);
      });
    }
    return pairs;
  }

  std::vector<Reference> references() const {
    std::vector<Reference> all;
    for (const auto& known : expectations_) all.push_back(known->reference);
    return all;
  }

  /// Whether the entry can take part; if not, fills in the reason.
  bool is_eligible(const Entry& entry, Measurement& measurement) {
    benchmark_.watch.at(measurement.algorithm + ", checking its limits");
    measurement.reason = unfit(entry, D, extremes_);
    if (measurement.reason.empty() && case_.left > 0 && !joins_sets(*entry.algorithm))
      measurement.reason = "has no join of two sets here";
    if (!measurement.reason.empty()) return false;
    const double budget = benchmark_.effort.budget_seconds;
    const auto seconds_for = [&](std::size_t count) {
      benchmark_.watch.at(fmt::format("{}, trying {} boxes", measurement.algorithm, count));
      std::vector<Box<D, Real>> some;
      const std::vector<std::size_t> sample = sample_of(boxes_of(0).size(), count);
      std::vector<Filter> their_filters;
      for (const std::size_t i : sample) {
        some.push_back(boxes_of(0)[i]);
        if (case_.filtered) their_filters.push_back(filters_of(0)[i]);
      }
      const auto left =
          static_cast<std::size_t>(std::ranges::lower_bound(sample, left_of(0)) - sample.begin());
      const auto tried = seen(entry);
      Finder<D, Real> finder(tried->algorithm(), entry.spec);
      benchmark_.watch.ask_within(finder);
      const double first = call(finder, *tried, some, left, their_filters);
      // A brief stall of the machine can make a short call seem many times as long, and the first call
      // allocates memory.
      constexpr double is_short_ms = 50;
      return (first < is_short_ms ? std::min(first, call(finder, *tried, some, left, their_filters))
                                  : first) /
             1e3;
    };
    attempt(measurement, [&]() -> std::string {
      touch(expectation(*entry.algorithm, 0).count);
      if (const auto estimate = estimate_above(budget, boxes_of(0).size(), seconds_for))
        skip(measurement, *estimate, 1, budget);
      return {};
    });
    return measurement.reason.empty();
  }

  std::unique_ptr<SeenAlgorithm> seen(const Entry& entry) const {
    return std::make_unique<SeenAlgorithm>(*entry.algorithm, SeenAlgorithm::Sees::searchers,
                                           benchmark_.measure_options.phases);
  }

  void make_finder(FindParticipant<D, Real>& participant) const {
    participant.finder.emplace(participant.seen->algorithm(), participant.entry->spec);
  }

  /// Writes to the memory for `pairs` pairs, so that no timed call has page faults there.
  void touch(std::size_t pairs) {
    if (pairs <= touched_) return;
    touched_ = pairs + pairs / 8;
    pairs_.resize(touched_);
  }

  /// Makes the finder and calls it for the first time, so that it allocates its memory, which is counted.
  void warm_up(FindParticipant<D, Real>& participant) {
    Measurement& measurement = *participant.measurement;
    benchmark_.watch.at(measurement.algorithm + ", checking");
    measurement.evidence = Evidence{expectation(*participant.entry->algorithm, 0).reference.is_definition()};
    measurement.statistics_by_seed.resize(inputs_.size());
    measurement.outcome = Outcome::verified;
    attempt(measurement, [&] {
      const AllocationMeter meter;
      make_finder(participant);
      benchmark_.watch.ask_within(*participant.finder);
      const double first = call(participant, 0);
      benchmark_.watch.ask_within(*participant.finder, first >= min_asking_ms);
      count_memory(measurement, *participant.entry->algorithm, meter.read());
      measurement.pairs = pairs_.size();
      measurement.pair_hash = hash_of(pairs_);
      measurement.statistics = statistics_;
      measurement.explanation =
          explanation_of(*participant.entry->algorithm, participant.finder->explanation());
      return check(participant, 0, true);
    });
  }

  /// Times one call of each participant in this round, all on the same boxes; false if there are none. The
  /// lower bound comes after the last participant in the list of turns, and takes part in every round.
  bool play(std::size_t round) {
    const std::size_t input = round % inputs_.size();
    std::vector<FindParticipant<D, Real>*> players;
    for (FindParticipant<D, Real>& participant : participants_) {
      if (has_another_round(*participant.measurement, benchmark_.effort, participant.max_rounds))
        players.push_back(&participant);
    }
    if (players.empty()) return false;
    for (const FindParticipant<D, Real>* const participant : players)
      touch(expectation(*participant->entry->algorithm, input).count);
    for (const std::size_t turn : turns(players.size() + (has_floor_ ? 1 : 0), round)) {
      if (turn < players.size()) {
        sample(*players[turn], input, round);
      } else {
        benchmark_.watch.at("the floor");
        floor_ms_.push_back(call_floor(input));
      }
    }
    if (round > 0) return true;
    for (FindParticipant<D, Real>& participant : participants_) {
      participant.max_rounds = round_limit(*participant.measurement, measurements_, benchmark_.effort,
                                           benchmark_.effort.slow_seconds);
    }
    return true;
  }

  void sample(FindParticipant<D, Real>& participant, std::size_t input, std::size_t round) {
    Measurement& measurement = *participant.measurement;
    benchmark_.watch.at(fmt::format("{}, round {}", measurement.algorithm, round + 1));
    attempt(measurement, [&] {
      if (benchmark_.measure_options.made_anew) make_finder(participant);
      measurement.samples_ms.push_back(call(participant, input));
      if (const paper::Phases* const phases = participant.seen->phases())
        measurement.phases.push_back(*phases);
      measurement.statistics_by_seed[input] = statistics_;
      return check(participant, input, false);
    });
  }

  /// Milliseconds of the lower bound's work, with as many pairs as the search's expected result and the
  /// faster kind of stores.
  double call_floor(std::size_t input) {
    pairs_.resize(expectation(*participants_[0].entry->algorithm, input).count);
    double least = std::numeric_limits<double>::infinity();
    for (const Stores stores : {Stores::plain, Stores::streamed}) {
      caches_.settle(std::as_bytes(boxes_of(input)));
      const Stopwatch watch;
      floor_.run(boxes_of(input), pairs_, stores);
      least = std::min(least, watch.milliseconds());
    }
    return least;
  }

  /// Times one search, in milliseconds. Sets pairs_, as indexes into `boxes`, and statistics_.
  double call(Finder<D, Real>& finder, const SeenAlgorithm& seen, std::span<const Box<D, Real>> boxes,
              std::size_t left, std::span<const Filter> filters) {
    pairs_.clear();
    PairCollector collector(pairs_);
    AcceptedPairs accepted(filters, collector);
    if (seen.filtering() != nullptr) seen.filtering()->set_filters(filters);
    caches_.settle(std::as_bytes(boxes));
    const Stopwatch watch;
    if (case_.left > 0) {
      statistics_ = finder.find_across(boxes, left, collector);
    } else if (filters.empty() || seen.algorithm().kind == AlgorithmKind::own) {
      statistics_ = finder.find(boxes, collector, {.filters = filters});
    } else {
      statistics_ = finder.find(boxes, accepted);
      collector.flush();
    }
    const double milliseconds = watch.milliseconds();
    if (seen.structure() != nullptr) seen.structure()->tear_down();
    for (Pair& pair : pairs_) pair.second = BoxId(index(pair.second) + left);
    return milliseconds;
  }

  double call(FindParticipant<D, Real>& participant, std::size_t input) {
    return call(*participant.finder, *participant.seen, boxes_of(input), left_of(input), filters_of(input));
  }

  /// The fault of pairs_; empty if there is none. Pairs with the expected count and hash are the expected
  /// ones; with `one_by_one` they are compared all the same.
  std::string check(FindParticipant<D, Real>& participant, std::size_t input, bool one_by_one) {
    const ExpectedPairs& expected = expectation(*participant.entry->algorithm, input);
    if (!expected.fault.empty()) return expected.fault;
    const bool equal = pairs_.size() == expected.count && hash_of(pairs_) == expected.hash;
    const bool kept = expected.pairs.size() == expected.count;
    if (equal && !(one_by_one && kept)) return {};
    auto divergence =
        kept ? compare_pairs(pairs_, expected.pairs)
             : compare_pairs(pairs_,
                             counting(expected.reference.template pairs<D, Real>(boxes_of(input)), input));
    if (!divergence) return {};
    return explained<D, Real>(*std::move(divergence), participant.measurement->algorithm,
                              fmt::format("search of seed {}:", case_.seeds[input]), 0, boxes_of(input))
        .text;
  }

  /// The expected result of the entry on the input; computed on first use.
  const ExpectedPairs& expectation(const Algorithm& entry, std::size_t input) {
    const Reference reference(entry, benchmark_.known, boxes_of(0).size(),
                              benchmark_.effort.definition_boxes);
    for (const auto& known : expectations_) {
      if (known->reference == reference && known->input == input) return *known;
    }
    benchmark_.watch.at("making the reference: " + reference.text());
    std::vector<Pair> pairs = reference.pairs<D, Real>(boxes_of(input), [this] { benchmark_.watch.ask(); });
    std::string fault;
    if (!reference.is_definition()) {
      if (auto divergence = check_sample<D, Real>(boxes_of(input), pairs))
        fault = explained<D, Real>(*std::move(divergence), reference.text(), "reference:", 0, boxes_of(input))
                    .text;
    }
    pairs = counting(std::move(pairs), input);
    ExpectedPairs expected{reference, input, pairs.size(), hash_of(pairs), {}, std::move(fault)};
    for (const auto& known : expectations_) {
      if (known->input == input && (known->count != expected.count || known->hash != expected.hash))
        expected.fault = fmt::format(
            "reference: {} gives {} pairs, hash {:016x}; expected those of {}: {}, {:016x}", reference.text(),
            expected.count, expected.hash, known->reference.text(), known->count, known->hash);
    }
    if (input == 0 && pairs.size() <= max_pairs_kept) expected.pairs = std::move(pairs);
    expectations_.push_back(std::make_unique<ExpectedPairs>(std::move(expected)));
    return *expectations_.back();
  }

  const Case& case_;
  Histories<D, Real> inputs_;
  const Benchmark& benchmark_;
  Extremes extremes_;
  std::vector<Measurement> measurements_;  // of the entries, in their order
  std::vector<FindParticipant<D, Real>> participants_;
  std::vector<std::unique_ptr<ExpectedPairs>> expectations_;
  std::vector<Pair> pairs_;               // of the last call; the memory is reused for all
  std::optional<Statistics> statistics_;  // likewise
  std::size_t touched_ = 0;               // how many pairs of that memory have been written to
  CacheState caches_;
  Stopwatch watch_;
  std::conditional_t<std::is_same_v<Real, float>, Floor<D>, NoFloor> floor_;
  bool has_floor_ = false;
  std::vector<double> floor_ms_;
};

}  // namespace

template <int D, typename Real>
CaseResult measure_find(const Case& measured, Histories<D, Real> inputs, const Benchmark& benchmark) {
  return FindCase<D, Real>(measured, inputs, benchmark).run();
}

template CaseResult measure_find<2, float>(const Case&, Histories<2, float>, const Benchmark&);
template CaseResult measure_find<3, float>(const Case&, Histories<3, float>, const Benchmark&);
template CaseResult measure_find<2, double>(const Case&, Histories<2, double>, const Benchmark&);
template CaseResult measure_find<3, double>(const Case&, Histories<3, double>, const Benchmark&);

}  // namespace broadside::lab
