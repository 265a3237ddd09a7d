// The C API's pairs, finders and trackers.
#include <limits>

#include "bindings/c/c_api_common.hpp"

using namespace broadside;
using namespace broadside::c;

namespace {

constexpr const char* options_name = "broadside_find_options";

/// A sink that appends pairs to a vector of the C API's type.
auto collector(std::vector<broadside_pair>& pairs) {
  return PairFunction([&pairs](std::span<const Pair> more) {
    const std::size_t size = pairs.size();
    pairs.resize(size + more.size());
    copy_as(more, pairs.data() + size);
  });
}

IgnoredPairs ignored_of(const broadside_find_options& options) {
  IgnoredPairs ignored;
  for (const broadside_pair& pair : array_of(options.ignored, options.ignored_count, "ignored"))
    ignored.insert({BoxId{pair.first}, BoxId{pair.second}});
  return ignored;
}

bool are_moving(const broadside_find_options& options) {
  return options.to != nullptr || options.right_to != nullptr;
}

bool has_reach(const broadside_find_options& options) {
  return !(options.distance == 0) || options.radii != nullptr || options.right_radii != nullptr ||
         options.periods != nullptr;
}

/// The options of `what`, which refuses a distance, radii and boxes that move.
broadside_find_options options_without_reach(const broadside_find_options* given, const char* what) {
  const broadside_find_options options = options_of(given, options_name);
  if (has_reach(options))
    throw std::invalid_argument("distance, radii, right_radii or periods are given for " + std::string(what) +
                                "; expected 0 and null");
  if (are_moving(options))
    throw std::invalid_argument("to or right_to are given for " + std::string(what) + "; expected null");
  return options;
}

Reach reach_of(const broadside_find_options& options, std::size_t boxes, const broadside_boxes* right) {
  if (options.radii == nullptr && options.right_radii == nullptr) return options.distance;
  if (!(options.distance == 0)) throw std::invalid_argument("distance and radii are given; expected one");
  if (options.radii == nullptr || (right == nullptr) != (options.right_radii == nullptr))
    throw std::invalid_argument("expected radii and, for two sets alone, right_radii");
  return {std::span(options.radii, boxes),
          std::span(options.right_radii, right == nullptr ? 0 : right->count)};
}

/// Sets what finders and trackers have in common.
template <typename Searching>
void set_up(Searching& searching, const broadside_find_options& options, Executor* executor) {
  use(searching, executor);
  if (options.quarantines != 0) searching.set_bad_input(BadInput::quarantine);
  searching.set_touching(options.leaves_out_touching == 0);
}

template <int D, typename Real>
struct FinderImpl {
  explicit FinderImpl(const broadside_find_options& options)
      : executor(make_executor(options.executor)), finder(spec_of(options.algorithm)) {
    set_up(finder, options, executor.get());
  }

  void find(const broadside_boxes& boxes, const broadside_boxes* right, const broadside_find_options& options,
            PairSink& found) {
    std::vector<Filter> left_filters;
    std::vector<Filter> right_filters;
    const IgnoredPairs ignored = ignored_of(options);
    take_filters(options.filters, boxes.count, left_filters);
    if (right == nullptr && options.right_filters != nullptr)
      throw std::invalid_argument("right_filters are given and right is null; expected both or neither");
    if (right != nullptr) take_filters(options.right_filters, right->count, right_filters);
    const PairFilters filters{left_filters, right_filters, ignored.empty() ? nullptr : &ignored};
    if (has_reach(options) || are_moving(options))
      find_otherwise(view_of<D, Real>(boxes), right, options, found, filters);
    else if (right == nullptr)
      finder.find(view_of<D, Real>(boxes), found, filters);
    else
      finder.find_between(view_of<D, Real>(boxes), view_of<D, Real>(*right), found, filters);
  }

