// The laws on one instruction set instead of the best one: that which BROADSIDE_INSTRUCTION_SET names.
#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/executor.hpp"

#include "law_case.hpp"
#include "tests/support/instruction_sets.hpp"

namespace broadside::laws {
namespace {

std::string chosen_name() {
  const char* const value = std::getenv("BROADSIDE_INSTRUCTION_SET");
  return value == nullptr ? "" : value;
}

class ChosenInstructionSet final : public testing::Environment {
 public:
  void SetUp() override {
    if (!is_instruction_set_chosen()) return;
    const std::string name = chosen_name();
    const std::vector<std::string> all = instruction_sets();
    const std::string here = testing::PrintToString(all);
    ASSERT_TRUE(is_instruction_set(name))
        << "BROADSIDE_INSTRUCTION_SET is '" << name << "'; expected one of " << here;
    if (std::ranges::find(all, name) == all.end())
      GTEST_SKIP() << "this program or this processor does not have " << name << ", only " << here;
    chosen_ = std::make_unique<OnInstructionSet>(name);
  }

  void TearDown() override { chosen_.reset(); }

 private:
  std::unique_ptr<OnInstructionSet> chosen_;
};

[[maybe_unused]] const testing::Environment* const environment =
    testing::AddGlobalTestEnvironment(new ChosenInstructionSet);

}  // namespace

bool is_instruction_set_chosen() { return !chosen_name().empty(); }

}  // namespace broadside::laws
