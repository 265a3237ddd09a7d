// Memory during measurements: counts allocations, keeps freed memory, and puts caches into the same state.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace broadside::lab {

/// Memory allocated through operator new during a block.
struct Allocation {
  std::int64_t kept;  ///< bytes allocated and not freed; negative if older memory was freed
  std::int64_t peak;  ///< maximum above the level at the start
};

/// Counts the allocations of all threads during its lifetime. Only one may exist at a time. Without one, an
/// allocation costs no more than usual.
class AllocationMeter {
 public:
  AllocationMeter() noexcept;
  ~AllocationMeter();
  AllocationMeter(const AllocationMeter&) = delete;
  AllocationMeter& operator=(const AllocationMeter&) = delete;

  /// The counts so far. Empty in builds that do not count, because a sanitizer has its own operator new.
  std::optional<Allocation> read() const noexcept;
};

/// Makes the process keep freed memory from now on. Later allocations then cause no page faults, whichever
/// algorithm used that memory first; otherwise the first algorithm would pay for all that follow. Does
/// nothing without glibc.
void keep_freed_memory();

/// The processor's caches.
class CacheState {
 public:
  explicit CacheState(bool is_cold);

  /// Evicts the first two cache levels, as the rest of an engine's frame does, and reads `input`, which an
  /// engine has just written. If cold, evicts all levels and reads nothing.
  void settle(std::span<const std::byte> input);

 private:
  bool is_cold_;
  std::vector<std::uint64_t> memory_;  // larger than the levels to evict
};

}  // namespace broadside::lab
