// main() of test programs in which the paper's listings have their names, as they do in the lab and the
// program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "paper/listings/registry.hpp"

int main(int count, char** values) {
  broadside::paper::register_listings();
  testing::InitGoogleMock(&count, values);
  return RUN_ALL_TESTS();
}
