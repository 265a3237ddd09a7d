// Replaces the global operator new and delete by versions that can count. The array and nothrow forms call
// the ones replaced here, as the C++ standard requires. The build sets BROADSIDE_COUNTS_ALLOCATIONS: 0 if
// malloc cannot tell a block's size, or if a sanitizer has its own operator new.
#include "lab/measure/memory.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <new>

#if BROADSIDE_COUNTS_ALLOCATIONS || defined(__GLIBC__)
#include <malloc.h>
#endif

#include "lab/platform/machine.hpp"

namespace broadside::lab {
namespace {

// Relaxed throughout: a meter is read in the thread that waited for all others.
std::atomic<bool> counting = false;
std::atomic<std::int64_t> held = 0;
std::atomic<std::int64_t> max_held = 0;

#if BROADSIDE_COUNTS_ALLOCATIONS
void count_taken(void* block) noexcept {
  if (!counting.load(std::memory_order_relaxed)) return;
  const auto size = static_cast<std::int64_t>(malloc_usable_size(block));
  const std::int64_t now = held.fetch_add(size, std::memory_order_relaxed) + size;
  std::int64_t max_so_far = max_held.load(std::memory_order_relaxed);
  while (now > max_so_far && !max_held.compare_exchange_weak(max_so_far, now, std::memory_order_relaxed)) {
  }
}

void count_given_back(void* block) noexcept {
  if (!counting.load(std::memory_order_relaxed) || block == nullptr) return;
  held.fetch_sub(static_cast<std::int64_t>(malloc_usable_size(block)), std::memory_order_relaxed);
}

/// Memory from `allocate`, which returns null on failure: the new-handler loop that operator new must have.
template <typename Allocate>
void* take(const Allocate& allocate) {
  while (true) {
    if (void* const block = allocate()) {
      count_taken(block);
      return block;
    }
    const std::new_handler handler = std::get_new_handler();
    if (handler == nullptr) throw std::bad_alloc();
    handler();
  }
}
#endif

}  // namespace

AllocationMeter::AllocationMeter() noexcept {
  held = 0;
  max_held = 0;
  counting = true;
}

AllocationMeter::~AllocationMeter() { counting = false; }

std::optional<Allocation> AllocationMeter::read() const noexcept {
#if BROADSIDE_COUNTS_ALLOCATIONS
  return Allocation{held, max_held};
#else
  return std::nullopt;
#endif
}

void keep_freed_memory() {
#ifdef __GLIBC__
  // Never returns memory at the heap's end to the system, and takes large blocks from the heap as well, where
  // they are reused.
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  mallopt(M_MMAP_MAX, 0);
#endif
}

CacheState::CacheState(bool is_cold) : is_cold_(is_cold) {
  std::size_t bytes = std::size_t{4} << 20;
  if (is_cold) {
    bytes = std::size_t{64} << 20;  // if the system does not say how large its caches are
    for (const platform::Cache& cache : platform::caches())
      bytes = std::max<std::size_t>(bytes, 2 * cache.bytes);
  }
  memory_.assign(bytes / sizeof(std::uint64_t), 1);
}

void CacheState::settle(std::span<const std::byte> input) {
  constexpr std::size_t line = 64;
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < memory_.size(); i += line / sizeof(std::uint64_t)) sum += ++memory_[i];
  for (std::size_t i = 0; !is_cold_ && i < input.size(); i += line)
    sum += std::to_integer<std::uint64_t>(input[i]);
  // Stored, so that the compiler cannot remove the reads.
  memory_[1] = sum;
}

}  // namespace broadside::lab

// Weak, so that a program may define its own operators, as the tests of memory do.
#if BROADSIDE_COUNTS_ALLOCATIONS
[[gnu::weak]] void* operator new(std::size_t size) {
  return broadside::lab::take([size] { return std::malloc(std::max<std::size_t>(size, 1)); });
}

[[gnu::weak]] void* operator new(std::size_t size, std::align_val_t alignment) {
  const auto align = static_cast<std::size_t>(alignment);
  // aligned_alloc requires a multiple of the alignment.
  const std::size_t whole = std::max((size + align - 1) / align * align, align);
  return broadside::lab::take([=] { return std::aligned_alloc(align, whole); });
}

[[gnu::weak]] void operator delete(void* block) noexcept {
  broadside::lab::count_given_back(block);
  std::free(block);
}

[[gnu::weak]] void operator delete(void* block, std::size_t) noexcept { operator delete(block); }
[[gnu::weak]] void operator delete(void* block, std::align_val_t) noexcept { operator delete(block); }
[[gnu::weak]] void operator delete(void* block, std::size_t, std::align_val_t) noexcept {
  operator delete(block);
}
#endif
