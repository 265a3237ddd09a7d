// Algorithms with one deliberate fault in their output: a pair dropped, duplicated, or swapped for another.
// They measure how many faults `broadside compare` detects.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "broadside/algorithm.hpp"
#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"
#include "broadside/tracker.hpp"

#include "lab/measure/cases.hpp"
#include "lab/measure/compare.hpp"

namespace broadside::bench {

/// What happens to one pair of a search or one event of a frame. Tracker delivers each event once per frame
/// whatever an algorithm writes, so a "doubled" event is one that is repeated in the next frame.
enum class CorruptionKind { dropped, doubled, swapped };

/// A corruption, derived from its number, and its progress.
struct Corruption {
  Corruption(std::uint64_t number, std::size_t of_calls)
      : random(number), call(random() % of_calls), fault(static_cast<CorruptionKind>(random() % 3)) {}

  std::mt19937_64 random;
  std::size_t call;  ///< index of the first search or update at which a pair may be corrupted
  CorruptionKind fault;
  std::size_t calls = 0;  ///< searches or updates so far
  bool is_applied = false;
  std::vector<Pair> again{};  ///< events to repeat in the next frame
};

/// Corrupts one of the sorted pairs of `boxes` boxes. `pairs` must not be empty.
inline void corrupt(std::vector<Pair>& pairs, CorruptionKind fault, std::size_t boxes,
                    std::mt19937_64& random) {
  const Pair from{BoxId(random() % boxes), BoxId(random() % boxes)};
  auto found = std::ranges::lower_bound(pairs, from);
  if (found == pairs.end()) found = pairs.begin();
  const Pair chosen = *found;
  if (fault == CorruptionKind::doubled) {
    pairs.push_back(chosen);
    return;
  }
  Pair other = chosen;
  while (std::ranges::find(pairs, other) != pairs.end()) {
    const std::size_t a = random() % boxes;
    const std::size_t b = random() % boxes;
    if (a != b) other = {BoxId(std::min(a, b)), BoxId(std::max(a, b))};
  }
  if (fault == CorruptionKind::swapped)
    *found = other;
  else
    pairs.erase(found);
}

/// The pairs that `write` gives a sink, sorted and without duplicates.
template <typename Write>
std::vector<Pair> sorted_pairs(const Write& write) {
  std::vector<Pair> pairs;
  PairCollector collector(pairs);
  write(collector);
  collector.flush();
  std::ranges::sort(pairs);
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

inline void add_all(const std::vector<Pair>& pairs, PairSink& sink) {
  for (const Pair pair : pairs) sink.add(pair.first, pair.second);
}

/// Wraps another algorithm's searches; `spoil` may change the pairs.
template <int D, typename Spoil>
class SpoiltSearcher final : public Searcher<D> {
 public:
  SpoiltSearcher(const std::string& base, Spoil spoil) : real_(base), spoil_(std::move(spoil)) {}

  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& sink) override {
    std::vector<Pair> pairs = sorted_pairs([&](PairSink& all) { real_.find(input.boxes, all); });
    spoil_(pairs, input.boxes.size());
    add_all(pairs, sink);
    return std::nullopt;
  }

 private:
  Finder<D> real_;
  Spoil spoil_;
};

template <int D, typename Spoil>
std::unique_ptr<Searcher<D>> spoilt_searcher(const std::string& base, Spoil spoil) {
  return std::make_unique<SpoiltSearcher<D, Spoil>>(base, std::move(spoil));
}

/// Wraps another algorithm's tracker and corrupts the events of one frame.
template <int D>
class CorruptedFollower final : public Follower<D> {
 public:
  CorruptedFollower(std::string base, Corruption& corruption, std::size_t boxes)
      : base_(std::move(base)), real_(base_), corruption_(corruption), boxes_(boxes) {}

