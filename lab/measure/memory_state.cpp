// Memory and caches in the same state before each sample, whatever ran before.
#include "lab/measure/memory_state.hpp"

#include <limits>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace broadside::lab {

void keep_freed_memory() {
#ifdef __GLIBC__
  // Nothing goes back to the system at the heap's end, and large blocks come from the heap as well, where
  // they are used again.
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  mallopt(M_MMAP_MAX, 0);
#endif
}

CacheState::CacheState() : memory_((std::size_t{4} << 20) / sizeof(std::uint64_t), 1) {}

void CacheState::settle(std::span<const std::byte> input) {
  constexpr std::size_t line = 64;
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < memory_.size(); i += line / sizeof(std::uint64_t)) sum += ++memory_[i];
  for (std::size_t i = 0; i < input.size(); i += line) sum += std::to_integer<std::uint64_t>(input[i]);
  // Kept, so that no compiler leaves the reading out.
  memory_[1] = sum;
}

}  // namespace broadside::lab
