// Batch: the pairs of many worlds, by a search for each, in one call.
#include "find/batch.hpp"

#include <algorithm>
#include <functional>

#include "broadside/batch.hpp"

#include "algorithms/registry.hpp"
#include "core/input_check.hpp"
#include "core/message.hpp"
#include "find/deliver.hpp"

namespace broadside {
namespace find {
namespace {

/// A world with more than 1 / large_worlds_per_share of a thread's share of all boxes, and at least two
/// threads' minimum, is searched by all threads.
constexpr std::size_t large_worlds_per_share = 4;

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

}  // namespace

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

void sum_up(std::span<std::size_t> offsets) {
  offsets[0] = 0;
  for (std::size_t world = 1; world < offsets.size(); ++world) offsets[world] += offsets[world - 1];
}

template <int D, typename Real>
BatchSearch<D, Real>::BatchSearch(const Spec& spec)
    : algorithm_(&algorithm::require_algorithm(spec.name)),
      settings_(algorithm::settings_of(*algorithm_, spec)),
      threads_(algorithm::threads_of(*algorithm_, settings_)) {}

template <int D, typename Real>
std::size_t BatchSearch<D, Real>::check(std::span<const Box<D, Real>> boxes,
                                        std::span<const std::size_t> offsets, const Workers& workers,
                                        BadInput bad_input) {
  try {
    return Search<D, Real>::check_and_count_absent(boxes, workers, bad_input);
  } catch (const InvalidInput& error) {
    throw fault_in_world(boxes, offsets, error.index());
  }
}

template <int D, typename Real>
void BatchSearch<D, Real>::find(std::span<const Box<D, Real>> boxes, std::span<const std::size_t> offsets,
                                const Workers& workers, const PairFilters& filters, std::size_t absent,
                                PairSink& pairs, std::span<std::size_t> counts) {
  parallel_.start(workers, boxes.size());
  searches_.resize(parallel_.workers());
  const auto size = [&](std::size_t world) { return offsets[world + 1] - offsets[world]; };
  const auto is_large = [&](std::size_t world) {
    return parallel_.workers() > 1 &&
           size(world) > boxes.size() / (large_worlds_per_share * parallel_.workers()) &&
           size(world) >= 2 * workers.boxes_per_thread;
  };
  const auto search = [&](std::size_t world, std::size_t worker, const Workers& its_workers, PairSink& sink) {
    if (size(world) < 2) return;
    std::unique_ptr<Search<D, Real>>& its_search = searches_[worker];
    if (its_search == nullptr) {
      its_search = std::make_unique<Search<D, Real>>(searchers_of<D>(*algorithm_, settings_));
    }
    PairFilters its_filters = filters;
    if (!filters.filters.empty()) its_filters.filters = filters.filters.subspan(offsets[world], size(world));
    its_search->find(boxes.subspan(offsets[world], size(world)),
                     {.filters = its_filters,
                      .workers = its_workers,
                      .absent = absent == 0 ? std::optional<std::size_t>(0) : std::nullopt},
                     sink);
  };

  const std::size_t worlds = offsets.size() - 1;
  for (std::size_t world = 0; world < worlds;) {
    std::size_t end = world;
    while (end < worlds && !is_large(end)) ++end;
    const Workers alone;
    write_worlds(
        parallel_, world, end, pairs, counts,
        [&](std::size_t small, std::size_t worker, PairSink& sink) { search(small, worker, alone, sink); });
    if (end < worlds) {
      CountingSink counting(pairs);
      search(end, 0, workers, counting);
      counts[end++] = counting.take_count();
    }
    world = end;
  }
}

template class BatchSearch<2, float>;
template class BatchSearch<3, float>;
template class BatchSearch<2, double>;
template class BatchSearch<3, double>;

}  // namespace find

template <int D, typename Real>
void detail::find_pairs_batch(BoxView<D, Real> view, std::span<const std::size_t> offsets, const Spec& spec,
                              const Workers& workers, const PairFilters& filters, PairSink& pairs,
                              std::span<std::size_t> pair_offsets, bool touching,
                              Output<BoxId>* quarantined) {
  const core::DefaultEnvironment environment;
  core::check_count(view.size());
  find::check_offsets(offsets, view.size());
  find::check_filters(filters, view.size());
  std::vector<Box<D, Real>> gathered;
  std::span<const Box<D, Real>> boxes = find::array_of(view, gathered);
  const std::size_t absent = find::BatchSearch<D, Real>::check(
      boxes, offsets, workers, quarantined == nullptr ? BadInput::reject : BadInput::quarantine);
  if (quarantined != nullptr) {
    std::vector<BoxId> places;
    if (absent > 0) find::list_invalid(boxes, 0, places);
    std::copy(places.begin(), places.end(), quarantined->resize(places.size()).begin());
  }
  if (!touching) boxes = find::half_open_boxes(boxes, gathered);
  find::BatchSearch<D, Real> search(spec);
  find::deliver(environment, pairs, [&](PairSink& sink) {
    search.find(boxes, offsets, workers, filters, absent, sink, pair_offsets.subspan(1));
    return 0;
  });
  find::sum_up(pair_offsets);
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
