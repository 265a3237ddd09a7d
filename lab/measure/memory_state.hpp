// Memory and caches in the same state before each sample, whatever ran before.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace broadside::lab {

/// Has the process keep memory that is freed, from now on. A later allocation then costs no page faults,
/// whichever algorithm took that memory first; otherwise the first to need memory pays for all that follow.
/// Where the C library is not glibc it does nothing.
void keep_freed_memory();

/// The processor's caches.
class CacheState {
 public:
  CacheState();

  /// Empties the first two levels, as the rest of an engine's frame does, and reads `input`, which an engine
  /// has just written.
  void settle(std::span<const std::byte> input);

 private:
  std::vector<std::uint64_t> memory_;  // more than the second level holds
};

}  // namespace broadside::lab
