// Batch: the pairs of many worlds, by a search for each, in one call.
#include "broadside/batch.hpp"

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "broadside/algorithm.hpp"

#include "algorithms/registry.hpp"
#include "core/input_check.hpp"
#include "core/message.hpp"
#include "core/parallel.hpp"
#include "find/deliver.hpp"
#include "find/search.hpp"

namespace broadside {
namespace {

/// A world with more than 1 / large_worlds_per_share of a thread's share of all boxes, and at least two
/// threads' minimum, is searched by all threads.
constexpr std::size_t large_worlds_per_share = 4;

/// Passes pairs on and counts them. It is no FilterSink, so a search by several threads cannot bypass it.
class CountingSink final : public PairSink {
 public:
  explicit CountingSink(PairSink& target) : target_(&target) {}

  /// The number of pairs since the last call.
  std::size_t take_count() {
    flush();
    return std::exchange(count_, 0);
  }

 private:
  void consume(std::span<const Pair> pairs) override {
    count_ += pairs.size();
    target_->put(pairs);
  }

  PairSink* target_;
  std::size_t count_ = 0;
};

void check_offsets(std::span<const std::size_t> offsets, std::size_t boxes) {
  if (offsets.empty())
    throw InvalidFrame("0 offsets of worlds; expected one more than there are worlds, at least 1");
  if (offsets.front() != 0)
    throw InvalidFrame(core::message({"the first offset of worlds is ", offsets.front(), "; expected 0"}));
  const auto lesser = std::adjacent_find(offsets.begin(), offsets.end(), std::greater<>());
  if (lesser != offsets.end()) {
    throw InvalidFrame(
        core::message({"offset ", static_cast<std::size_t>(lesser - offsets.begin()) + 1, " of worlds is ",
                       lesser[1], ", after ", lesser[0], "; expected ascending offsets"}));
  }
  if (offsets.back() != boxes) {
    throw InvalidFrame(core::message(
        {"the last offset of worlds is ", offsets.back(), "; expected ", boxes, ", the number of boxes"}));
  }
}

/// The exception for an invalid box, with its world.
template <int D, typename Real>
InvalidInput fault_in_world(std::span<const Box<D, Real>> boxes, std::span<const std::size_t> offsets,
                            std::size_t box) {
  const auto end = std::upper_bound(offsets.begin(), offsets.end(), box);
  const std::size_t world = static_cast<std::size_t>(end - offsets.begin()) - 1;
  const std::string name =
      core::message({"box ", box, ", which is box ", box - offsets[world], " of world ", world, ","});
  return {box, core::fault_of(Box<D, Real>(boxes[box]), name, true)};
}

template <int D, typename Real>
void list_invalid(std::span<const Box<D, Real>> boxes, std::size_t absent,
                  detail::Output<BoxId>& quarantined) {
  std::vector<BoxId> places;
  if (absent > 0) find::list_invalid(boxes, 0, places);
  std::copy(places.begin(), places.end(), quarantined.resize(places.size()).begin());
}

/// Searches worlds of one array of boxes.
template <int D, typename Real>
class Batch {
 public:
  Batch(std::span<const Box<D, Real>> boxes, std::span<const std::size_t> offsets, const Spec& spec,
        const Workers& workers, const PairFilters& filters, std::optional<std::size_t> absent)
      : boxes_(boxes),
        offsets_(offsets),
        algorithm_(algorithm::require_algorithm(spec.name)),
        settings_(algorithm::settings_of(algorithm_, spec)),
        workers_(workers),
        filters_(filters),
        absent_(absent) {
    parallel_.start(workers, boxes.size());
    searches_.resize(parallel_.workers());
  }

  void run(PairSink& pairs, std::span<std::size_t> counts) {
    const std::size_t worlds = offsets_.size() - 1;
    for (std::size_t world = 0; world < worlds;) {
      std::size_t end = world;
      while (end < worlds && !is_large(end)) ++end;
      if (end > world) search_small(world, end, pairs, counts);
      if (end < worlds) {
        CountingSink counting(pairs);
        search(end, 0, workers_, counting);
        counts[end++] = counting.take_count();
      }
      world = end;
    }
  }

 private:
  bool is_large(std::size_t world) const {
    const std::size_t workers = parallel_.workers();
    return workers > 1 && size(world) > boxes_.size() / (large_worlds_per_share * workers) &&
           size(world) >= 2 * workers_.boxes_per_thread;
  }

