// FilterSink: a sink that changes or drops pairs and passes the rest to another sink. PassingSink: a filter
// made from a function, such as Rename.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>

#include "broadside/pair.hpp"

namespace broadside::core {

/// consume() must depend on the pairs alone and change only the target, so that several threads can filter
/// at the same time, each with its own filter and target.
class FilterSink : public PairSink {
 public:
  /// The sink if it is a filter, else null.
  static FilterSink* of(PairSink& sink) noexcept { return sink.as_filter(); }

  PairSink& target() const noexcept { return *target_; }

  /// A copy of this filter onto another target, which must outlive it.
  virtual std::unique_ptr<FilterSink> onto(PairSink& target) const = 0;

 protected:
  explicit FilterSink(PairSink& target) : target_(&target) {}

  /// Calls `pass(pair, to)` for each pair. `pass` sets `to` to the pair to pass on, and returns whether to
  /// pass it on. `to` is written in either case, because a branch could not be predicted.
  template <typename Pass>
  void pass_on(std::span<const Pair> pairs, const Pass& pass) {
    while (!pairs.empty()) {
      const std::size_t count = std::min(pairs.size(), max_room);
      Pair* const out = target_->room(count);
      std::size_t passed = 0;
      for (const Pair pair : pairs.first(count)) passed += pass(pair, out[passed]) ? 1 : 0;
      target_->commit(passed);
      pairs = pairs.subspan(count);
    }
  }

 private:
  FilterSink* as_filter() noexcept final { return this; }

  PairSink* target_;
};

/// A filter made from a function as pass_on() takes it. Each thread has its own copy of the function.
template <typename Pass>
class PassingSink final : public FilterSink {
 public:
  PassingSink(Pass pass, PairSink& target) : FilterSink(target), pass_(std::move(pass)) {}

  std::unique_ptr<FilterSink> onto(PairSink& target) const override {
    return std::make_unique<PassingSink>(pass_, target);
  }

 private:
  void consume(std::span<const Pair> pairs) override { pass_on(pairs, pass_); }

  Pass pass_;
};

/// Renames pairs and, between two sets, drops pairs within a set. Within a set, ids ascend with places, so
/// the first id of a pair stays the lower one.
struct Rename {
  bool operator()(Pair pair, Pair& to) const {
    to = {ids[index(pair.first)], ids[index(pair.second)]};
    return left_count == 0 || (index(pair.first) < left_count && index(pair.second) >= left_count);
  }

  std::span<const BoxId> ids;
  std::size_t left_count;
};

/// Calls search(sink) with a filter onto the caller's sink, and flushes the filter. Returns what the search
/// returns.
template <typename Sink, typename Search>
auto search_through(Sink filter, const Search& search) {
  const auto result = search(filter);
  filter.flush();
  return result;
}

}  // namespace broadside::core
