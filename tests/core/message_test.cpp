#include "core/message.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace broadside::core {
namespace {

TEST(Message, HasTextsAndWholeNumbersInOrder) {
  const std::string text = "boxes";
  EXPECT_EQ(message({std::uint32_t{3}, " of ", std::size_t{1'000'000}, " ", text}), "3 of 1000000 boxes");
  EXPECT_EQ(message({std::numeric_limits<std::size_t>::max()}),
            std::to_string(std::numeric_limits<std::size_t>::max()));
}

TEST(Message, HasNothingOfAnEmptyText) {
  EXPECT_EQ(message({"a", std::string_view(), std::string(), "", "b"}), "ab");
  EXPECT_EQ(message({}), "");
}

TEST(Message, ListsNamesOrSaysThatThereAreNone) {
  EXPECT_EQ(listed({}), "none");
  const std::vector<std::string> names = {"cell", "update"};
  EXPECT_EQ(listed(names), "cell, update");
}

}  // namespace
}  // namespace broadside::core
