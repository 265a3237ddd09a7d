// The listings' entries in the library's list of algorithms.
#include "paper/listings/registry.hpp"

namespace broadside::paper {

void register_listings() {
  static const bool once = [] {
    for (const auto listing : {brute_force, grid, sweep_and_prune, quadtree}) register_algorithm(listing());
    return true;
  }();
  static_cast<void>(once);
}

}  // namespace broadside::paper
