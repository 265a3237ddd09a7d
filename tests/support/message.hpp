// The text of an exception, for tests of what users get to read.
#pragma once

#include <string>

#include <gtest/gtest.h>

namespace broadside {

/// The text of the `Error` that `action` throws; a failure and no text if it throws none.
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
