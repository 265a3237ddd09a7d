// The text of an exception, for tests of error messages.
#pragma once

#include <string>

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

}  // namespace broadside
