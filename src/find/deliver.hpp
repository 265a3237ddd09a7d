// Shared by Finder, find_pairs_batch() and find_pairs_within(): checks filters, prepares boxes, delivers
// pairs to the caller's sink.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "broadside/box_view.hpp"
#include "broadside/error.hpp"
#include "broadside/filter.hpp"
#include "broadside/pair.hpp"

#include "core/float_environment.hpp"
#include "core/input_check.hpp"
#include "core/message.hpp"

namespace broadside::find {

inline void check_filters(std::span<const Filter> filters, std::size_t boxes, const char* set) {
  if (filters.empty() || filters.size() == boxes) return;
  throw InvalidFrame(core::message(
      {filters.size(), " filters for ", boxes, set, " boxes; expected one for each box, or none"}));
}

/// Refuses filters that do not suit a search in one set of `boxes` boxes or, if `right_boxes` is not null,
/// between two sets.
inline void check_filters(const PairFilters& filters, std::size_t boxes,
                          const std::size_t* right_boxes = nullptr) {
  if (right_boxes != nullptr) {
    if (filters.ignored != nullptr && !filters.ignored->empty())
      throw InvalidFrame("ignored pairs for a search between two sets; expected none");
    check_filters(filters.filters, boxes, " left");
    check_filters(filters.right_filters, *right_boxes, " right");
    return;
  }
  if (!filters.right_filters.empty())
    throw InvalidFrame(core::message(
        {filters.right_filters.size(), " right filters for a search in one set; expected none"}));
  check_filters(filters.filters, boxes, "");
}

/// Throws InvalidFrame unless the first ids of all pairs are below `first`, and the second ones below
/// `second`.
inline void check_ids(std::span<const Pair> pairs, std::size_t first, std::size_t second) {
  for (const Pair pair : pairs) {
    if (index(pair.first) < first && index(pair.second) < second) continue;
    throw InvalidFrame(core::message({"a pair of box ", index(pair.first), " and box ", index(pair.second),
                                      "; expected ids below ", first, " and ", second}));
  }
}

/// The boxes as an array: the caller's array, or a copy in `gathered`.
template <int D, typename Real>
std::span<const Box<D, Real>> array_of(BoxView<D, Real> boxes, std::vector<Box<D, Real>>& gathered) {
  if (boxes.is_array()) return {boxes.array(), boxes.size()};
  gathered.resize(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) gathered[i] = boxes[i];
  return gathered;
}

/// Appends the places of invalid boxes to `places`, counted on from `first`.
template <int D, typename Real>
void list_invalid(std::span<const Box<D, Real>> boxes, std::size_t first, std::vector<BoxId>& places) {
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (core::is_invalid(boxes[i])) places.push_back(BoxId(first + i));
  }
}

/// Writes the half-open boxes to `gathered` and returns them. `boxes` may already lie in `gathered`.
template <int D, typename Real>
std::span<const Box<D, Real>> half_open_boxes(std::span<const Box<D, Real>> boxes,
                                              std::vector<Box<D, Real>>& gathered) {
  gathered.resize(boxes.size());
  std::transform(boxes.begin(), boxes.end(), gathered.begin(), half_open<D, Real>);
  return gathered;
}

/// Calls the caller's sink in the caller's environment. It is no FilterSink, so searches cannot bypass it.
class CallersSink final : public PairSink {
 public:
  explicit CallersSink(PairSink& target) : target_(&target) {}
  explicit CallersSink(std::unique_ptr<PairSink> owned) : target_(owned.get()), owned_(std::move(owned)) {}

  std::unique_ptr<PairSink> empty_clone() const override {
    const core::CallersEnvironment environment;
    std::unique_ptr<PairSink> clone = target_->empty_clone();
    return clone == nullptr ? nullptr : std::make_unique<CallersSink>(std::move(clone));
  }

  void merge(PairSink& clone) override {
    const core::CallersEnvironment environment;
    target_->merge(*static_cast<CallersSink&>(clone).target_);
  }

 private:
  void consume(std::span<const Pair> pairs) override {
    const core::CallersEnvironment environment;
    target_->put(pairs);
  }

  PairSink* target_;
  std::unique_ptr<PairSink> owned_;
};

/// Delivers the pairs of search(sink) to the caller's sink, in the caller's environment, and flushes it.
/// Discards what a failed search has left in its buffer. Returns what the search returns.
template <typename Search>
auto deliver(const core::DefaultEnvironment& environment, PairSink& pairs, const Search& search) {
  try {
    if (!environment.is_foreign()) {
      const auto result = search(pairs);
      pairs.flush();
      return result;
    }
    CallersSink sink(pairs);
    const auto result = search(sink);
    sink.flush();
    const core::CallersEnvironment callers;
    pairs.flush();
    return result;
  } catch (...) {
    pairs.discard();
    throw;
  }
}

}  // namespace broadside::find
