// Algorithm: the description of a broad-phase algorithm, from which Finder, Tracker and World make its
// searcher and its followers. Also the list of all algorithms, to which you can add your own.
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
#include <type_traits>
#include <utility>

#include "broadside/export.hpp"
#include "broadside/follower.hpp"
#include "broadside/searcher.hpp"
#include "broadside/spec.hpp"

namespace broadside {

template <int D, typename Real>
struct Outline;

/// A parameter of an algorithm that a spec can set.
struct Tunable {
  enum class Type { number, integer, choice };

  std::string name;
  std::string summary;        ///< one line, with the unit
  std::string default_value;  ///< "auto" if the algorithm then chooses a value itself
  Type type = Type::number;
  double min = 0;  ///< for numbers and integers: the allowed range, both ends included
  double max = std::numeric_limits<double>::max();
  detail::Vector<std::string> choices{};  ///< for choices: the allowed values
};

/// The checked values of an algorithm's tunables: those that a spec gives, and defaults for the others.
class BROADSIDE_PUBLIC Settings {
 public:
  /// Throws InvalidSpec if `spec` names an unknown tunable or gives a value of the wrong type or out of
  /// range. "auto" is allowed if and only if it is the tunable's default value.
  Settings(const Spec& spec, std::span<const Tunable> tunables);

  /// Whether the algorithm is to choose the value itself.
  [[nodiscard]] bool is_auto(std::string_view tunable) const { return text(tunable) == "auto"; }

  /// The value of a tunable, which must exist. Numbers must not be "auto".
  [[nodiscard]] double number(std::string_view tunable) const;
  std::int64_t integer(std::string_view tunable) const;
  [[nodiscard]] const std::string& text(std::string_view tunable) const { return value(tunable).text(); }

  /// The number, or nothing if the value is "auto".
  [[nodiscard]] std::optional<double> optional_number(std::string_view tunable) const;

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
  double box = 40;                ///< per box, with 64 tests and 4 references; without its pairs
  double further_test = 0.5;      ///< each further test of a box
  double further_reference = 30;  ///< each further reference to a box
  double pair = 7;
};

/// The cost of following boxes in a structure, in the same unit.
struct FollowCosts {
  double start = 100;        ///< per box, to build the structure
  double mover = 160;        ///< per mover, with its tests: the estimate before any is followed
  double mover_alone = 140;  ///< per mover, without its tests
  double test = 1;           ///< each of a mover's first 64 tests
  double further_test = 1;   ///< each further one
};

template <int D>
using MakeSearcher = std::function<std::unique_ptr<Searcher<D>>(const Settings&)>;
template <int D>
using MakeFollower = std::function<std::unique_ptr<Follower<D>>(const Settings&)>;

/// Makes a searcher or a follower of class T, with T(settings) or T():
/// `.searcher = make_strategy<MySearcher<2>>`.
template <typename T>
std::unique_ptr<T> make_strategy([[maybe_unused]] const Settings& settings) {
  if constexpr (std::is_constructible_v<T, const Settings&>)
    return std::make_unique<T>(settings);
  else
    return std::make_unique<T>();
}

/// Makes an outline of a search with these settings, to be drawn: see debug/outline.hpp. All boxes are
/// present, and there is at least one. The parts of the outline may be infinite.
template <int D>
using MakeOutline = std::function<Outline<D, float>(std::span<const Box<D>> boxes, const Workers& workers,
                                                    const Settings& settings)>;

/// A follower that a Tracker may choose.
template <int D>
struct FollowerChoice {
  std::string name;  ///< as explanations name it
  MakeFollower<D> make;
  FollowCosts costs{};

  /// Not 0 if the follower compares each changed box with all others, so that its cost is known in advance.
  /// It is always used for up to this number of boxes, and for more if the others make about as many tests.
  std::size_t max_boxes = 0;
};

/// What an algorithm has for boxes of D dimensions.
template <int D>
struct Strategies {
  MakeSearcher<D> searcher{};  ///< empty if the algorithm does not support D dimensions

  /// The structures in which it follows moving boxes. If there are none, a Tracker finds all pairs anew in
  /// each frame; otherwise it follows with the first. If the algorithm also has a tunable `update` with the
  /// choice "follow", as the library's have, a Tracker compares FollowCosts and FindCosts in each frame, and
  /// uses the cheapest follower or finds all pairs anew.
  detail::Vector<FollowerChoice<D>> followers{};
  FindCosts find_costs{};

  MakeOutline<D> outline{};  ///< empty if there is nothing to draw
};

/// The input that an algorithm claims to support. The lab gives it no other; the library does not check.
struct InputLimits {
  bool infinite_boxes = true;                                  ///< whether boxes may have infinite extents
  double max_coordinate = std::numeric_limits<double>::max();  ///< greatest magnitude of a finite coordinate
  std::size_t max_boxes = std::numeric_limits<std::size_t>::max();
};

/// The description of a broad-phase algorithm: how it is named and set, and how its strategies are made.
/// Describe your own algorithm likewise, and pass it to register_algorithm(): see examples/own_algorithm.
struct Algorithm {
  std::string name;     ///< as in a spec: lower case, digits and underscores
  std::string summary;  ///< one line
  std::string source;   ///< the paper, book or program it is from
  AlgorithmKind kind = AlgorithmKind::own;
  std::string version{};  ///< of the library behind it; empty for Broadside's own algorithms
  detail::Vector<Tunable> tunables{};

  Strategies<2> in_2d{};
  Strategies<3> in_3d{};

  bool tests_doubles = false;     ///< whether the searcher heeds SearchInput::doubles
  bool gives_candidates = false;  ///< whether every follower heeds Change::wants_candidates
  InputLimits limits{};

  /// Whether it allocates memory other than through operator new, so that the lab cannot count it.
  bool own_allocator = false;

  /// in_2d or in_3d.
  template <int D>
  [[nodiscard]] const Strategies<D>& in() const noexcept {
    if constexpr (D == 2)
      return in_2d;
    else
      return in_3d;
  }

  /// Whether it supports boxes of `dimension` dimensions.
  [[nodiscard]] bool has_dimension(int dimension) const {
    return dimension == 2 ? bool(in_2d.searcher) : dimension == 3 && bool(in_3d.searcher);
  }
};

/// Whether it can use several threads: it then has an integer tunable `threads`, which sets the number of
/// threads in the Workers of Finder and Tracker.
[[nodiscard]] BROADSIDE_PUBLIC bool has_threads(const Algorithm& algorithm);

/// The algorithms that a spec can name: the library's, in a fixed order (all, unless it was built with a
/// shorter BROADSIDE_ALGORITHMS), then registered ones in the order of registration. Thread-safe.
[[nodiscard]] BROADSIDE_PUBLIC std::span<const Algorithm> algorithms();

/// Adds an algorithm of your own, so that find_pairs(), Finder, Tracker and World know it by its name. Throws
/// InvalidSpec if the name is taken, or has characters other than lower-case letters, digits and underscores.
///
/// Call it before anything is made by name: it must not run while another thread looks up a name. Spans and
/// references that algorithms() and find_algorithm() have returned stay valid; the spans do not grow. Cost:
/// one copy of the list.
BROADSIDE_PUBLIC void register_algorithm(Algorithm algorithm);

/// The algorithm called `name` among `among`, or null. A former name finds the algorithm that replaced it:
/// `hierarchical_grid` finds `grid`.
[[nodiscard]] BROADSIDE_PUBLIC const Algorithm* find_algorithm(
    std::string_view name, std::span<const Algorithm> among = algorithms());

}  // namespace broadside
