// BatchTracker: finds the pairs of every world anew and tells which began and ended.
#include "broadside/batch_tracker.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "broadside/sinks.hpp"

#include "core/float_environment.hpp"
#include "core/grow.hpp"
#include "core/input_check.hpp"
#include "core/message.hpp"
#include "core/parallel.hpp"
#include "find/batch.hpp"
#include "find/deliver.hpp"
#include "kernels/overlap_flags.hpp"

namespace broadside {
namespace {

/// Pairs of worlds, and where each world's begin.
struct WorldPairs {
  BatchPairsView view() const { return {pairs, offsets}; }
  std::size_t bytes() const { return core::bytes_of(pairs, offsets); }

  /// Replaces them by what write(sink, counts) writes.
  template <typename Write>
  void fill(std::size_t worlds, const Write& write) {
    pairs.clear();
    offsets.resize(worlds + 1);
    PairCollector collector(pairs);
    write(static_cast<PairSink&>(collector), std::span(offsets).subspan(1));
    collector.flush();
    find::sum_up(offsets);
  }

  std::vector<Pair> pairs;
  std::vector<std::size_t> offsets = {0};
};

template <int D, typename Real>
struct FrameOfWorlds {
  std::span<const Box<D, Real>> of(std::size_t world) const {
    return std::span(boxes).subspan(offsets[world], offsets[world + 1] - offsets[world]);
  }

  /// Whether the filters of two boxes in a world let them pair.
  bool accepts(std::size_t world, Pair pair) const {
    if (filters.empty()) return true;
    const std::span<const Filter> its_filters = std::span(filters).subspan(offsets[world]);
    return broadside::accepts(its_filters[index(pair.first)], its_filters[index(pair.second)]);
  }

  std::vector<Box<D, Real>> boxes;  // half-open ones if touching does not count
  std::vector<std::size_t> offsets = {0};
  std::vector<Filter> filters;
};

}  // namespace

template <int D, typename Real>
class BROADSIDE_HIDDEN BatchTracker<D, Real>::State {
 public:
  explicit State(const Spec& spec) : search_(spec) { workers.threads = search_.threads(); }

  BatchEvents update(BoxView<D, Real> view, std::span<const std::size_t> offsets,
                     std::span<const Filter> filters) {
    const core::DefaultEnvironment environment;
    core::check_count(view.size());
    find::check_offsets(offsets, view.size());
    if (has_frame_) check_same_worlds(offsets);
    find::check_filters({.filters = filters}, view.size());
    const std::span<const Box<D, Real>> boxes = find::array_of(view, now_.boxes);
    const std::size_t absent = find::BatchSearch<D, Real>::check(boxes, offsets, workers, BadInput::reject);
    if (!touching)
      find::half_open_boxes(boxes, now_.boxes);
    else if (view.is_array())
      now_.boxes.assign(boxes.begin(), boxes.end());
    now_.offsets.assign(offsets.begin(), offsets.end());
    now_.filters.assign(filters.begin(), filters.end());

    const std::size_t worlds = offsets.size() - 1;
    found_.fill(worlds, [&](PairSink& sink, std::span<std::size_t> counts) {
      search_.find(now_.boxes, now_.offsets, workers, {.filters = now_.filters}, absent, sink, counts);
    });
    // In the first frame the frame before has no worlds: all pairs begin.
    const bool same_filters = now_.filters == before_.filters;
    begun_.fill(worlds, [&](PairSink& sink, std::span<std::size_t> counts) {
      write_missing(found_, has_frame_ ? &before_ : nullptr, same_filters, sink, counts);
    });
    ended_.fill(worlds, [&](PairSink& sink, std::span<std::size_t> counts) {
      if (has_frame_) write_missing(pairs_, &now_, same_filters, sink, counts);
    });
    std::swap(pairs_, found_);
    std::swap(before_, now_);
    has_frame_ = true;
    return {begun_.view(), ended_.view()};
  }

  BatchPairsView pairs() const { return pairs_.view(); }
  bool has_frame() const { return has_frame_; }

  std::size_t bytes() const {
    std::size_t bytes = pairs_.bytes() + found_.bytes() + begun_.bytes() + ended_.bytes();
    for (const FrameOfWorlds<D, Real>* frame : {&before_, &now_})
      bytes += core::bytes_of(frame->boxes, frame->offsets, frame->filters);
    return bytes;
  }

  bool touching = true;
  Workers workers;

