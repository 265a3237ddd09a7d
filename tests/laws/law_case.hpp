// What a law is tested on: one algorithm in one dimension, for each that the catalogue holds.
#pragma once

#include <cstddef>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"

namespace broadside::laws {

/// Whether the tests run under a sanitizer, where sizes are reduced.
inline constexpr bool sanitized = BROADSIDE_SANITIZED != 0;

/// `size`, or a small part of it under a sanitizer. `cost` is what the test's time grows with: 1 for n, 2 for
/// n squared.
constexpr std::size_t reduced(std::size_t size, int cost = 2) {
  return sanitized ? size / (cost == 1 ? 10 : 4) : size;
}

/// One algorithm in one dimension.
struct LawCase {
  const Algorithm* algorithm;
  int dimension;
};

/// Each of these algorithms, in every dimension that it does.
std::vector<LawCase> cases_of(std::span<const Algorithm> algorithms);

/// Every algorithm of the catalogue, in every dimension that it does.
const std::vector<LawCase>& law_cases();

/// Those of them in one dimension.
std::vector<LawCase> law_cases_in(int dimension);

/// Such as "grid_2d".
std::string name(const LawCase& law_case);
void PrintTo(const LawCase& law_case, std::ostream* out);

/// Whether the tests run on one instruction set instead of the best one: BROADSIDE_INSTRUCTION_SET names it.
bool is_instruction_set_chosen();

/// The base of the tests of every law.
class Law : public testing::TestWithParam<LawCase> {
 protected:
  void SetUp() override {
    if (is_instruction_set_chosen() && algorithm().kind != AlgorithmKind::own)
      GTEST_SKIP() << algorithm().name << " does not use the kernels";
  }

  const Algorithm& algorithm() const { return *GetParam().algorithm; }

  /// The algorithm's spec with no value given.
  Spec spec() const { return {algorithm().name, {}}; }

  /// Calls `body.operator()<D>()` with the case's dimension.
  template <typename Body>
  static void in_dimension(Body body) {
    if (GetParam().dimension == 2)
      body.template operator()<2>();
    else
      body.template operator()<3>();
  }
};

/// The names of INSTANTIATE_TEST_SUITE_P.
inline std::string case_name(const testing::TestParamInfo<LawCase>& info) { return name(info.param); }

}  // namespace broadside::laws
