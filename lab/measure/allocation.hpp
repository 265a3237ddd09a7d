// The memory that code takes, by counted allocation: the lab replaces the global operator new and delete.
#pragma once

#include <cstdint>
#include <optional>

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

}  // namespace broadside::lab