  std::optional<Statistics> follow(const Change<D>& change, PairSink& begun, PairSink& ended) override {
    if (change.rebuild) {
      real_ = Tracker<D>(base_);
      PairCounter held_before;
      real_.update({.boxes = change.before}, held_before, held_before);
    }
    std::vector<Pair> ends;
    std::vector<Pair> begins = sorted_pairs([&](PairSink& all) {
      ends = sorted_pairs([&](PairSink& others) {
        real_.update({.boxes = change.now, .changed = change.changed}, all, others);
      });
    });
    if (change.now.size() == boxes_) spoil(begins, ends);
    add_all(begins, begun);
    add_all(ends, ended);
    return std::nullopt;
  }

 private:
  void spoil(std::vector<Pair>& begins, std::vector<Pair>& ends) {
    Corruption& corruption = corruption_;
    for (const Pair pair : std::exchange(corruption.again, {})) {
      // If the pair begins in this frame anyway, the repeat is no error yet.
      if (std::ranges::find(begins, pair) != begins.end())
        corruption.again.push_back(pair);
      else
        corruption.is_applied = true;
      begins.push_back(pair);
    }
    const bool is_due =
        corruption.calls++ >= corruption.call && !corruption.is_applied && corruption.again.empty();
    if (!is_due || (begins.empty() && ends.empty())) return;
    std::vector<Pair>& events =
        ends.empty() || (!begins.empty() && corruption.random() % 2 == 0) ? begins : ends;
    if (corruption.fault == CorruptionKind::doubled) {
      corruption.again = {events[corruption.random() % events.size()]};
      return;
    }
    corrupt(events, corruption.fault, boxes_, corruption.random);
    corruption.is_applied = true;
  }

  std::string base_;
  Tracker<D> real_;
  Corruption& corruption_;
  std::size_t boxes_;
};

/// The corruptions of one algorithm, by number. Trials on fewer boxes are not corrupted.
class Corrupted {
 public:
  Corrupted(std::string base, std::size_t boxes, std::size_t calls)
      : base_(std::move(base)), boxes_(boxes), calls_(calls) {}

  /// The algorithm as "corrupted_NAME:number=7". It must not outlive this object.
  Algorithm algorithm() {
    Algorithm algorithm;
    algorithm.name = "corrupted_" + base_;
    algorithm.tunables = {{"number", "which corruption", "0", Tunable::Type::integer, 0, 1e15}};
    algorithm.in_2d = strategies<2>();
    algorithm.in_3d = strategies<3>();
    return algorithm;
  }

  Corruption& at(std::uint64_t number) { return all_.try_emplace(number, number, calls_).first->second; }

 private:
  template <int D>
  Strategies<D> strategies() {
    return {.searcher = [this](const Settings& settings) { return searcher<D>(settings); },
            .followers = {
                {.name = base_, .make = [this](const Settings& settings) { return follower<D>(settings); }}}};
  }

  template <int D>
  std::unique_ptr<Searcher<D>> searcher(const Settings& settings) {
    Corruption& corruption = at(static_cast<std::uint64_t>(settings.integer("number")));
    return spoilt_searcher<D>(base_, [&corruption, this](std::vector<Pair>& pairs, std::size_t boxes) {
      if (boxes != boxes_ || corruption.calls++ < corruption.call || corruption.is_applied || pairs.empty())
        return;
      corrupt(pairs, corruption.fault, boxes, corruption.random);
      corruption.is_applied = true;
    });
  }

  template <int D>
  std::unique_ptr<Follower<D>> follower(const Settings& settings) {
    return std::make_unique<CorruptedFollower<D>>(
        base_, at(static_cast<std::uint64_t>(settings.integer("number"))), boxes_);
  }

  std::string base_;
  std::size_t boxes_;
  std::size_t calls_;
  std::map<std::uint64_t, Corruption> all_;
};

/// How many corruptions were applied, and how many were detected.
struct CorruptionCounts {
  std::size_t applied = 0;
  std::size_t caught = 0;

