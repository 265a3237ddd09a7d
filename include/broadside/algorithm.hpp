// What the library knows of an algorithm: its description, how to make one from a spec, and the list of all
// of them, to which users add their own.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "broadside/broad_phase.hpp"
#include "broadside/spec.hpp"

namespace broadside {

/// The spec that find_pairs() and World use unless told otherwise.
inline constexpr std::string_view default_algorithm = "auto";

/// Where an algorithm comes from.
enum class AlgorithmKind { own, paper, peer };

/// "own", "paper" or "peer".
std::string_view name(AlgorithmKind kind) noexcept;

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
  std::vector<Tunable> tunables{};

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
bool has_threads(const Algorithm& algorithm);

/// The algorithms that have a name: the library's, in a fixed order (all, unless it was built with a shorter
/// BROADSIDE_ALGORITHMS), then those registered, in the order of registration. Thread-safe.
std::span<const Algorithm> algorithms();

/// Adds an algorithm of your own, so that find_pairs(), World, make_finder() and make_tracker() know it by
/// its name. Throws InvalidSpec if the name is taken, or is not of lower-case letters, digits and
/// underscores.
///
/// Call it before anything is made by name: it must not run at the same time as anything that looks up a
/// name. Spans and references that algorithms() and find_algorithm() have returned stay valid; the spans do
/// not grow. Cost: a copy of the list, once for each algorithm.
void register_algorithm(Algorithm algorithm);

/// The algorithm called `name` among `among`, or a null pointer. A name of an earlier version finds what took
/// its place: `hierarchical_grid` is `grid`.
const Algorithm* find_algorithm(std::string_view name, std::span<const Algorithm> among = algorithms());

/// Makes a finder of `algorithm` with the values in `spec`, whose name is not looked at. Throws InvalidSpec
/// if a value is wrong or the algorithm does not do D dimensions.
///
/// Algorithms work on floats. A finder of boxes of doubles rounds them to floats in the same order, about an
/// origin and at a scale of their own, and has a last test in double: its pairs are exact.
template <int D, typename Real = float>
std::unique_ptr<PairFinder<D, Real>> make_finder(const Algorithm& algorithm, const Spec& spec);

/// Likewise a tracker: the algorithm's own, or a DiffTracker over its finder.
template <int D, typename Real = float>
std::unique_ptr<PairTracker<D, Real>> make_tracker(const Algorithm& algorithm, const Spec& spec);

/// Makes a finder or a tracker of one of algorithms(), from a spec such as "grid:cell=2.5".
/// Throws InvalidSpec, naming the algorithms there are, if there is none of that name.
template <int D, typename Real = float>
std::unique_ptr<PairFinder<D, Real>> make_finder(std::string_view spec);
template <int D, typename Real = float>
std::unique_ptr<PairTracker<D, Real>> make_tracker(std::string_view spec);

}  // namespace broadside
