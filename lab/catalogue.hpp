// The lab's list of algorithms: the library's, the peers', and whatever a user adds.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "broadside/algorithm.hpp"

namespace broadside::lab {

/// An algorithm and the spec it was asked for under.
struct Contender {
  const Algorithm* algorithm;
  Spec spec;
};

/// A list of algorithms that can be searched by name, spec and group. Not to be changed while contenders
/// point into it.
class Catalogue {
 public:
  /// The library's algorithms and the peers that were built in.
  Catalogue();

  /// Adds a user's algorithm. Throws InvalidSpec if its name is taken or is no name.
  void add(Algorithm algorithm);

  std::span<const Algorithm> algorithms() const noexcept { return algorithms_; }

  /// The contenders that a list such as "grid:cell=2,paper" names: names, specs, or the groups own, paper,
  /// peers, all; each spec once, in the list's order. Throws InvalidSpec naming what there is.
  std::vector<Contender> select(std::string_view list) const;

 private:
  std::vector<Algorithm> algorithms_;
};

}  // namespace broadside::lab
