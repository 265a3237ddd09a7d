// Memory while something is measured: counted allocations, freed memory kept, caches in the same state.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace broadside::lab {

/// Memory taken through operator new while a block ran.
struct Allocation {
  std::int64_t kept;  ///< bytes taken and not given back; negative if older memory was given back
  std::int64_t peak;  ///< the most that was held at one moment above the level at the start
};

/// Counts what all threads allocate while it exists. Only one may exist at a time. While none does, an
/// allocation costs what it always did.
class AllocationMeter {
 public:
  AllocationMeter() noexcept;
  ~AllocationMeter();
  AllocationMeter(const AllocationMeter&) = delete;
  AllocationMeter& operator=(const AllocationMeter&) = delete;

  /// What was counted so far. Empty in builds that do not count: a sanitizer has its own operator new.
  std::optional<Allocation> read() const noexcept;
};

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
