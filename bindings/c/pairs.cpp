// The C API's pairs, finders and trackers.
#include "bindings/c/c_api_common.hpp"

using namespace broadside;
using namespace broadside::c;

namespace {

/// Passes pairs to a C function.
class CallbackSink final : public PairSink {
 public:
  CallbackSink(broadside_pairs_callback callback, void* user) : callback_(callback), user_(user) {}

 private:
  void consume(std::span<const Pair> pairs) override {
    copy_as(pairs, chunk_);
    if (callback_(user_, chunk_.data(), chunk_.size()) != 0) throw StopAsked();
  }

  broadside_pairs_callback callback_;
  void* user_;
  std::vector<broadside_pair> chunk_;
};

/// Writes pairs to the caller's buffer while there is room, and counts them all.
class BufferSink final : public PairSink {
 public:
  BufferSink(broadside_pair* pairs, std::size_t room) : pairs_(pairs), room_(room) {}

  std::uint64_t count() const { return count_; }

 private:
  void consume(std::span<const Pair> pairs) override {
    if (count_ < room_)
      copy_as(pairs.first(std::min<std::size_t>(pairs.size(), room_ - count_)), pairs_ + count_);
    count_ += pairs.size();
  }

  broadside_pair* pairs_;
  std::uint64_t room_;
  std::uint64_t count_ = 0;
};

/// Appends pairs to a vector of the C API's type.
class CPairCollector final : public PairSink {
 public:
  explicit CPairCollector(std::vector<broadside_pair>& pairs) : pairs_(&pairs) {}

 private:
  void consume(std::span<const Pair> pairs) override {
    const std::size_t size = pairs_->size();
    pairs_->resize(size + pairs.size());
    copy_as(pairs, pairs_->data() + size);
  }

  std::vector<broadside_pair>* pairs_;
};

broadside_find_options standard_options() {
  broadside_find_options options;
  broadside_find_options_init(&options);
  return options;
}

const broadside_find_options& checked(const broadside_find_options* options) {
  static const broadside_find_options standard = standard_options();
  if (options == nullptr) return standard;
  check_size(options->size, sizeof(*options), "broadside_find_options");
  return *options;
}

/// Which pairs count, in the library's types.
class Filters {
 public:
  Filters(const broadside_find_options& options, const broadside_boxes& boxes, const broadside_boxes* right) {
    take_filters(options.filters, boxes.count, left_);
    if (right == nullptr && options.right_filters != nullptr)
      throw std::invalid_argument("right_filters are given and right is null; expected both or neither");
    if (right != nullptr) take_filters(options.right_filters, right->count, right_);
    for (const broadside_pair& pair : array_of(options.ignored, options.ignored_count, "ignored"))
      ignored_.insert({BoxId{pair.first}, BoxId{pair.second}});
  }

  PairFilters get() const { return {left_, right_, ignored_.empty() ? nullptr : &ignored_}; }

 private:
  std::vector<Filter> left_;
  std::vector<Filter> right_;
  IgnoredPairs ignored_;
};

template <int D, typename Real>
void find(Finder<D, Real>& finder, const broadside_boxes& boxes, const broadside_boxes* right,
          const broadside_find_options& options, PairSink& pairs) {
  const Filters filters(options, boxes, right);
  if (right == nullptr)
    finder.find(view_of<D, Real>(boxes), pairs, filters.get());
  else
    finder.find_between(view_of<D, Real>(boxes), view_of<D, Real>(*right), pairs, filters.get());
}

template <int D, typename Real>
Finder<D, Real> finder_of(const broadside_find_options& options, Executor* executor) {
  Finder<D, Real> finder(spec_of(options.algorithm));
  use(finder, executor);
  if (options.quarantines != 0) finder.set_bad_input(BadInput::quarantine);
  return finder;
}

/// One search, by a temporary finder.
void find_once(const broadside_boxes* boxes, const broadside_boxes* right,
               const broadside_find_options* options, PairSink& pairs) {
  const broadside_find_options& wishes = checked(options);
  const auto executor = make_executor(wishes.executor);
  with_kind(required(boxes, "boxes").kind, [&]<int D, typename Real>() {
    auto finder = finder_of<D, Real>(wishes, executor.get());
    find(finder, *boxes, right, wishes, pairs);
  });
}

}  // namespace

void broadside_find_options_init(broadside_find_options* options) {
  if (options == nullptr) return;
  *options = {};
  options->size = sizeof(*options);
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
    BufferSink sink(pairs, room);
    find_once(boxes, right, options, sink);
    *count = sink.count();
    if (sink.count() > room) throw TooSmall(room, "pairs", sink.count());
  });
}