  /// The pairs within a distance, or of boxes that move.
  void find_otherwise(BoxView<D, Real> boxes, const broadside_boxes* right,
                      const broadside_find_options& options, PairSink& found, const PairFilters& filters) {
    std::vector<BoxId> quarantined;
    const FindOptions which{.algorithm = spec_of(options.algorithm),
                            .filters = filters.filters,
                            .right_filters = filters.right_filters,
                            .ignored = filters.ignored,
                            .executor = executor.get(),
                            .touching = options.leaves_out_touching == 0,
                            .quarantined = options.quarantines != 0 ? &quarantined : nullptr};
    if (are_moving(options)) return find_moving(boxes, right, options, found, which);
    Reach reach = reach_of(options, boxes.size(), right);
    if (options.periods != nullptr) reach = reach.periodic(std::span<const double>(options.periods, D));
    if (right == nullptr)
      find_pairs_within(boxes, reach, found, which);
    else
      find_pairs_within(boxes, view_of<D, Real>(*right), reach, found, which);
  }

  static void find_moving(BoxView<D, Real> boxes, const broadside_boxes* right,
                          const broadside_find_options& options, PairSink& found, const FindOptions& which) {
    if (has_reach(options))
      throw std::invalid_argument("distance, radii or periods are given with to; expected 0 and null");
    if (options.to == nullptr)
      throw std::invalid_argument("right_to is given and to is null; expected both, or neither");
    if ((right == nullptr) != (options.right_to == nullptr))
      throw std::invalid_argument(right == nullptr
                                      ? "right_to is given for one set of boxes; expected null"
                                      : "right_to is null and to is given; expected both for two sets");
    const BoxView<D, Real> to = view_of<D, Real>(*options.to);
    if (right == nullptr)
      find_pairs_moving(boxes, to, found, which);
    else
      find_pairs_moving(boxes, to, view_of<D, Real>(*right), view_of<D, Real>(*options.right_to), found,
                        which);
  }

  std::unique_ptr<Executor> executor;
  Finder<D, Real> finder;
};

/// One search, by a temporary finder.
void find_once(const broadside_boxes* boxes, const broadside_boxes* right,
               const broadside_find_options* given, PairSink& pairs) {
  const broadside_find_options options = options_of(given, options_name);
  with_kind(required(boxes, "boxes").kind, [&]<int D, typename Real>() {
    FinderImpl<D, Real>(options).find(*boxes, right, options, pairs);
  });
}

}  // namespace

void broadside_find_options_init(broadside_find_options* options) {
  if (options != nullptr) *options = default_options<broadside_find_options>();
}

broadside_status broadside_count_pairs(const broadside_boxes* boxes, const broadside_boxes* right,
                                       const broadside_find_options* options, uint64_t* count,
                                       broadside_error* error) {
  return guarded(error, [&] {
    required(count, "count");
    PairCounter counter;
    find_once(boxes, right, options, counter);
    *count = counter.count();
  });
}

broadside_status broadside_find_pairs(const broadside_boxes* boxes, const broadside_boxes* right,
                                      const broadside_find_options* options, broadside_pair* pairs,
                                      size_t room, uint64_t* count, broadside_error* error) {
  return guarded(error, [&] {
    array_of(pairs, room, "pairs");
    required(count, "count");
    std::uint64_t found = 0;
    PairFunction sink([&](std::span<const Pair> more) {
      if (found < room) copy_as(more.first(std::min<std::size_t>(more.size(), room - found)), pairs + found);
      found += more.size();
    });
    find_once(boxes, right, options, sink);
    *count = found;
    if (found > room) throw too_small(room, "pairs", found);
  });
}

broadside_status broadside_for_each_pairs(const broadside_boxes* boxes, const broadside_boxes* right,
                                          const broadside_find_options* options,
                                          broadside_pairs_callback callback, void* user,
                                          broadside_error* error) {
  return guarded(error, [&] {
    required(callback, "callback");
    std::vector<broadside_pair> chunk;
    PairFunction sink([&](std::span<const Pair> pairs) {
      copy_as(pairs, chunk);
      if (callback(user, chunk.data(), chunk.size()) != 0)
        throw StatusError(BROADSIDE_STOPPED, "a callback asked to stop");
    });
    find_once(boxes, right, options, sink);
  });
}

