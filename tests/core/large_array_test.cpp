// Arrays below and above the size from which they get large pages.
#include "core/large_array.hpp"

#include <cstdint>
#include <numeric>

#include <gtest/gtest.h>

namespace broadside::core {
namespace {

TEST(LargeArray, KeepsItsElementsWhereItGrowsIntoLargePages) {
  LargeArray<std::uint32_t> array;
  for (const std::size_t bytes :
       {min_large_bytes - 4, min_large_bytes, 9 * min_large_bytes, 10 * min_large_bytes + 4}) {
    const std::size_t before = array.size();
    array.resize(bytes / 4);
    for (std::size_t i = 0; i < before; ++i) ASSERT_EQ(array[i], i);
    std::iota(array.begin(), array.end(), 0U);
  }
}

#if defined(__linux__)
TEST(LargeArray, BeginsWithALargePage) {
  const LargeArray<char> array(min_large_bytes);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(array.data()) % (std::size_t{2} << 20), 0);
}
#endif

}  // namespace
}  // namespace broadside::core
