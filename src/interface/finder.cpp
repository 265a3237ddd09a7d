// PairFinder: what every finder does before its algorithm sees the boxes.
#include "broadside/finder.hpp"

#include <algorithm>
#include <atomic>
#include <memory>

#include "broadside/error.hpp"
#include "broadside/tracker.hpp"

#include "core/filter_sink.hpp"
#include "core/large_array.hpp"
#include "core/lean.hpp"
#include "core/message.hpp"
#include "core/parallel.hpp"
#include "interface/callers_sink.hpp"
#include "interface/input_check.hpp"
#include "kernels/observed_tests.hpp"

namespace broadside {
namespace {

/// Passes pairs on under other ids; between two sets, only pairs of a box of each. Within a set the ids
/// ascend with the places they stand for, so that its pairs stay ordered.
class RenamingSink final : public core::FilterSink {
 public:
  RenamingSink(std::span<const BoxId> ids, std::size_t left_count, PairSink& target)
      : FilterSink(target), ids_(ids), left_count_(left_count) {}

  std::unique_ptr<FilterSink> onto(PairSink& target) const override {
    return std::make_unique<RenamingSink>(ids_, left_count_, target);
  }

 private:
  void consume(std::span<const Pair> pairs) override {
    pass_on(pairs, [this](Pair pair, Pair& to) {
      to = {ids_[index(pair.first)], ids_[index(pair.second)]};
      return left_count_ == 0 || (index(pair.first) < left_count_ && index(pair.second) >= left_count_);
    });
  }

  std::span<const BoxId> ids_;
  std::size_t left_count_;
};

/// Passes on pairs between the boxes before place `left_count` and the others, as places in those two sets.
class CrossingSink final : public core::FilterSink {
 public:
  CrossingSink(std::size_t left_count, PairSink& target)
      : FilterSink(target), left_count_(static_cast<std::uint32_t>(left_count)) {}

  std::unique_ptr<FilterSink> onto(PairSink& target) const override {
    return std::make_unique<CrossingSink>(left_count_, target);
  }

 private:
  void consume(std::span<const Pair> pairs) override {
    pass_on(pairs, [this](Pair pair, Pair& to) {
      to = {pair.first, BoxId{index(pair.second) - left_count_}};
      return index(pair.first) < left_count_ && index(pair.second) >= left_count_;
    });
  }

  std::uint32_t left_count_;
};

/// Passes on pairs that filters let count.
class FilteringSink final : public core::FilterSink {
 public:
  /// Of two sets if `right` is not null.
  FilteringSink(std::span<const Filter> left, const std::span<const Filter>* right,
                const IgnoredPairs* ignored, PairSink& target)
      : FilterSink(target), left_(left), right_(right), ignored_(ignored) {}

  std::unique_ptr<FilterSink> onto(PairSink& target) const override {
    return std::make_unique<FilteringSink>(left_, right_, ignored_, target);
  }

 private:
  static Filter filter_of(std::span<const Filter> filters, BoxId id) {
    return filters.empty() ? Filter{} : filters[index(id)];
  }

  void consume(std::span<const Pair> pairs) override {
    const std::span<const Filter> right = right_ == nullptr ? left_ : *right_;
    pass_on(pairs, [&](Pair pair, Pair& to) {
      to = pair;
      return accepts(filter_of(left_, pair.first), filter_of(right, pair.second)) &&
             (ignored_ == nullptr || !ignored_->contains(pair));
    });
  }

