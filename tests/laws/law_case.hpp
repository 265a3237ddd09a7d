// Parameters of the equivalence tests: one algorithm in one dimension, for each algorithm in the catalogue.
#pragma once

#include <cstddef>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"

namespace broadside::laws {

/// Whether the tests run under a sanitizer, with reduced sizes.
inline constexpr bool sanitized = BROADSIDE_SANITIZED != 0;

/// `size`, or a small part of it under a sanitizer. `cost` is the exponent of the test's time: 1 for n, 2 for
/// n squared.
constexpr std::size_t reduced(std::size_t size, int cost = 2) {
  return sanitized ? size / (cost == 1 ? 10 : 4) : size;
}

template <int D, typename Real = float>
using Boxes = std::vector<Box<D, Real>>;

template <int D>
using DoubleBoxes = Boxes<D, double>;

/// One algorithm in one dimension.
struct LawCase {
  const Algorithm* algorithm;
  int dimension;
};

/// Each of these algorithms, in every dimension that it supports.
std::vector<LawCase> cases_of(std::span<const Algorithm> algorithms);

/// The library's algorithms that can use several threads.
std::vector<LawCase> threaded_cases();

/// Every algorithm of the catalogue, in every dimension that it supports. On a chosen instruction set only
/// the library's algorithms, because no others use the kernels.
const std::vector<LawCase>& law_cases();

/// The law cases that the predicate `takes` accepts.
template <typename Takes>
std::vector<LawCase> law_cases_if(Takes takes) {
  std::vector<LawCase> cases = law_cases();
  std::erase_if(cases, [&](const LawCase& other) { return !takes(other); });
  return cases;
}

inline bool is_own(const LawCase& law_case) { return law_case.algorithm->kind == AlgorithmKind::own; }
inline bool is_peer(const LawCase& law_case) { return law_case.algorithm->kind == AlgorithmKind::peer; }

/// The law cases of algorithms written for our interface, without the peers, which share its checks.
inline std::vector<LawCase> law_cases_without_peers() {
  return law_cases_if([](const LawCase& law_case) { return !is_peer(law_case); });
}

/// Such as "grid_2d".
std::string name(const LawCase& law_case);
void PrintTo(const LawCase& law_case, std::ostream* out);

/// Whether the tests run on a chosen instruction set instead of the best one: BROADSIDE_INSTRUCTION_SET names
/// it.
bool is_instruction_set_chosen();

/// Base class of all equivalence tests.
class Law : public testing::TestWithParam<LawCase> {
 protected:
  const Algorithm& algorithm() const { return *GetParam().algorithm; }

  /// The algorithm's spec with default values.
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

/// Test names for INSTANTIATE_TEST_SUITE_P.
inline std::string case_name(const testing::TestParamInfo<LawCase>& info) { return name(info.param); }

}  // namespace broadside::laws