broadside_status broadside_for_each_pairs(const broadside_boxes* boxes, const broadside_boxes* right,
                                          const broadside_find_options* options,
                                          broadside_pairs_callback callback, void* user,
                                          broadside_error* error) {
  return guarded(error, [&] {
    required(callback, "callback");
    CallbackSink sink(callback, user);
    find_once(boxes, right, options, sink);
  });
}

// ---- Finders ----

struct broadside_finder {
  virtual ~broadside_finder() = default;
  virtual void find(const broadside_boxes& boxes, const broadside_boxes* right,
                    const broadside_find_options& options) = 0;

  std::vector<broadside_pair> pairs;
  std::vector<std::uint32_t> quarantined;
};

namespace {

template <int D, typename Real>
class FinderImpl final : public broadside_finder {
 public:
  explicit FinderImpl(const broadside_find_options& options)
      : executor_(make_executor(options.executor)), finder_(finder_of<D, Real>(options, executor_.get())) {}

  void find(const broadside_boxes& boxes, const broadside_boxes* right,
            const broadside_find_options& options) override {
    pairs.clear();
    CPairCollector collector(pairs);
    ::find(finder_, boxes, right, options, collector);
    copy_as(finder_.quarantined(), quarantined);
  }

 private:
  std::unique_ptr<Executor> executor_;
  Finder<D, Real> finder_;
};

}  // namespace

broadside_status broadside_finder_create(int api_version, broadside_kind kind,
                                         const broadside_find_options* options, broadside_finder** finder,
                                         broadside_error* error) {
  return guarded(error, [&] {
    check_api_version(api_version);
    required(finder, "finder");
    *finder = with_kind(kind, [&]<int D, typename Real>() -> broadside_finder* {
      return new FinderImpl<D, Real>(checked(options));
    });
  });
}

void broadside_finder_destroy(broadside_finder* finder) { delete finder; }

broadside_status broadside_finder_find(broadside_finder* finder, const broadside_boxes* boxes,
                                       const broadside_boxes* right, const broadside_find_options* options,
                                       const broadside_pair** pairs, size_t* count, broadside_error* error) {
  return guarded(error, [&] {
    required(pairs, "pairs");
    required(count, "count");
    required(finder, "finder").find(required(boxes, "boxes"), right, checked(options));
    *pairs = finder->pairs.data();
    *count = finder->pairs.size();
  });
}

const uint32_t* broadside_finder_quarantined(const broadside_finder* finder, size_t* count) {
  if (count != nullptr) *count = finder == nullptr ? 0 : finder->quarantined.size();
  return finder == nullptr ? nullptr : finder->quarantined.data();
}

// ---- Trackers ----

struct broadside_tracker {
  virtual ~broadside_tracker() = default;
  virtual void update(const broadside_boxes& boxes, const std::uint32_t* changed, std::size_t changed_count,
                      const broadside_filter* filters) = 0;

  std::vector<broadside_pair> begun;
  std::vector<broadside_pair> ended;
};

namespace {

template <int D, typename Real>
class TrackerImpl final : public broadside_tracker {
 public:
  explicit TrackerImpl(const broadside_find_options& options)
      : executor_(make_executor(options.executor)), tracker_(spec_of(options.algorithm)) {
    use(tracker_, executor_.get());
    if (options.quarantines != 0) tracker_.set_bad_input(BadInput::quarantine);
  }

  void update(const broadside_boxes& boxes, const std::uint32_t* changed, std::size_t changed_count,
              const broadside_filter* filters) override {
    const Frame<D, Real> frame = memory_.frame(boxes, changed, changed_count, filters);
    begun.clear();
    ended.clear();
    CPairCollector begun_collector(begun);
    CPairCollector ended_collector(ended);
    tracker_.update(frame, begun_collector, ended_collector);
  }

 private:
  std::unique_ptr<Executor> executor_;
  Tracker<D, Real> tracker_;
  FrameMemory<D, Real> memory_;
};

}  // namespace

broadside_status broadside_tracker_create(int api_version, broadside_kind kind,
                                          const broadside_find_options* options, broadside_tracker** tracker,
                                          broadside_error* error) {
  return guarded(error, [&] {
    check_api_version(api_version);
    required(tracker, "tracker");
    *tracker = with_kind(kind, [&]<int D, typename Real>() -> broadside_tracker* {
      return new TrackerImpl<D, Real>(checked(options));
    });
  });
}

void broadside_tracker_destroy(broadside_tracker* tracker) { delete tracker; }

broadside_status broadside_tracker_update(broadside_tracker* tracker, const broadside_boxes* boxes,
                                          const uint32_t* changed, size_t changed_count,
                                          const broadside_filter* filters, broadside_pair_events* events,
                                          broadside_error* error) {
  return guarded(error, [&] {
    required(events, "events");
    required(tracker, "tracker").update(required(boxes, "boxes"), changed, changed_count, filters);
    *events = {tracker->begun.data(), tracker->begun.size(), tracker->ended.data(), tracker->ended.size()};
  });
}
