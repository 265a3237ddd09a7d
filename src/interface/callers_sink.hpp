// CallersSink: a sink that is called in the floating-point environment of its owner, not in the library's.
#pragma once

#include <memory>
#include <utility>

#include "broadside/pair.hpp"

#include "core/float_environment.hpp"

namespace broadside::core {

/// Stands between a search and its caller's sink, which no filter may look through.
class CallersSink final : public PairSink {
 public:
  explicit CallersSink(PairSink& target) : target_(&target) {}
  explicit CallersSink(std::unique_ptr<PairSink> owned) : target_(owned.get()), owned_(std::move(owned)) {}

  std::unique_ptr<PairSink> empty_clone() const override {
    const CallersEnvironment environment;
    std::unique_ptr<PairSink> clone = target_->empty_clone();
    return clone == nullptr ? nullptr : std::make_unique<CallersSink>(std::move(clone));
  }

  void merge(PairSink& clone) override {
    const CallersEnvironment environment;
    target_->merge(*static_cast<CallersSink&>(clone).target_);
  }

 private:
  void consume(std::span<const Pair> pairs) override {
    const CallersEnvironment environment;
    target_->put(pairs);
  }

  PairSink* target_;
  std::unique_ptr<PairSink> owned_;
};

/// Calls search(sink) with a sink that stands for `pairs`, and flushes `pairs`.
template <typename Search>
void search_for_caller(PairSink& pairs, const Search& search) {
  CallersSink sink(pairs);
  try {
    search(sink);
    const CallersEnvironment environment;
    pairs.flush();
  } catch (...) {
    pairs.discard();
    throw;
  }
}

}  // namespace broadside::core
