// LastTest: a finder whose kernels test pairs of boxes of doubles where floats cannot tell.
#pragma once

#include "broadside/box.hpp"

namespace broadside::core {

/// A finder derives from this too where its kernels test in double the pairs of boxes that touch as floats.
/// That costs less than a test of all pairs behind the finder, since kernels still have the floats at hand.
template <int D>
class LastTest {
 public:
  LastTest() = default;
  LastTest(const LastTest&) = delete;
  LastTest& operator=(const LastTest&) = delete;
  virtual ~LastTest() = default;

  /// From now on the boxes of a search are floats of these, in the same order, and pairs are those that
  /// overlap in double. Null: floats decide. At most kernels::touching_bit boxes.
  void set_doubles(const Box<D, double>* boxes) noexcept { doubles_ = boxes; }

 protected:
  const Box<D, double>* doubles() const noexcept { return doubles_; }

 private:
  const Box<D, double>* doubles_ = nullptr;
};

}  // namespace broadside::core