  std::size_t size(std::size_t world) const { return offsets_[world + 1] - offsets_[world]; }

  void search_small(std::size_t begin, std::size_t end, PairSink& pairs, std::span<std::size_t> counts) {
    parallel_.search(end - begin, pairs, [&](core::Range some, std::size_t worker, PairSink& sink) {
      Workers alone;
      CountingSink counting(sink);
      for (std::size_t world = begin + some.begin; world < begin + some.end; ++world) {
        search(world, worker, alone, counting);
        counts[world] = counting.take_count();
      }
      return Statistics{};
    });
  }

  void search(std::size_t world, std::size_t worker, const Workers& workers, PairSink& pairs) {
    if (size(world) < 2) return;
    std::unique_ptr<find::Search<D, Real>>& search = searches_[worker];
    if (search == nullptr) {
      search = std::make_unique<find::Search<D, Real>>(find::searcher_of<D>(algorithm_, settings_),
                                                       algorithm_.tests_doubles);
    }
    PairFilters filters = filters_;
    if (!filters.filters.empty()) filters.filters = filters.filters.subspan(offsets_[world], size(world));
    search->find(boxes_.subspan(offsets_[world], size(world)), {filters, workers, nullptr, absent_}, pairs);
  }

  std::span<const Box<D, Real>> boxes_;
  std::span<const std::size_t> offsets_;
  const Algorithm& algorithm_;
  Settings settings_;
  const Workers& workers_;
  PairFilters filters_;
  std::optional<std::size_t> absent_;  // 0 if no box is absent; otherwise unknown
  core::Parallel parallel_;
  std::vector<std::unique_ptr<find::Search<D, Real>>> searches_;  // by worker; null until it has a world
};

}  // namespace

template <int D, typename Real>
void detail::find_pairs_batch(BoxView<D, Real> view, std::span<const std::size_t> offsets, const Spec& spec,
                              const Workers& workers, const PairFilters& filters, PairSink& pairs,
                              std::span<std::size_t> pair_offsets, bool touching,
                              Output<BoxId>* quarantined) {
  const core::DefaultEnvironment environment;
  core::check_count(view.size());
  check_offsets(offsets, view.size());
  find::check_filters(filters, view.size());
  std::vector<Box<D, Real>> gathered;
  std::span<const Box<D, Real>> boxes = find::array_of(view, gathered);
  std::size_t absent = 0;
  try {
    absent = find::Search<D, Real>::check_and_count_absent(
        boxes, workers, quarantined == nullptr ? BadInput::reject : BadInput::quarantine);
  } catch (const InvalidInput& error) {
    throw fault_in_world(boxes, offsets, error.index());
  }
  if (quarantined != nullptr) list_invalid(boxes, absent, *quarantined);
  if (!touching) boxes = find::half_open_boxes(boxes, gathered);
  Batch<D, Real> batch(boxes, offsets, spec, workers, filters,
                       absent == 0 ? std::optional<std::size_t>(0) : std::nullopt);
  pair_offsets[0] = 0;
  find::deliver(environment, pairs, [&](PairSink& sink) {
    batch.run(sink, pair_offsets.subspan(1));
    return 0;
  });
  for (std::size_t world = 1; world < offsets.size(); ++world) pair_offsets[world] += pair_offsets[world - 1];
}

template void detail::find_pairs_batch(BoxView<2>, std::span<const std::size_t>, const Spec&, const Workers&,
                                       const PairFilters&, PairSink&, std::span<std::size_t>, bool,
                                       Output<BoxId>*);
template void detail::find_pairs_batch(BoxView<3>, std::span<const std::size_t>, const Spec&, const Workers&,
                                       const PairFilters&, PairSink&, std::span<std::size_t>, bool,
                                       Output<BoxId>*);
template void detail::find_pairs_batch(BoxView<2, double>, std::span<const std::size_t>, const Spec&,
                                       const Workers&, const PairFilters&, PairSink&, std::span<std::size_t>,
                                       bool, Output<BoxId>*);
template void detail::find_pairs_batch(BoxView<3, double>, std::span<const std::size_t>, const Spec&,
                                       const Workers&, const PairFilters&, PairSink&, std::span<std::size_t>,
                                       bool, Output<BoxId>*);

}  // namespace broadside
