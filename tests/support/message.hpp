// The text of an exception, for tests of error messages.
#pragma once

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace broadside {

/// The text of the `Error` that `action` throws; if it throws none, a test failure and an empty text.
template <typename Error, typename Action>
std::string message_of(Action action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return "";
}

/// Matches a message that names each of these: the thing, the value found, what was expected.
template <typename... Parts>
auto names(const Parts&... parts) {
  return testing::AllOf(testing::HasSubstr(parts)...);
}

}  // namespace broadside
