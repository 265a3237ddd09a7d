// What is tried with too little memory.
#include "memory_case.hpp"

#include <algorithm>
#include <ostream>

#include "broadside/error.hpp"
#include "broadside/tracker.hpp"

namespace broadside::laws {
namespace {

bool is_accepted(const MemoryCase& memory_case, const Spec& spec) {
  try {
    if (memory_case.dimension == 2)
      Tracker<2>(*memory_case.algorithm, spec);
    else
      Tracker<3>(*memory_case.algorithm, spec);
    return true;
  } catch (const InvalidSpec&) {
    return false;
  }
}

}  // namespace

std::vector<MemoryCase> memory_cases() {
  std::vector<MemoryCase> cases;
  for (const Algorithm& algorithm : algorithms()) {
    for (const int dimension : {2, 3}) {
      if (!algorithm.has_dimension(dimension)) continue;
      for (const bool is_double : {false, true}) cases.push_back({&algorithm, dimension, is_double});
    }
  }
  return cases;
}

std::vector<MemoryCase> threaded_memory_cases() {
  std::vector<MemoryCase> cases = memory_cases();
  std::erase_if(cases,
                [](const MemoryCase& other) { return other.is_double || !has_threads(*other.algorithm); });
  return cases;
}

std::string name(const MemoryCase& memory_case) {
  return memory_case.algorithm->name + "_" + std::to_string(memory_case.dimension) + "d" +
         (memory_case.is_double ? "_double" : "");
}

void PrintTo(const MemoryCase& memory_case, std::ostream* out) { *out << name(memory_case); }

std::vector<Spec> specs_of(const MemoryCase& memory_case) {
  const Algorithm& algorithm = *memory_case.algorithm;
  std::vector<Spec> specs = {{algorithm.name, {}}};
  for (const Tunable& tunable : algorithm.tunables) {
    std::vector<std::string> values = tunable.choices;
    // Leaves of a few boxes are many, and cells of one box wide as well.
    if (tunable.name == "capacity") values = {"3"};
    for (const std::string& value : values) {
      Spec spec{algorithm.name, {{tunable.name, value}}};
      if (is_accepted(memory_case, spec)) specs.push_back(std::move(spec));
    }
  }
  return specs;
}

std::vector<Spec> threaded_specs_of(const MemoryCase& memory_case) {
  std::vector<Spec> specs = specs_of(memory_case);
  const auto is_other = [](const Spec& spec) {
    return std::ranges::none_of(spec.values, [](const auto& value) { return value.second == "rebuild"; });
  };
  specs.erase(std::remove_if(specs.begin() + 1, specs.end(), is_other), specs.end());
  return specs;
}

}  // namespace broadside::laws
