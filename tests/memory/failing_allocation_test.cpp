// Allocations that fail on demand.
#include "failing_allocation.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <new>
#include <thread>

#include <gtest/gtest.h>

namespace broadside::laws {
namespace {

/// One call of operator new, which a compiler may not leave out as it may a new-expression.
void allocate() { operator delete(operator new(8)); }

TEST(FailingAllocation, FailsOnce) {
  const FailingAllocation failing(1, FailureKind::once);
  allocate();
  EXPECT_EQ(FailingAllocation::failures(), 0u);
  EXPECT_THROW(allocate(), std::bad_alloc);
  EXPECT_EQ(FailingAllocation::failures(), 1u);
  allocate();
}

TEST(FailingAllocation, FailsFromThenOnInAllThreadsAndNoLongerAfterwards) {
  bool threw = false;
  {
    std::thread other;
    std::atomic<bool> go = false;
    other = std::thread([&] {
      while (!go) std::this_thread::yield();
      try {
        allocate();
      } catch (const std::bad_alloc&) {
        threw = true;
      }
    });
    const FailingAllocation failing(0, FailureKind::from_then_on);
    EXPECT_EQ(operator new(8, std::nothrow), nullptr);
    EXPECT_THROW(operator delete[](operator new[](8, std::align_val_t{64})), std::bad_alloc);
    go = true;
    other.join();
  }
  EXPECT_TRUE(threw);
  allocate();
}

TEST(FailingAllocation, CountsWhatIsHeld) {
  const std::int64_t before = blocks_held();
  const std::uint64_t count = allocation_count();
  void* const plain = operator new(8);
  void* const aligned = operator new (8, std::align_val_t{256});
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(aligned) % 256, 0u);
  EXPECT_EQ(blocks_held(), before + 2);
  operator delete(plain);
  operator delete (aligned, std::align_val_t{256});
  EXPECT_EQ(blocks_held(), before);
  EXPECT_EQ(allocation_count(), count + 2);
}

}  // namespace
}  // namespace broadside::laws
