// The lab's list of algorithms: the library's, the paper's, the literature's, the peers' and the user's.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "broadside/algorithm.hpp"

namespace broadside::lab {

/// An algorithm and the spec that selected it.
struct Entry {
  const Algorithm* algorithm;
  Spec spec;
};

/// The number of threads that the entry searches with: the value in its spec, by default 1. `threads=0`
/// selects all of the machine's.
std::size_t threads_of(const Entry& entry);

/// Each entry with each number of threads in its spec. An entry that cannot use several threads, or whose
/// spec already sets the number, stays as it is, once.
std::vector<Entry> with_threads(const std::vector<Entry>& entries, std::span<const std::size_t> threads);

/// A list of algorithms, searched by name, spec and group. Must not change while entries point into it.
class Catalogue {
 public:
  /// Registers the paper's listings. Takes all algorithms registered by then, those from the literature, and
  /// the peers that were built in. Throws InvalidSpec if the name of a group, a listing or a peer is already
  /// registered.
  Catalogue();

  /// Adds an algorithm to this list only. Throws InvalidSpec if its name is taken.
  void add(Algorithm algorithm);

  /// Likewise, but in no group: only its name finds it.
  void add_outside_groups(Algorithm algorithm);

  std::span<const Algorithm> algorithms() const noexcept { return algorithms_; }

  /// The entries that a list such as "grid:cell=2,paper" selects. Its items are names, specs, or the groups
  /// own, paper, literature, peers and all. Each spec occurs once, in the list's order. Throws InvalidSpec,
  /// which lists the valid names.
  std::vector<Entry> select(std::string_view list) const;

 private:
  std::vector<Algorithm> algorithms_;
  std::vector<std::string> outside_groups_;
};

}  // namespace broadside::lab
