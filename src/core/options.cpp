// The typed options of the library's algorithms as specs.
#include <cstddef>
#include <initializer_list>

#include "broadside/spec.hpp"

namespace broadside {
namespace {

/// The name of an enumerator, or its number if it has none: Settings then refuses it.
SpecValue name_of(std::size_t value, std::initializer_list<const char*> names) {
  if (value < names.size()) return names.begin()[value];
  return static_cast<double>(value);
}

/// The spec of an algorithm with the values that all have; default values are not listed.
Spec spec_of(const char* algorithm, std::size_t threads, Update update) {
  Spec spec{algorithm, {}};
  if (threads != 1) spec.values.emplace_back("threads", static_cast<double>(threads));
  if (update != Update::automatic)
    spec.values.emplace_back("update", name_of(static_cast<std::size_t>(update), {"", "follow", "rebuild"}));
  return spec;
}

}  // namespace

AutoOptions::operator Spec() const { return spec_of("auto", threads, update); }

BruteForceOptions::operator Spec() const { return spec_of("brute_force", threads, update); }

GridOptions::operator Spec() const {
  Spec spec = spec_of("grid", threads, update);
  if (cell) spec.values.emplace_back("cell", *cell);
  return spec;
}

SweepAndPruneOptions::operator Spec() const {
  Spec spec = spec_of("sweep_and_prune", threads, update);
  if (axis) spec.values.emplace_back("axis", name_of(static_cast<std::size_t>(*axis), {"x", "y", "z"}));
  if (is_striped) spec.values.emplace_back("axes", *is_striped ? "2" : "1");
  return spec;
}

QuadtreeOptions::operator Spec() const {
  Spec spec = spec_of("quadtree", threads, update);
  if (capacity) spec.values.emplace_back("capacity", static_cast<double>(*capacity));
  return spec;
}

BvhOptions::operator Spec() const { return spec_of("bvh", threads, update); }

}  // namespace broadside
