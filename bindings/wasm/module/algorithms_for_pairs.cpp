// The algorithms of the smaller module, instead of those that CMake lists: one for few boxes, one for many.
#include "algorithms/registry.hpp"

std::vector<broadside::Algorithm> broadside::algorithm::linked_algorithms() {
  return {brute_force(), grid()};
}

bool broadside::algorithm::is_linked(std::string_view name) noexcept {
  return name == "brute_force" || name == "grid";
}
