// The catalogue's algorithms as law cases.
#include "lab/catalogue.hpp"
#include "law_case.hpp"

namespace broadside::laws {

const std::vector<LawCase>& law_cases() {
  static const lab::Catalogue catalogue;
  static const std::vector<LawCase> cases = cases_of(catalogue.algorithms());
  return cases;
}

std::vector<LawCase> law_cases_in(int dimension) {
  std::vector<LawCase> cases = law_cases();
  std::erase_if(cases, [dimension](const LawCase& other) { return other.dimension != dimension; });
  return cases;
}

}  // namespace broadside::laws
