// Memory by counted allocation.
#include <cstddef>
#include <memory>
#include <new>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "lab/measure/memory.hpp"
#include "tests/support/use.hpp"

namespace broadside::lab {
namespace {

class AllocationMeterTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!AllocationMeter().read()) GTEST_SKIP() << "this build does not count allocations";
  }
};

TEST_F(AllocationMeterTest, CountsWhatIsKeptAndTheMostThatWasHeld) {
  const AllocationMeter meter;
  const std::vector<std::byte> kept(100'000);
  use(kept.data());
  {
    const std::vector<std::byte> dropped(1'000'000);
    use(dropped.data());
  }
  const Allocation allocation = *meter.read();
  EXPECT_GE(allocation.kept, 100'000);
  EXPECT_LE(allocation.kept, 110'000);
  EXPECT_GE(allocation.peak, 1'100'000);
  EXPECT_LE(allocation.peak, 1'120'000);
}

TEST_F(AllocationMeterTest, CountsOlderMemoryThatIsGivenBackAsLess) {
  auto older = std::make_unique<std::vector<std::byte>>(100'000);
  use(older->data());
  const AllocationMeter meter;
  older.reset();
  EXPECT_LE(meter.read()->kept, -100'000);
  EXPECT_EQ(meter.read()->peak, 0);
}

TEST_F(AllocationMeterTest, CountsEveryFormOfNewAndAllThreads) {
  struct alignas(256) Wide {
    std::byte bytes[4096];
  };
  const AllocationMeter meter;
  const auto wide = std::make_unique<Wide>();
  const auto array = std::make_unique<Wide[]>(2);
  const std::unique_ptr<std::byte[]> no_throw(new (std::nothrow) std::byte[4096]);
  std::unique_ptr<Wide> of_thread;
  std::thread([&of_thread] { of_thread = std::make_unique<Wide>(); }).join();
  use(wide.get());
  use(array.get());
  use(no_throw.get());
  EXPECT_GE(meter.read()->kept, 5 * 4096);
  EXPECT_LE(meter.read()->kept, 7 * 4096);
}

TEST_F(AllocationMeterTest, StartsFromNothing) {
  const std::vector<std::byte> before(100'000);
  use(before.data());
  const AllocationMeter meter;
  EXPECT_EQ(meter.read()->kept, 0);
}

}  // namespace
}  // namespace broadside::lab
