// The lab's list of algorithms: the library's, the paper's, the literature's, the peers' and the user's.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "broadside/algorithm.hpp"

namespace broadside::lab {

/// An algorithm and the spec it was asked for under.
struct Entry {
  const Algorithm* algorithm;
  Spec spec;
};

/// The number of threads that the entry searches with: its spec's, by default 1; with `threads=0` as many as
/// the machine has.
std::size_t threads_of(const Entry& entry);

/// Each entry with each number of threads in its spec. An entry that cannot use several, or whose spec gives
/// a number, stays as it is, once.
std::vector<Entry> with_threads(const std::vector<Entry>& entries, std::span<const std::size_t> threads);

/// A list of algorithms that can be searched by name, spec and group. Not to be changed while entries
/// point into it.
class Catalogue {
 public:
  /// Registers the paper's listings; takes all algorithms that then have a name, those from the
  /// literature, and the peers that were built in. Throws InvalidSpec if the name of a group, a listing or a
  /// peer is registered already.
  Catalogue();

  /// Adds an algorithm to this list alone. Throws InvalidSpec if its name is taken.
  void add(Algorithm algorithm);

  /// Likewise, but in no group: it is found by its name alone.
  void add_outside_groups(Algorithm algorithm);

  std::span<const Algorithm> algorithms() const noexcept { return algorithms_; }

  /// The entries that a list such as "grid:cell=2,paper" names: names, specs, or the groups own, paper,
  /// literature, peers, all; each spec once, in the list's order. Throws InvalidSpec naming what there is.
  std::vector<Entry> select(std::string_view list) const;

 private:
  std::vector<Algorithm> algorithms_;
  std::vector<std::string> outside_groups_;
};

}  // namespace broadside::lab