  void add(const CorruptionCounts& other) {
    applied += other.applied;
    caught += other.caught;
  }
};

/// Rounds of each corrupted algorithm, after one untimed round.
inline constexpr std::size_t corruption_rounds = 4;

inline lab::Effort corruption_effort(std::size_t definition_boxes) {
  lab::Effort effort{.budget_seconds = 1e6, .history_seconds = 1e6, .share_seconds = 0};
  effort.min_rounds = effort.max_rounds = effort.slow_rounds = effort.far_rounds = corruption_rounds;
  effort.definition_boxes = definition_boxes;
  return effort;
}

/// Lets `compare` measure the algorithm `base` under corruptions `first` to `first + count - 1`, each in one
/// search or frame of one of the rounds. A corruption is detected if its measurement has failed.
inline CorruptionCounts compare_corrupted(const std::string& base, const lab::CaseRequest& request,
                                          std::uint64_t first, std::size_t count,
                                          std::size_t definition_boxes) {
  Corrupted corrupted(base, request.boxes, (corruption_rounds + 1) * (request.frames + 1));
  lab::Catalogue catalogue;
  catalogue.add(corrupted.algorithm());
  lab::CompareOptions options;
  options.algorithms.clear();
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0) options.algorithms += ",";
    options.algorithms += "corrupted_" + base + ":number=" + std::to_string(first + i);
  }
  options.plan = {request};
  options.effort = corruption_effort(definition_boxes);
  const lab::Comparison comparison = lab::compare(catalogue, options);
  CorruptionCounts result;
  for (std::size_t i = 0; i < count; ++i) {
    if (!corrupted.at(first + i).is_applied) continue;
    ++result.applied;
    if (comparison.cases.at(0).measurements.at(i).outcome == lab::Outcome::failed) ++result.caught;
  }
  return result;
}

/// As above, but the reference has the same fault as the compared algorithm, in every search and frame. Only
/// the boxes that are checked by definition can reveal it.
inline CorruptionCounts compare_with_corrupted_reference(const lab::CaseRequest& request, std::uint64_t first,
                                                         std::size_t count) {
  lab::Case measured;
  measured.scene = request.scene;
  measured.seeds = {1};
  measured.boxes = request.boxes;
  measured.frames = request.frames;
  measured.mode = request.frames == 0 ? lab::Mode::find : lab::Mode::track;
  const lab::NamedScene named = lab::find_scene(request.scene);
  const std::vector<History<2>> inputs = {lab::make_history<2>(
      named.scene, named.spec,
      {.boxes = request.boxes, .seed = 1, .frames = request.frames, .moving = request.moving})};
  CorruptionCounts result;
  for (std::uint64_t number = first; number < first + count; ++number) {
    bool is_applied = false;
    const auto faulty = [&](std::string name) {
      Algorithm algorithm;
      algorithm.name = std::move(name);
      algorithm.in_2d.searcher = [&is_applied, number, &request](const Settings&) {
        return spoilt_searcher<2>("grid", [&is_applied, number, &request](std::vector<Pair>& pairs,
                                                                          std::size_t boxes) {
          // The same place in the array each time, hence the same pair as long as the array stays the same.
          std::mt19937_64 random(number);
          const auto fault = static_cast<CorruptionKind>(random() % 3);
          if (boxes != request.boxes || pairs.empty()) return;
          // A tracker that searches from scratch accepts no pair twice.
          corrupt(pairs,
                  request.frames > 0 && fault == CorruptionKind::doubled ? CorruptionKind::dropped : fault,
                  boxes, random);
          is_applied = true;
        });
      };
      return algorithm;
    };
    const std::vector<Algorithm> known = {faulty("quadtree")};
    const Algorithm algorithm = faulty("shared");
    const std::vector<lab::Entry> entries = {{&algorithm, Spec{algorithm.name, {}}}};
    const lab::Benchmark benchmark{entries, known, corruption_effort(0), {}};
    const std::vector<lab::Measurement> measurements =
        request.frames == 0 ? lab::measure_find<2>(measured, inputs, benchmark).measurements
                            : lab::measure_track<2>(measured, inputs, benchmark);
    if (!is_applied) continue;
    ++result.applied;
    if (measurements.at(0).outcome == lab::Outcome::failed) ++result.caught;
  }
  return result;
}

}  // namespace broadside::bench
