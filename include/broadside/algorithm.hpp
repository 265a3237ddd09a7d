// The description of an algorithm (its tunables, limits and costs, and how to make its searcher and its
// followers from a spec), and the list of all algorithms, to which users add their own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "broadside/export.hpp"
#include "broadside/follower.hpp"
#include "broadside/searcher.hpp"
#include "broadside/spec.hpp"

namespace broadside {

class Settings;
template <int D, typename Real>
struct Outline;

/// Makes the outline of a search with these settings. All boxes are present, and there is at least one. The
/// parts of the outline may be infinite.
template <int D>
using MakeOutline = std::function<Outline<D, float>(std::span<const Box<D>> boxes, const Workers& workers,
                                                    const Settings& settings)>;

/// A parameter that a user may set in a spec.
struct Tunable {
  enum class Type { number, integer, choice };

  std::string name;
  std::string summary;   ///< one line, with the unit
  std::string standard;  ///< the value when none is given; "auto" where the algorithm chooses by itself
  Type type = Type::number;
  double least = 0;  ///< for number and integer: the range of values allowed, both ends included
  double most = std::numeric_limits<double>::max();
  detail::Vector<std::string> choices{};  ///< for choice: the values allowed
};

/// A spec's values, checked against an algorithm's tunables; a tunable not given has its standard value.
class BROADSIDE_PUBLIC Settings {
 public:
  /// Throws InvalidSpec if `spec` names an unknown tunable or gives a value of the wrong type or out of
  /// range. "auto" is allowed if and only if it is the tunable's standard value.
  Settings(const Spec& spec, std::span<const Tunable> tunables);

  /// Whether the tunable is left for the algorithm to choose.
  [[nodiscard]] bool is_auto(std::string_view tunable) const { return text(tunable) == "auto"; }

  /// The value of a tunable, which must exist and not be "auto".
  [[nodiscard]] double number(std::string_view tunable) const;
  std::int64_t integer(std::string_view tunable) const;
  [[nodiscard]] const std::string& text(std::string_view tunable) const { return value(tunable).text(); }

 private:
  const SpecValue& value(std::string_view tunable) const;

  detail::Vector<std::pair<std::string, SpecValue>> values_;
};

/// Where an algorithm comes from.
enum class AlgorithmKind { own, paper, literature, peer };

/// "own", "paper", "literature" or "peer".
[[nodiscard]] BROADSIDE_PUBLIC std::string_view name(AlgorithmKind kind) noexcept;

/// The cost of finding all pairs anew, in nanoseconds of one machine: only ratios matter.
struct FindCosts {
  double box = 40;                ///< per box: with 64 tests and 4 references, without its pairs
  double further_test = 0.5;      ///< each further test of a box
  double further_reference = 30;  ///< each further reference to a box
  double pair = 7;
};

/// The cost of following boxes in a structure, in the same unit.
struct FollowCosts {
  double start = 100;        ///< per box, to build the structure
  double mover = 160;        ///< per mover, with its tests, before any was followed
  double mover_alone = 140;  ///< per mover, without its tests
  double test = 1;           ///< each of a mover's first 64 tests
  double further_test = 1;   ///< each further one
};

template <int D>
using MakeSearcher = std::function<std::unique_ptr<Searcher<D>>(const Settings&)>;

/// A follower that a Tracker may choose.
template <int D>
struct FollowerChoice {
  std::string name;  ///< as explanations name it
  std::function<std::unique_ptr<Follower<D>>(const Settings&)> make;
  FollowCosts costs{};

  /// If not 0, it compares each changed box with all others, so its cost is known beforehand. It is used for
  /// up to this number of boxes whatever the others cost, and for more if they make about as many tests.
  std::size_t max_boxes = 0;
};

/// The description of a broad-phase algorithm. Your own algorithm has one like those of the library: see
/// examples/own_algorithm.
struct Algorithm {
  std::string name;     ///< as in a spec: lower case, digits and underscores
  std::string summary;  ///< one line
  std::string source;   ///< the paper, book or program it is from
  AlgorithmKind kind = AlgorithmKind::own;
  std::string version{};  ///< of the library behind it; empty for what is part of Broadside
  detail::Vector<Tunable> tunables{};