broadside_status broadside_find_pairs_batch(const broadside_boxes* boxes, const size_t* offsets,
                                            size_t worlds, const broadside_find_options* given,
                                            broadside_pair* pairs, size_t room, size_t* pair_offsets,
                                            broadside_error* error) {
  return guarded(error, [&] {
    array_of(pairs, room, "pairs");
    required(offsets, "offsets");
    required(pair_offsets, "pair_offsets");
    const broadside_find_options options = options_without_reach(given, "a batch");
    if (options.right_filters != nullptr)
      throw std::invalid_argument("right_filters are given for a batch; expected null");
    const auto executor = make_executor(options.executor);
    std::vector<Filter> filters;
    take_filters(options.filters, required(boxes, "boxes").count, filters);
    const IgnoredPairs ignored = ignored_of(options);
    std::vector<BoxId> quarantined;
    const FindOptions which{.algorithm = spec_of(options.algorithm),
                            .filters = filters,
                            .ignored = &ignored,
                            .executor = executor.get(),
                            .touching = options.leaves_out_touching == 0,
                            .quarantined = options.quarantines != 0 ? &quarantined : nullptr};
    const BatchPairs found = with_kind(boxes->kind, [&]<int D, typename Real>() {
      return find_pairs_batch(view_of<D, Real>(*boxes), {offsets, worlds + 1}, which);
    });
    std::copy(found.offsets.begin(), found.offsets.end(), pair_offsets);
    copy_as(std::span(found.pairs).first(std::min(found.pairs.size(), room)), pairs);
    if (found.pairs.size() > room) throw too_small(room, "pairs", found.pairs.size());
  });
}

broadside_boxes broadside_intervals(const double* minima, const double* maxima, std::size_t count,
                                    double* rows) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < count; ++i) {
    const bool is_absent = minima[i] == infinity && maxima[i] == -infinity;
    const DoubleBox2 box = is_absent ? absent_box<2, double>() : interval(minima[i], maxima[i]);
    std::memcpy(rows + 4 * i, &box, sizeof(box));
  }
  return {BROADSIDE_DOUBLE_2D, rows, count, 0};
}

broadside_status broadside_components(const broadside_boxes* boxes, const broadside_find_options* options,
                                      uint32_t* labels, broadside_error* error) {
  return guarded(error, [&] {
    const std::size_t count = required(boxes, "boxes").count;
    array_of(labels, count, "labels");
    Components components(count);
    find_once(boxes, nullptr, options, components);
    copy_as(std::span<const BoxId>(components.labels()), labels);
  });
}

broadside_status broadside_distances(const broadside_boxes* boxes, const broadside_boxes* right,
                                     const broadside_pair* pairs, size_t count, double* found,
                                     broadside_error* error) {
  return guarded(error, [&] {
    array_of(found, count, "distances");
    std::vector<Pair> which;
    copy_as(array_of(pairs, count, "pairs"), which);
    const std::vector<double> all = with_kind(required(boxes, "boxes").kind, [&]<int D, typename Real>() {
      return distances(view_of<D, Real>(*boxes), view_of<D, Real>(right == nullptr ? *boxes : *right), which);
    });
    copy_as(std::span(all), found);
  });
}

broadside_status broadside_overlap_times(const broadside_boxes* boxes, const broadside_boxes* to,
                                         const broadside_boxes* right, const broadside_boxes* right_to,
                                         const broadside_pair* pairs, size_t count,
                                         broadside_overlap_time* times, broadside_error* error) {
  return guarded(error, [&] {
    array_of(times, count, "times");
    if ((right == nullptr) != (right_to == nullptr))
      throw std::invalid_argument(right == nullptr
                                      ? "right is null and right_to is given; expected both, or neither"
                                      : "right_to is null and right is given; expected both, or neither");
    std::vector<Pair> which;
    copy_as(array_of(pairs, count, "pairs"), which);
    const std::vector<OverlapTime> found =
        with_kind(required(boxes, "boxes").kind, [&]<int D, typename Real>() {
          const BoxView<D, Real> from = view_of<D, Real>(*boxes);
          const BoxView<D, Real> end = view_of<D, Real>(required(to, "to"));
          if (right == nullptr) return overlap_times(from, end, which);
          return overlap_times(from, end, view_of<D, Real>(*right), view_of<D, Real>(*right_to), which);
        });
    for (std::size_t i = 0; i < count; ++i) times[i] = {found[i].enter, found[i].leave};
  });
}

