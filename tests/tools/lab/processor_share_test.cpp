// Whether a run had a processor to itself.
#include <chrono>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lab/measure/steadiness.hpp"

namespace broadside::lab {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

TEST(ProcessorShare, IsSmallWhereTheProcessIsNotRunning) {
  const ProcessorShare share;
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_LT(share.value(), 0.5);
  EXPECT_GE(share.value(), 0);
}

TEST(BusyHint, NamesHowMuchOthersTook) {
  EXPECT_THAT(busy_hint(0.58), HasSubstr("for 42 % of the time"));
  EXPECT_THAT(busy_hint(0.9), IsEmpty());
  EXPECT_THAT(busy_hint(1.7), IsEmpty());
}

}  // namespace
}  // namespace broadside::lab