  MakeSearcher<2> searcher_2d{};  ///< empty if the algorithm does not support that dimension
  MakeSearcher<3> searcher_3d{};

  /// The structures that follow boxes; if there are none, a Tracker finds all pairs anew in each frame. If
  /// the tunable `update` has the choice "follow", a Tracker decides by FindCosts and FollowCosts whether it
  /// follows boxes or finds all pairs anew. Otherwise it always follows, by the first structure.
  detail::Vector<FollowerChoice<2>> followers_2d{};
  detail::Vector<FollowerChoice<3>> followers_3d{};
  FindCosts find_costs_2d{};
  FindCosts find_costs_3d{};

  /// Makes what a search lays over boxes, to be drawn: see debug/outline.hpp. Empty if there is nothing.
  MakeOutline<2> outline_2d{};
  MakeOutline<3> outline_3d{};

  bool tests_doubles = false;     ///< whether the searcher heeds SearchInput::doubles
  bool gives_candidates = false;  ///< whether every follower heeds Change::wants_candidates

  bool infinite_boxes = true;  ///< declared limit: false if boxes with infinite extents are beyond it

  /// Declared limit: the greatest magnitude of a finite coordinate that is within it.
  double largest_coordinate = std::numeric_limits<double>::max();

  /// Declared limit: the maximum number of boxes.
  std::size_t most_boxes = std::numeric_limits<std::size_t>::max();

  /// Whether it allocates memory other than through operator new, so that the lab cannot count it.
  bool own_allocator = false;

  /// The same by dimension.
  template <int D>
  [[nodiscard]] const MakeSearcher<D>& searcher() const noexcept {
    if constexpr (D == 2)
      return searcher_2d;
    else
      return searcher_3d;
  }
  template <int D>
  [[nodiscard]] std::span<const FollowerChoice<D>> followers() const noexcept {
    if constexpr (D == 2)
      return followers_2d;
    else
      return followers_3d;
  }
  template <int D>
  [[nodiscard]] const FindCosts& find_costs() const noexcept {
    return D == 2 ? find_costs_2d : find_costs_3d;
  }
  template <int D>
  [[nodiscard]] const MakeOutline<D>& outline() const noexcept {
    if constexpr (D == 2)
      return outline_2d;
    else
      return outline_3d;
  }

  /// Whether it supports `dimension`.
  [[nodiscard]] bool has_dimension(int dimension) const {
    return dimension == 2 ? bool(searcher_2d) : dimension == 3 && bool(searcher_3d);
  }
};

/// Whether it can use several threads: it then has the tunable `threads`, a whole number, from which Finder
/// and Tracker set the number of threads of their Workers.
[[nodiscard]] BROADSIDE_PUBLIC bool has_threads(const Algorithm& algorithm);

/// The algorithms that have a name: the library's, in a fixed order (all, unless it was built with a shorter
/// BROADSIDE_ALGORITHMS), then those registered, in the order of registration. Thread-safe.
[[nodiscard]] BROADSIDE_PUBLIC std::span<const Algorithm> algorithms();

/// Adds an algorithm of your own, so that find_pairs(), Finder, Tracker and World know it by its name.
/// Throws InvalidSpec if the name is taken, or has characters other than lower-case letters, digits and
/// underscores.
///
/// Call it before anything is made by name: it must not run at the same time as anything that looks up a
/// name. Spans and references that algorithms() and find_algorithm() have returned stay valid; the spans do
/// not grow. Cost: a copy of the list, once for each algorithm.
BROADSIDE_PUBLIC void register_algorithm(Algorithm algorithm);

/// The algorithm called `name` among `among`, or a null pointer. The former name of an algorithm finds the
/// one that replaced it: `hierarchical_grid` is `grid`.
[[nodiscard]] BROADSIDE_PUBLIC const Algorithm* find_algorithm(
    std::string_view name, std::span<const Algorithm> among = algorithms());

}  // namespace broadside
