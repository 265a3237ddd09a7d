// Algorithms as law cases.
#include "law_case.hpp"

#include <ostream>

namespace broadside::laws {

std::vector<LawCase> cases_of(std::span<const Algorithm> algorithms) {
  std::vector<LawCase> cases;
  for (const Algorithm& algorithm : algorithms) {
    for (const int dimension : {2, 3}) {
      if (algorithm.has_dimension(dimension)) cases.push_back({&algorithm, dimension});
    }
  }
  return cases;
}

std::vector<LawCase> threaded_cases() {
  std::vector<LawCase> cases = cases_of(algorithms());
  std::erase_if(cases, [](const LawCase& other) { return !has_threads(*other.algorithm); });
  return cases;
}

std::string name(const LawCase& law_case) {
  return law_case.algorithm->name + "_" + std::to_string(law_case.dimension) + "d";
}

void PrintTo(const LawCase& law_case, std::ostream* out) { *out << name(law_case); }

}  // namespace broadside::laws
