// Calls of the program that must be refused.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "process.hpp"

namespace broadside::cli {

/// Arguments, and parts of what must be said of them: the thing, the value found, what is
/// expected.
struct Refusal {
  std::vector<std::string> arguments;
  std::vector<std::string> message;
};

/// Expects each call to end with status 2, its message and no output.
inline void expect_refused(const std::vector<Refusal>& refusals) {
  for (const Refusal& refusal : refusals) {
    const Ended ended = run(refusal.arguments);
    EXPECT_EQ(ended.status, 2) << ended.errors;
    EXPECT_THAT(ended.output, testing::IsEmpty());
    for (const std::string& part : refusal.message) EXPECT_THAT(ended.errors, testing::HasSubstr(part));
  }
}

/// Likewise, with `verb` before each call's arguments.
inline void expect_refused(const std::string& verb, std::vector<Refusal> refusals) {
  for (Refusal& refusal : refusals) refusal.arguments.insert(refusal.arguments.begin(), verb);
  expect_refused(refusals);
}

}  // namespace broadside::cli
