// The typed options of the library's algorithms as specs.
#include <string>
#include <utility>

#include "broadside/spec.hpp"

namespace broadside {
namespace {

/// The spec of an algorithm with the values that all have; default values are not listed.
Spec spec_of(const char* algorithm, std::size_t threads, Update update) {
  Spec spec{algorithm, {}};
  if (threads != 1) spec.values.emplace_back("threads", static_cast<double>(threads));
  if (update != Update::automatic)
    spec.values.emplace_back("update", update == Update::follow ? "follow" : "rebuild");
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
  if (axis) spec.values.emplace_back("axis", std::string(1, "xyz"[static_cast<std::size_t>(*axis) % 3]));
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