broadside_status broadside_neighbours(const broadside_pair* pairs, size_t count, size_t boxes, int is_full,
                                      size_t* offsets, uint32_t* ids, broadside_error* error) {
  return guarded(error, [&] {
    required(offsets, "offsets");
    array_of(ids, count, "neighbours");
    std::vector<Pair> which;
    copy_as(array_of(pairs, count, "pairs"), which);
    const Neighbours found =
        neighbours(std::move(which), boxes, is_full != 0 ? NeighbourLists::full : NeighbourLists::half);
    std::copy(found.offsets.begin(), found.offsets.end(), offsets);
    copy_as(std::span(found.ids), ids);
  });
}

// ---- Finders ----

struct broadside_finder : AnyKind<FinderImpl> {
  using AnyKind::AnyKind;
  static constexpr const char* name = "finder";

  std::vector<broadside_pair> pairs;
  std::vector<std::uint32_t> quarantined;
};

broadside_status broadside_finder_create(int api_version, broadside_kind kind,
                                         const broadside_find_options* options, broadside_finder** finder,
                                         broadside_error* error) {
  return create(api_version, finder, error,
                [&] { return new broadside_finder(kind, options_without_reach(options, "a finder")); });
}

void broadside_finder_destroy(broadside_finder* finder) { delete finder; }

broadside_status broadside_finder_find(broadside_finder* finder, const broadside_boxes* boxes,
                                       const broadside_boxes* right, const broadside_find_options* options,
                                       const broadside_pair** pairs, size_t* count, broadside_error* error) {
  return call(finder, error, [&](auto& self) {
    required(pairs, "pairs");
    required(count, "count");
    finder->pairs.clear();
    auto sink = collector(finder->pairs);
    self.find(required(boxes, "boxes"), right, options_without_reach(options, "a finder"), sink);
    copy_as(self.finder.quarantined(), finder->quarantined);
    *pairs = finder->pairs.data();
    *count = finder->pairs.size();
  });
}

const uint32_t* broadside_finder_quarantined(const broadside_finder* finder, size_t* count) {
  if (count != nullptr) *count = finder == nullptr ? 0 : finder->quarantined.size();
  return finder == nullptr ? nullptr : finder->quarantined.data();
}

// ---- Trackers ----

namespace {

template <int D, typename Real>
struct TrackerImpl {
  explicit TrackerImpl(const broadside_find_options& options)
      : executor(make_executor(options.executor)), tracker(spec_of(options.algorithm)) {
    set_up(tracker, options, executor.get());
  }

  std::unique_ptr<Executor> executor;
  Tracker<D, Real> tracker;
  FrameMemory<D, Real> memory;
};

}  // namespace

struct broadside_tracker : AnyKind<TrackerImpl> {
  using AnyKind::AnyKind;
  static constexpr const char* name = "tracker";

  std::vector<broadside_pair> begun;
  std::vector<broadside_pair> ended;
};

broadside_status broadside_tracker_create(int api_version, broadside_kind kind,
                                          const broadside_find_options* options, broadside_tracker** tracker,
                                          broadside_error* error) {
  return create(api_version, tracker, error,
                [&] { return new broadside_tracker(kind, options_without_reach(options, "a tracker")); });
}

void broadside_tracker_destroy(broadside_tracker* tracker) { delete tracker; }

broadside_status broadside_tracker_update(broadside_tracker* tracker, const broadside_boxes* boxes,
                                          const uint32_t* changed, size_t changed_count,
                                          const broadside_filter* filters, broadside_pair_events* events,
                                          broadside_error* error) {
  return call(tracker, error, [&](auto& self) {
    required(events, "events");
    const auto frame = self.memory.frame(required(boxes, "boxes"), changed, changed_count, filters);
    tracker->begun.clear();
    tracker->ended.clear();
    auto begun = collector(tracker->begun);
    auto ended = collector(tracker->ended);
    self.tracker.update(frame, begun, ended);
    *events = {tracker->begun.data(), tracker->begun.size(), tracker->ended.data(), tracker->ended.size()};
  });
}

