// The catalogue's algorithms as law cases.
#include "lab/catalogue.hpp"
#include "law_case.hpp"

namespace broadside::laws {

const std::vector<LawCase>& law_cases() {
  static const lab::Catalogue catalogue;
  static const std::vector<LawCase> cases = [] {
    std::vector<LawCase> all = cases_of(catalogue.algorithms());
    if (is_instruction_set_chosen()) std::erase_if(all, [](const LawCase& other) { return !is_own(other); });
    return all;
  }();
  return cases;
}

}  // namespace broadside::laws
