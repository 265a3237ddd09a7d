// FilterSink: a sink that passes pairs on to another one, changed or left out.
#pragma once

#include <memory>

#include "broadside/pair.hpp"

namespace broadside::core {

/// consume() must depend on the pairs alone and change only the target, so that several
/// threads can filter at the same time, each with a filter of its own onto a target of its own.
class FilterSink : public PairSink {
 public:
  PairSink& target() const noexcept { return *target_; }
  FilterSink* as_filter() noexcept final { return this; }

  /// The same filter onto another target, which must outlive it.
  virtual std::unique_ptr<FilterSink> onto(PairSink& target) const = 0;

 protected:
  explicit FilterSink(PairSink& target) : target_(&target) {}

 private:
  PairSink* target_;
};

}  // namespace broadside::core
