// The global operator new and delete, replaced by ones that count and can fail. All forms are replaced,
// because a sanitizer's own do not end in the plain ones, and would not know the memory that those took by
// malloc.
#include "failing_allocation.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <new>

namespace broadside::laws {
namespace {

constexpr std::uint64_t never = std::numeric_limits<std::uint64_t>::max();

std::atomic<std::uint64_t> allocations = 0;
std::atomic<std::int64_t> block_count = 0;
std::atomic<std::uint64_t> first_failing = never;  // by the count of all allocations
std::atomic<std::uint64_t> last_failing = 0;
std::atomic<std::uint64_t> failed = 0;

/// Counts an allocation; whether it must fail.
bool must_fail() noexcept {
  const std::uint64_t number = allocations.fetch_add(1);
  if (number < first_failing.load() || number > last_failing.load()) return false;
  failed.fetch_add(1);
  return true;
}

/// Null where there is no memory.
void* take(std::size_t size, std::size_t alignment) noexcept {
  if (must_fail()) return nullptr;
  // aligned_alloc wants a multiple of the alignment.
  void* const block =
      alignment <= alignof(std::max_align_t)
          ? std::malloc(std::max<std::size_t>(size, 1))
          : std::aligned_alloc(alignment,
                               std::max((size + alignment - 1) / alignment, std::size_t{1}) * alignment);
  if (block != nullptr) block_count.fetch_add(1);
  return block;
}

void* take_or_throw(std::size_t size, std::size_t alignment) {
  void* const block = take(size, alignment);
  if (block == nullptr) throw std::bad_alloc();
  return block;
}

void give_back(void* block) noexcept {
  if (block == nullptr) return;
  block_count.fetch_sub(1);
  std::free(block);
}

}  // namespace

FailingAllocation::FailingAllocation(std::uint64_t number, FailureKind kind) noexcept {
  failed = 0;
  const std::uint64_t first = allocations.load() + number;
  last_failing = kind == FailureKind::once ? first : never;
  first_failing = first;
}

FailingAllocation::~FailingAllocation() {
  first_failing = never;
  last_failing = 0;
}

std::uint64_t FailingAllocation::failures() noexcept { return failed; }

std::uint64_t allocation_count() noexcept { return allocations; }

std::int64_t blocks_held() noexcept { return block_count; }

}  // namespace broadside::laws

using broadside::laws::give_back;
using broadside::laws::take;
using broadside::laws::take_or_throw;

void* operator new(std::size_t size) { return take_or_throw(size, 1); }
void* operator new[](std::size_t size) { return take_or_throw(size, 1); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return take_or_throw(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return take_or_throw(size, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return take(size, 1); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return take(size, 1); }
void* operator new(std::size_t size, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return take(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return take(size, static_cast<std::size_t>(alignment));
}

void operator delete(void* block) noexcept { give_back(block); }
void operator delete[](void* block) noexcept { give_back(block); }
void operator delete(void* block, std::size_t) noexcept { give_back(block); }
void operator delete[](void* block, std::size_t) noexcept { give_back(block); }
void operator delete(void* block, std::align_val_t) noexcept { give_back(block); }
void operator delete[](void* block, std::align_val_t) noexcept { give_back(block); }
void operator delete(void* block, std::size_t, std::align_val_t) noexcept { give_back(block); }
void operator delete[](void* block, std::size_t, std::align_val_t) noexcept { give_back(block); }
void operator delete(void* block, const std::nothrow_t&) noexcept { give_back(block); }
void operator delete[](void* block, const std::nothrow_t&) noexcept { give_back(block); }
void operator delete(void* block, std::align_val_t, const std::nothrow_t&) noexcept { give_back(block); }
void operator delete[](void* block, std::align_val_t, const std::nothrow_t&) noexcept { give_back(block); }
