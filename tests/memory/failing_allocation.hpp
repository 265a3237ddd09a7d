// Allocations that fail on demand: a test program that links this file has its own operator new and delete.
#pragma once

#include <cstdint>

namespace broadside::laws {

/// Which allocations fail.
enum class FailureKind {
  once,          ///< the one with the given number
  from_then_on,  ///< that one and all later ones
};

/// Lets allocations of all threads throw std::bad_alloc while it exists. Only one may exist at a time.
///
///   const FailingAllocation failing(3, FailureKind::once);
///   tracker.update(frame, begun, ended);  // its fourth allocation throws
class FailingAllocation {
 public:
  /// Allocations are counted from here on, the first one as 0.
  FailingAllocation(std::uint64_t number, FailureKind kind) noexcept;
  ~FailingAllocation();
  FailingAllocation(const FailingAllocation&) = delete;
  FailingAllocation& operator=(const FailingAllocation&) = delete;

  /// How many allocations have failed. 0: the run made fewer allocations than that, and none failed.
  static std::uint64_t failures() noexcept;
};

/// How many times the program has asked for memory, whether it got it or not.
std::uint64_t allocation_count() noexcept;

/// How many blocks of memory the program holds. A difference between two moments with nothing in between that
/// should stay is a leak.
std::int64_t blocks_held() noexcept;

}  // namespace broadside::laws
