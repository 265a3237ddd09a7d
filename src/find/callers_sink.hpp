// CallersSink: a sink that is called in the floating-point environment of its owner, not in the library's.
#pragma once

#include <memory>
#include <utility>

#include "broadside/pair.hpp"

#include "core/float_environment.hpp"

namespace broadside::find {

/// Stands between a search and its caller's sink, which no filter may look through.
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

/// Delivers the pairs of search(sink) to the caller's sink, in the caller's environment, and flushes it. What
/// a failed search has left there is forgotten. Returns what the search returns.
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
