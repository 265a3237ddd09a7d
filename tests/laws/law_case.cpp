// The catalogue's algorithms as law cases.
#include "law_case.hpp"

#include <ostream>

#include "lab/catalogue.hpp"

namespace broadside::laws {

const std::vector<LawCase>& law_cases() {
  static const lab::Catalogue catalogue;
  static const std::vector<LawCase> cases = [] {
    std::vector<LawCase> all;
    for (const Algorithm& algorithm : catalogue.algorithms()) {
      for (const int dimension : {2, 3}) {
        if (algorithm.has_dimension(dimension)) all.push_back({&algorithm, dimension});
      }
    }
    return all;
  }();
  return cases;
}

std::vector<LawCase> law_cases_in(int dimension) {
  std::vector<LawCase> cases = law_cases();
  std::erase_if(cases, [dimension](const LawCase& other) { return other.dimension != dimension; });
  return cases;
}

std::string name(const LawCase& law_case) {
  return law_case.algorithm->name + "_" + std::to_string(law_case.dimension) + "d";
}

void PrintTo(const LawCase& law_case, std::ostream* out) { *out << name(law_case); }

}  // namespace broadside::laws
