// is_wasteful() where the answer is beyond doubt.
#include "algorithms/sweep_bounds.hpp"

#include <gtest/gtest.h>

#include "tests/support/model.hpp"

namespace broadside::algorithm {
namespace {

/// `count` boxes `extent` long on the swept axis, one in each unit of it, and `apart` from each other on the
/// next one.
template <int D>
kernels::Run<D> run_of(kernels::RunBuffer<D>& buffer, std::size_t count, float extent, float apart) {
  buffer.clear();
  buffer.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    Box<D> box{};
    box.min[0] = static_cast<float>(i);
    box.max[0] = box.min[0] + extent;
    box.min[1] = box.max[1] = apart * static_cast<float>(i);
    buffer.append(box, BoxId(i));
  }
  return buffer.view(nullptr);
}

TEST(Waste, IsTestsBeyondTheLimitThatFindNothing) {
  in_each_dimension([]<int D>() {
    kernels::RunBuffer<D> buffer;
    constexpr std::size_t count = 2000;
    constexpr std::uint64_t limit = 100 * count;
    EXPECT_TRUE(is_wasteful(run_of<D>(buffer, count, 1000, 1), limit));
    EXPECT_FALSE(is_wasteful(run_of<D>(buffer, count, 1000, 0), limit)) << "each test finds a pair";
    EXPECT_FALSE(is_wasteful(run_of<D>(buffer, count, 50, 1), limit)) << "fewer tests";
    EXPECT_FALSE(is_wasteful(run_of<D>(buffer, 100, 1000, 1), limit)) << "few boxes";
  });
}

}  // namespace
}  // namespace broadside::algorithm
