// Receives pairs from a library's callback.
#pragma once

#include <exception>
#include <span>

#include "broadside/pair.hpp"

namespace broadside::lab::peers {

/// Writes pairs to a sink from within a library's callback. Stores an exception of the sink until the library
/// has returned: an exception must not unwind through C code or an unfinished traversal.
class CallbackSink {
 public:
  explicit CallbackSink(PairSink& pairs) : pairs_(pairs) {}

  /// Writes the pair, unless the sink threw earlier; returns whether it was written.
  bool add(BoxId a, BoxId b) noexcept {
    return unless_thrown([&] { pairs_.add(a, b); });
  }

  /// Likewise for several pairs, each with first < second.
  bool put(std::span<const Pair> pairs) noexcept {
    return unless_thrown([&] { pairs_.put(pairs); });
  }

  /// Rethrows the sink's exception, if there was one.
  void finish() const {
    if (thrown_) std::rethrow_exception(thrown_);
  }

 private:
  template <typename Write>
  bool unless_thrown(const Write& write) noexcept {
    if (thrown_) return false;
    try {
      write();
    } catch (...) {
      thrown_ = std::current_exception();
    }
    return !thrown_;
  }

  PairSink& pairs_;
  std::exception_ptr thrown_;
};

}  // namespace broadside::lab::peers
