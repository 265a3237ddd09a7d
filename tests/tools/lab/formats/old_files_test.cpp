// Traces that earlier versions wrote.
#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "lab/formats/format.hpp"
#include "lab/verify/verify.hpp"

namespace broadside::lab {
namespace {

template <int D, typename Real>
History<D, Real> old_trace(const std::string& name) {
  BoxFile file = open_file(std::string(BROADSIDE_SOURCE_DIR) + "/tests/fixtures/" + name);
  return read_all(*std::get<std::unique_ptr<FrameReader<D, Real>>>(file.frames));
}

TEST(OldTrace, InFloatIsRead) {
  const History<2> history = old_trace<2, float>("trace_2d.btrace");
  EXPECT_EQ(history.steps.size(), 3U);
  EXPECT_EQ(history.steps.back().changed.size(), 8U);
  EXPECT_EQ((reference_pairs<2, float>(history.boxes).size()), 79U);
}

TEST(OldTrace, InDoubleIsRead) {
  const History<3, double> history = old_trace<3, double>("trace_double_3d.btrace");
  EXPECT_EQ(history.steps.size(), 2U);
  EXPECT_EQ((reference_pairs<3, double>(history.boxes).size()), 55U);
}

}  // namespace
}  // namespace broadside::lab
