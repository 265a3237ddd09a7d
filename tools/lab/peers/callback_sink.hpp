// Takes pairs from a library's callback.
#pragma once

#include <exception>

#include "broadside/pair.hpp"

namespace broadside::lab::peers {

/// Writes pairs to a sink from within a library's callback. What the sink throws is kept until the library
/// has returned: an exception must not unwind C code or a traversal half done.
class CallbackSink {
 public:
  explicit CallbackSink(PairSink& pairs) : pairs_(pairs) {}

  /// Writes the pair unless the sink threw before; whether it could be written.
  bool add(BoxId a, BoxId b) noexcept {
    if (thrown_) return false;
    try {
      pairs_.add(a, b);
    } catch (...) {
      thrown_ = std::current_exception();
    }
    return !thrown_;
  }

  /// Throws what the sink threw, if it did.
  void finish() const {
    if (thrown_) std::rethrow_exception(thrown_);
  }

 private:
  PairSink& pairs_;
  std::exception_ptr thrown_;
};

}  // namespace broadside::lab::peers
