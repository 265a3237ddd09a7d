// Receives pairs from a library's callback.
#pragma once

#include <exception>

#include "broadside/pair.hpp"

namespace broadside::lab::peers {

/// Writes pairs to a sink from within a library's callback. Stores an exception of the sink until the library
/// has returned: an exception must not unwind through C code or an unfinished traversal.
class CallbackSink {
 public:
  explicit CallbackSink(PairSink& pairs) : pairs_(pairs) {}

  /// Writes the pair, unless the sink threw earlier; returns whether it was written.
  bool add(BoxId a, BoxId b) noexcept {
    if (thrown_) return false;
    try {
      pairs_.add(a, b);
    } catch (...) {
      thrown_ = std::current_exception();
    }
    return !thrown_;
  }

  /// Rethrows the sink's exception, if there was one.
  void finish() const {
    if (thrown_) std::rethrow_exception(thrown_);
  }

 private:
  PairSink& pairs_;
  std::exception_ptr thrown_;
};

}  // namespace broadside::lab::peers
