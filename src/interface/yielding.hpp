// A search that gives up where it makes far more tests than its boxes and pairs account for.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "core/filter_sink.hpp"

namespace broadside::core {

/// A finder whose searches can give up derives from this too; another algorithm then finds the remaining
/// pairs. Whether one gives up, and where, depends on the boxes alone and not on the number of threads.
template <int D>
class Yielding {
 public:
  Yielding() = default;
  Yielding(const Yielding&) = delete;
  Yielding& operator=(const Yielding&) = delete;
  virtual ~Yielding() = default;

  /// Whether searches may give up from now on; at first, none may.
  void let_yield(bool may_yield) noexcept { may_yield_ = may_yield; }

  /// Whether the last search gave up. It has then written some of the pairs; is_left() tells the others.
  bool has_yielded() const noexcept { return has_yielded_; }

  /// After a search that gave up: whether it did not write the pair of these two boxes, which overlap.
  virtual bool is_left(const Box<D>& a, BoxId a_id, const Box<D>& b, BoxId b_id) const = 0;

 protected:
  bool may_yield() const noexcept { return may_yield_; }
  void set_yielded(bool has_yielded) noexcept { has_yielded_ = has_yielded; }

 private:
  bool may_yield_ = false;
  bool has_yielded_ = false;
};

/// Passes on the pairs that a search did not write before it gave up.
template <int D>
class LeftSink final : public FilterSink {
 public:
  LeftSink(const Yielding<D>& search, std::span<const Box<D>> boxes, PairSink& target)
      : FilterSink(target), search_(&search), boxes_(boxes) {}

  std::unique_ptr<FilterSink> onto(PairSink& target) const override {
    return std::make_unique<LeftSink>(*search_, boxes_, target);
  }

 private:
  void consume(std::span<const Pair> pairs) override {
    for (const Pair pair : pairs) {
      const Box<D>& first = boxes_[index(pair.first)];
      const Box<D>& second = boxes_[index(pair.second)];
      if (search_->is_left(first, pair.first, second, pair.second)) target().add(pair.first, pair.second);
    }
  }

  const Yielding<D>* search_;
  std::span<const Box<D>> boxes_;
};

}  // namespace broadside::core