  std::span<const Filter> left_;
  const std::span<const Filter>* right_;
  const IgnoredPairs* ignored_;
};

void check_filters(std::span<const Filter> filters, std::size_t boxes, const char* set) {
  if (filters.empty() || filters.size() == boxes) return;
  throw InvalidFrame(core::message(
      {filters.size(), " filters for ", boxes, set, " boxes; expected one for each box, or none"}));
}

/// The boxes as an array: the caller's array, or a copy in `scratch`.
template <int D, typename Real>
std::span<const Box<D, Real>> array_of(BoxView<D, Real> boxes, detail::Vector<Box<D, Real>>& scratch) {
  if (boxes.is_array()) return {boxes.array(), boxes.size()};
  scratch.resize(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) scratch[i] = boxes[i];
  return scratch;
}

/// Runs a search that writes to `pairs`; what a failed one has left there is forgotten.
template <typename Search>
void deliver(PairSink& pairs, Search search) {
  try {
    search();
    pairs.flush();
  } catch (...) {
    pairs.discard();
    throw;
  }
}

}  // namespace

template <int D, typename Real>
void PairFinder<D, Real>::find(BoxView<D, Real> view, PairSink& pairs, const PairFilters& filters) {
  const core::DefaultEnvironment environment;
  if (environment.is_foreign())
    return core::search_for_caller(pairs, [&](PairSink& sink) { find(view, sink, filters); });
  core::check_count(view.size());
  if (!filters.right_filters.empty())
    throw InvalidFrame("filters of a right set for a search in one set; expected none");
  if (!filters.empty()) {
    check_filters(filters.filters, view.size(), "");
    FilteringSink filtered(filters.filters, nullptr, filters.ignored, pairs);
    return deliver(pairs, [&] { find(view, filtered); });
  }
  const std::span<const Box<D, Real>> boxes = array_of(view, gathered_[0]);
  const std::size_t absent = check(boxes);
  quarantined_.clear();
  if (absent > 0) list_invalid(boxes, 0);
  statistics_.reset();
  left_count_ = 0;
  deliver(pairs, [&] {
    if (absent == 0) {
      find_valid(boxes, pairs);
      return;
    }
    present_.clear();
    ids_.clear();
    take_present(boxes);
    RenamingSink renamed(ids_, left_count_, pairs);
    const std::size_t observed = kernels::is_observing ? kernels::observed_tests().size() : 0;
    find_valid(present_, renamed);
    if constexpr (kernels::is_observing) kernels::rename_observed_tests(observed, ids_);
    renamed.flush();
  });
}

template <int D, typename Real>
void PairFinder<D, Real>::find_between(BoxView<D, Real> left_view, BoxView<D, Real> right_view,
                                       PairSink& pairs, const PairFilters& filters) {
  const core::DefaultEnvironment environment;
  if (environment.is_foreign())
    return core::search_for_caller(
        pairs, [&](PairSink& sink) { find_between(left_view, right_view, sink, filters); });
  core::check_count(left_view.size() + right_view.size());
  if (!filters.empty()) {
    if (filters.ignored != nullptr && !filters.ignored->empty())
      throw InvalidFrame("ignored pairs for a search between two sets; expected none");
    check_filters(filters.filters, left_view.size(), " left");
    check_filters(filters.right_filters, right_view.size(), " right");
    FilteringSink filtered(filters.filters, &filters.right_filters, nullptr, pairs);
    return deliver(pairs, [&] { find_between(left_view, right_view, filtered); });
  }
  const std::span<const Box<D, Real>> left = array_of(left_view, gathered_[0]);
  const std::span<const Box<D, Real>> right = array_of(right_view, gathered_[1]);
  const std::size_t absent_left = check(left, "left ");
  const std::size_t absent_right = check(right, "right ");
  quarantined_.clear();
  if (absent_left > 0) list_invalid(left, 0);
  if (absent_right > 0) list_invalid(right, left.size());
  statistics_.reset();
  present_.clear();
  if (absent_left + absent_right == 0) {
    core::reserve_large(present_, left.size() + right.size());
    present_.insert(present_.end(), left.begin(), left.end());
    present_.insert(present_.end(), right.begin(), right.end());
    find_valid_between(present_, left.size(), pairs);
    return;
  }
  ids_.clear();
  take_present(left);
  left_count_ = present_.size();
  take_present(right);
  deliver(pairs, [&] {
    if (left_count_ == 0 || left_count_ == present_.size()) return;
    RenamingSink crossing(ids_, left_count_, pairs);
    find_valid(present_, crossing);
    crossing.flush();
  });
}

template <int D, typename Real>
void PairFinder<D, Real>::find_between(std::span<const Box<D, Real>> boxes, std::size_t left_count,
                                       PairSink& pairs) {
  const core::DefaultEnvironment environment;
  if (environment.is_foreign())
    return core::search_for_caller(pairs, [&](PairSink& sink) { find_between(boxes, left_count, sink); });
  const std::span<const Box<D, Real>> left = boxes.first(left_count);
  const std::span<const Box<D, Real>> right = boxes.subspan(left_count);
  core::check_count(boxes.size());
  if (check(left, "left ") + check(right, "right ") > 0) {
    find_between(left, right, pairs);
    return;
  }
  quarantined_.clear();
  statistics_.reset();
  find_valid_between(boxes, left_count, pairs);
}

template <int D, typename Real>
void PairFinder<D, Real>::find_valid_between(std::span<const Box<D, Real>> boxes, std::size_t left_count,
                                             PairSink& pairs) {
  left_count_ = left_count;
  deliver(pairs, [&] {
    if (left_count == 0 || left_count == boxes.size()) return;
    CrossingSink crossing(left_count, pairs);
    find_valid(boxes, crossing);
    crossing.flush();
  });
}

template <int D, typename Real>
std::size_t PairFinder<D, Real>::check(std::span<const Box<D, Real>> boxes, const char* which) const {
  core::Parallel parallel;
  parallel.start(workers_, boxes.size());
  std::atomic<std::size_t> absent = 0;
  // Each range that throws names its first box at fault; the first such range's exception is the one thrown.
  parallel.for_ranges(boxes.size(), [&](core::Range range, std::size_t) {
    absent.fetch_add(core::check_boxes(boxes.first(range.end), range.begin, bad_input_, which),
                     std::memory_order_relaxed);
  });
  return absent;
}

template <int D, typename Real>
void PairFinder<D, Real>::list_invalid(std::span<const Box<D, Real>> boxes, std::size_t first) {
  if (core::is_lean || bad_input_ == BadInput::reject) return;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (core::is_invalid(boxes[i])) quarantined_.push_back(BoxId(first + i));
  }
}

template <int D, typename Real>
void PairFinder<D, Real>::take_present(std::span<const Box<D, Real>> boxes) {
  core::reserve_large(present_, present_.size() + boxes.size());
  ids_.reserve(ids_.size() + boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Box<D, Real> box = boxes[i];  // a copy, since another thread may change the caller's
    if (!is_present(box)) continue;
    present_.push_back(box);
    ids_.push_back(BoxId(i));
  }
}

template class PairFinder<2, float>;
template class PairFinder<2, double>;
template class PairFinder<3, float>;
template class PairFinder<3, double>;

}  // namespace broadside