// ---- Trackers of many worlds ----

namespace {

template <int D, typename Real>
struct BatchTrackerImpl {
  explicit BatchTrackerImpl(const broadside_find_options& options)
      : executor(make_executor(options.executor)), tracker(spec_of(options.algorithm)) {
    if (options.quarantines != 0)
      throw std::invalid_argument("quarantines is set for a batch tracker; expected 0");
    Workers workers = tracker.workers();
    workers.executor = executor.get();
    tracker.set_workers(workers);
    tracker.set_touching(options.leaves_out_touching == 0);
  }

  std::unique_ptr<Executor> executor;
  BatchTracker<D, Real> tracker;
};

}  // namespace

struct broadside_batch_tracker : AnyKind<BatchTrackerImpl> {
  using AnyKind::AnyKind;
  static constexpr const char* name = "batch tracker";

  std::vector<broadside_pair> begun;
  std::vector<broadside_pair> ended;
};

broadside_status broadside_batch_tracker_create(int api_version, broadside_kind kind,
                                                const broadside_find_options* options,
                                                broadside_batch_tracker** tracker, broadside_error* error) {
  return create(api_version, tracker, error, [&] {
    return new broadside_batch_tracker(kind, options_without_reach(options, "a batch tracker"));
  });
}

void broadside_batch_tracker_destroy(broadside_batch_tracker* tracker) { delete tracker; }

broadside_status broadside_batch_tracker_update(broadside_batch_tracker* tracker,
                                                const broadside_boxes* boxes, const size_t* offsets,
                                                size_t worlds, const broadside_filter* filters,
                                                broadside_batch_events* events, broadside_error* error) {
  return call(tracker, error, [&]<int D, typename Real>(BatchTrackerImpl<D, Real>& self) {
    required(offsets, "offsets");
    required(events, "events");
    std::vector<Filter> kinds;
    take_filters(filters, required(boxes, "boxes").count, kinds);
    const BatchEvents found = self.tracker.update(view_of<D, Real>(*boxes), {offsets, worlds + 1}, kinds);
    tracker->begun.resize(found.begun.pairs.size());
    tracker->ended.resize(found.ended.pairs.size());
    copy_as(found.begun.pairs, tracker->begun.data());
    copy_as(found.ended.pairs, tracker->ended.data());
    *events = {tracker->begun.data(), found.begun.offsets.data(), tracker->ended.data(),
               found.ended.offsets.data()};
  });
}

// ---- Owners ----

struct broadside_owner_pairs {
  OwnerPairs pairs;
  std::vector<broadside_owner_pair> begun;
  std::vector<broadside_owner_pair> ended;
};

broadside_status broadside_owner_pairs_create(int api_version, broadside_owner_pairs** owner_pairs,
                                              broadside_error* error) {
  return guarded(error, [&] {
    check_api_version(api_version);
    required(owner_pairs, "owner_pairs") = new broadside_owner_pairs;
  });
}

void broadside_owner_pairs_destroy(broadside_owner_pairs* owner_pairs) { delete owner_pairs; }

broadside_status broadside_owner_pairs_update(broadside_owner_pairs* owner_pairs,
                                              const broadside_owner_pair* begun, size_t begun_count,
                                              const broadside_owner_pair* ended, size_t ended_count,
                                              broadside_owner_events* events, broadside_error* error) {
  return guarded(error, [&] {
    broadside_owner_pairs& self = required(owner_pairs, "owner_pairs");
    required(events, "events");
    const OwnerEvents found =
        self.pairs.update(array_of(begun, begun_count, "begun"), array_of(ended, ended_count, "ended"));
    copy_as(found.begun, self.begun);
    copy_as(found.ended, self.ended);
    *events = {self.begun.data(), self.begun.size(), self.ended.data(), self.ended.size()};
  });
}
