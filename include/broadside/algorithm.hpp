// What the library knows of an algorithm: its description, its spec (such as "grid:cell=2.5"), how to make
// one from a spec, and the list of all algorithms, to which users add their own.
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
#include "broadside/finder.hpp"
#include "broadside/tracker.hpp"

namespace broadside {

/// A name and the values given to some of its tunables: `name:tunable=value:tunable=value`.
struct BROADSIDE_PUBLIC Spec {
  std::string name;
  detail::Vector<std::pair<std::string, std::string>> values;

  /// Reads a spec. Throws InvalidSpec, naming text and place, if it is empty, a part has no `=`, or a tunable
  /// is given twice. Whether name and tunables exist is for Settings to say.
  static Spec parse(std::string_view text);

  /// The text that parse() reads back to the same spec.
  std::string text() const;
};

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

/// A spec's values, checked against the tunables they are for; those not given have their standard value.
class BROADSIDE_PUBLIC Settings {
 public:
  /// Throws InvalidSpec if `spec` names an unknown tunable or gives a value of the wrong type or out of
  /// range. "auto" is a value of a tunable if and only if it is its standard one.
  Settings(const Spec& spec, std::span<const Tunable> tunables);

  /// Whether the tunable is left for the algorithm to choose.
  bool is_auto(std::string_view tunable) const { return text(tunable) == "auto"; }

  /// The value of a tunable, which must exist and not be "auto".
  double number(std::string_view tunable) const;
  std::int64_t integer(std::string_view tunable) const;
  const std::string& text(std::string_view tunable) const;

 private:
  detail::Vector<std::pair<std::string, std::string>> values_;
};

/// Where an algorithm comes from.
enum class AlgorithmKind { own, paper, literature, peer };

/// "own", "paper", "literature" or "peer".
BROADSIDE_PUBLIC std::string_view name(AlgorithmKind kind) noexcept;

template <int D>
using MakeFinder = std::function<std::unique_ptr<PairFinder<D>>(const Settings&)>;
template <int D, typename Real = float>
using MakeTracker = std::function<std::unique_ptr<PairTracker<D, Real>>(const Settings&)>;

/// A broad-phase algorithm, described. One's own is made the same way as the library's: see
/// examples/own_algorithm.
struct Algorithm {
  std::string name;     ///< as in a spec: lower case, digits and underscores
  std::string summary;  ///< one line
  std::string source;   ///< the paper, book or program it is from
  AlgorithmKind kind = AlgorithmKind::own;
  std::string version{};  ///< of the library behind it; empty for what is part of Broadside
  detail::Vector<Tunable> tunables{};

  MakeFinder<2> finder_2d{};  ///< empty where the algorithm does not do that dimension
  MakeFinder<3> finder_3d{};
  MakeTracker<2> tracker_2d{};  ///< empty where a DiffTracker over the finder is what tracks
  MakeTracker<3> tracker_3d{};

  /// Empty where a DiffTracker over a finder of doubles is what tracks boxes of doubles.
  MakeTracker<2, double> double_tracker_2d{};
  MakeTracker<3, double> double_tracker_3d{};

  bool infinite_boxes = true;  ///< declared limit: false if boxes with infinite extents are beyond it

  /// Declared limit: the greatest magnitude of a finite coordinate that is within it.
  double largest_coordinate = std::numeric_limits<double>::max();

  /// Declared limit: the most boxes it takes at once.
  std::size_t most_boxes = std::numeric_limits<std::size_t>::max();

  /// Whether it takes memory otherwise than through operator new, so that the lab cannot count it.
  bool own_allocator = false;

  /// Whether it does `dimension`.
  bool has_dimension(int dimension) const {
    return dimension == 2 ? bool(finder_2d) : dimension == 3 && bool(finder_3d);
  }
};

/// Whether it can use several threads: whether it has the tunable `threads`, a whole number, which
/// make_finder() and make_tracker() make the Workers' of what they make.
BROADSIDE_PUBLIC bool has_threads(const Algorithm& algorithm);

/// The algorithms that have a name: the library's, in a fixed order (all, unless it was built with a shorter
/// BROADSIDE_ALGORITHMS), then those registered, in the order of registration. Thread-safe.
BROADSIDE_PUBLIC std::span<const Algorithm> algorithms();

/// Adds an algorithm of your own, so that find_pairs(), World, make_finder() and make_tracker() know it by
/// its name. Throws InvalidSpec if the name is taken, or is not of lower-case letters, digits and
/// underscores.
///
/// Call it before anything is made by name: it must not run at the same time as anything that looks up a
/// name. Spans and references that algorithms() and find_algorithm() have returned stay valid; the spans do
/// not grow. Cost: a copy of the list, once for each algorithm.
BROADSIDE_PUBLIC void register_algorithm(Algorithm algorithm);

/// The algorithm called `name` among `among`, or a null pointer. A name of an earlier version finds what took
/// its place: `hierarchical_grid` is `grid`.
BROADSIDE_PUBLIC const Algorithm* find_algorithm(std::string_view name,
                                                 std::span<const Algorithm> among = algorithms());

/// Makes a finder of `algorithm` with the values in `spec`, whose name is not looked at. Throws InvalidSpec
/// if a value is wrong or the algorithm does not do D dimensions.
template <int D, typename Real = float>
BROADSIDE_PUBLIC std::unique_ptr<PairFinder<D, Real>> make_finder(const Algorithm& algorithm,
                                                                  const Spec& spec);

/// Likewise a tracker: the algorithm's own, or a DiffTracker over its finder.
template <int D, typename Real = float>
BROADSIDE_PUBLIC std::unique_ptr<PairTracker<D, Real>> make_tracker(const Algorithm& algorithm,
                                                                    const Spec& spec);

}  // namespace broadside