 private:
  void check_same_worlds(std::span<const std::size_t> offsets) const {
    if (offsets.size() != before_.offsets.size()) {
      throw InvalidFrame(core::message({offsets.size() - 1, " worlds, after ", before_.offsets.size() - 1,
                                        " in the update before; expected as many"}));
    }
    const auto [other, before] = std::mismatch(offsets.begin(), offsets.end(), before_.offsets.begin());
    if (other == offsets.end()) return;
    throw InvalidFrame(core::message(
        {"world ", static_cast<std::size_t>(other - offsets.begin()) - 1, " has ", *other - *(other - 1),
         " boxes, after ", *before - *(before - 1),
         " in the update before; expected as many, absent ones in the places of bodies that are missing"}));
  }

  /// Writes the pairs of one frame that do not hold in the other, or all if there is no other frame.
  ///
  /// No pair is looked up in a list: its boxes tell whether it was a pair in the other frame, unless filters
  /// have changed.
  void write_missing(const WorldPairs& pairs, const FrameOfWorlds<D, Real>* other, bool same_filters,
                     PairSink& sink, std::span<std::size_t> counts) {
    parallel_.start(workers, pairs.pairs.size() / pairs_per_box);
    find::write_worlds(
        parallel_, 0, counts.size(), sink, counts, [&](std::size_t world, std::size_t, PairSink& events) {
          const BatchPairsView view = pairs.view();
          std::span<const Pair> left = view.of(world);
          if (other == nullptr) return events.put(left);
          while (!left.empty()) {
            const std::span<const Pair> some = left.first(std::min(left.size(), PairSink::max_room));
            Pair* const room = events.room(some.size());
            events.commit(same_filters ? kernels::select_apart(other->of(world), some, room)
                                       : select_missing(*other, world, some, room));
            left = left.subspan(some.size());
          }
        });
  }

  static std::size_t select_missing(const FrameOfWorlds<D, Real>& frame, std::size_t world,
                                    std::span<const Pair> pairs, Pair* missing) {
    const std::span<const Box<D, Real>> boxes = frame.of(world);
    const auto end = std::copy_if(pairs.begin(), pairs.end(), missing, [&](Pair pair) {
      const Box<D, Real>& a = boxes[index(pair.first)];
      const Box<D, Real>& b = boxes[index(pair.second)];
      return !(is_present(a) && is_present(b) && overlap(a, b) && frame.accepts(world, pair));
    });
    return static_cast<std::size_t>(end - missing);
  }

  /// The number of pairs that are compared in the time that a search takes for a box.
  static constexpr std::size_t pairs_per_box = 8;

  find::BatchSearch<D, Real> search_;
  core::Parallel parallel_;
  bool has_frame_ = false;
  FrameOfWorlds<D, Real> before_;
  FrameOfWorlds<D, Real> now_;  // outside update(), spare memory, like found_
  WorldPairs pairs_;
  WorldPairs found_;
  WorldPairs begun_;
  WorldPairs ended_;
};

template <int D, typename Real>
BatchTracker<D, Real>::BatchTracker(const Spec& spec) : state_(std::make_unique<State>(spec)) {}
template <int D, typename Real>
BatchTracker<D, Real>::BatchTracker(BatchTracker&& other) noexcept = default;
template <int D, typename Real>
BatchTracker<D, Real>& BatchTracker<D, Real>::operator=(BatchTracker&& other) noexcept = default;
template <int D, typename Real>
BatchTracker<D, Real>::~BatchTracker() = default;

template <int D, typename Real>
BatchEvents BatchTracker<D, Real>::update(BoxView<D, Real> boxes, std::span<const std::size_t> offsets,
                                          std::span<const Filter> filters) {
  return state_->update(boxes, offsets, filters);
}

template <int D, typename Real>
BatchPairsView BatchTracker<D, Real>::pairs() const noexcept {
  return state_->pairs();
}

template <int D, typename Real>
bool BatchTracker<D, Real>::touching() const noexcept {
  return state_->touching;
}

template <int D, typename Real>
void BatchTracker<D, Real>::set_touching(bool touching) {
  if (state_->has_frame())
    throw std::logic_error("set_touching() after the first update(); expected it before");
  state_->touching = touching;
}

template <int D, typename Real>
const Workers& BatchTracker<D, Real>::workers() const noexcept {
  return state_->workers;
}

template <int D, typename Real>
void BatchTracker<D, Real>::set_workers(const Workers& workers) {
  state_->workers = workers;
}

template <int D, typename Real>
std::size_t BatchTracker<D, Real>::bytes() const noexcept {
  return state_->bytes();
}

template class BatchTracker<2>;
template class BatchTracker<3>;
template class BatchTracker<2, double>;
template class BatchTracker<3, double>;

}  // namespace broadside
