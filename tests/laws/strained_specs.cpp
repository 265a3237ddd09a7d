// Specs that give an algorithm's tunables the values that are hardest on it.
#include "strained_specs.hpp"

#include <cmath>
#include <limits>
#include <sstream>
#include <string>

#include "broadside/error.hpp"
#include "broadside/finder.hpp"

namespace broadside::laws {
namespace {

std::vector<std::string> straining_values(const Tunable& tunable) {
  if (tunable.type == Tunable::Type::choice) return tunable.choices;
  std::vector<std::string> values;
  for (const double value : {tunable.min, tunable.max, tunable.min + 1, 1e-30, 1e-3, 0.3, 1.0, 2.0, 3.0, 7.0,
                             64.0, 1e4, 1e9, 1e30}) {
    const bool whole = tunable.type != Tunable::Type::integer || value == std::floor(value);
    if (!whole || value < tunable.min || value > tunable.max) continue;
    std::ostringstream text;
    text.precision(std::numeric_limits<double>::max_digits10);
    text << value;
    values.push_back(text.str());
  }
  return values;
}

bool is_accepted(const LawCase& law_case, const Spec& spec) {
  try {
    if (law_case.dimension == 2)
      Finder<2>(*law_case.algorithm, spec);
    else
      Finder<3>(*law_case.algorithm, spec);
    return true;
  } catch (const InvalidSpec&) {
    return false;
  }
}

}  // namespace

std::vector<Spec> strained_specs(const LawCase& law_case) {
  std::vector<Spec> specs;
  for (const Tunable& tunable : law_case.algorithm->tunables) {
    if (tunable.name == "limit") continue;  // without it, the cells of a far world fit no memory
    for (const std::string& value : straining_values(tunable)) {
      Spec spec{law_case.algorithm->name, {{tunable.name, value}}};
      if (is_accepted(law_case, spec)) specs.push_back(std::move(spec));
    }
  }
  // Leaves of a few boxes are many: only then does a mover have far to go in a tree.
  for (const char* const update : {"siblings", "cousins"}) {
    const Spec spec{"paper_quadtree", {{"capacity", "3"}, {"update", update}}};
    if (law_case.algorithm->name == spec.name && is_accepted(law_case, spec)) specs.push_back(spec);
  }
  if (const Spec spec{"quadtree", {{"capacity", "3"}, {"update", "follow"}}};
      law_case.algorithm->name == spec.name && is_accepted(law_case, spec))
    specs.push_back(spec);
  return specs;
}

}  // namespace broadside::laws
