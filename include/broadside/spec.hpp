// Spec: which algorithm to use, and the values of its tunables, as a text such as "grid:cell=2.5" or as typed
// options such as GridOptions{.cell = 2.5}.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "broadside/export.hpp"

namespace broadside {

/// The name of the algorithm that Finder, Tracker, World and find_pairs() use unless told otherwise.
inline constexpr std::string_view default_algorithm = "auto";

/// The value of a tunable in a spec: a text, or a number.
class BROADSIDE_PUBLIC SpecValue {
 public:
  SpecValue(std::string text) : text_(std::move(text)) {}
  SpecValue(const char* text) : text_(text) {}
  SpecValue(double number);

  /// The text. For a number, the shortest text that reads back to it.
  [[nodiscard]] const std::string& text() const noexcept { return text_; }
  operator const std::string&() const noexcept { return text_; }

  /// The number; empty if the value is a text, which Settings will parse.
  [[nodiscard]] const std::optional<double>& number() const noexcept { return number_; }

  friend bool operator==(const SpecValue& a, const SpecValue& b) noexcept { return a.text_ == b.text_; }

 private:
  std::string text_;
  std::optional<double> number_;
};

/// An algorithm's name and the values given to some of its tunables: `name:tunable=value:tunable=value`.
///
/// Texts and the options below convert to it, so that Finder<2>("grid:cell=2.5") and
/// Finder<2>(GridOptions{.cell = 2.5}) make the same finder. Whether the name and the tunables exist, and
/// whether the values are in range, is checked where the algorithm is made.
struct BROADSIDE_PUBLIC Spec {
  /// The default algorithm.
  Spec() : name(default_algorithm) {}

  Spec(std::string its_name, detail::Vector<std::pair<std::string, SpecValue>> its_values)
      : name(std::move(its_name)), values(std::move(its_values)) {}

  /// Reads a text. Throws InvalidSpec, naming text and place, if it is empty, a part has no `=`, or a tunable
  /// is given twice.
  Spec(std::string_view text);
  Spec(const char* text) : Spec(text == nullptr ? std::string_view() : std::string_view(text)) {}
  Spec(const std::string& text) : Spec(std::string_view(text)) {}
  Spec(std::nullptr_t) = delete;

  /// The text that reads back to the same spec.
  [[nodiscard]] std::string text() const;

  friend bool operator==(const Spec&, const Spec&) = default;

  std::string name;
  detail::Vector<std::pair<std::string, SpecValue>> values;
};

/// How a Tracker updates its pairs: `follow` follows the boxes that changed, `rebuild` finds all pairs anew,
/// and `automatic` does whichever costs less in each frame.
enum class Update : std::uint8_t { automatic, follow, rebuild };

enum class Axis : std::uint8_t { x, y, z };

// Options of the library's algorithms. Each converts to a Spec; using a Spec with a value out of range throws
// InvalidSpec. If a value is empty, the algorithm chooses it. `threads` is the maximum number of threads of a
// search, up to 1024; 0 means as many as the executor has. `update` matters only to trackers and worlds.

/// Chooses among the other algorithms from a sample of the boxes; in trackers, in each frame.
struct BROADSIDE_PUBLIC AutoOptions {
  std::size_t threads = 1;
  Update update = Update::automatic;

  operator Spec() const;
};

/// Tests every box against every other.
struct BROADSIDE_PUBLIC BruteForceOptions {
  std::size_t threads = 1;
  Update update = Update::automatic;

  operator Spec() const;
};

/// A uniform grid over all axes but one; the boxes of each cell are swept along that axis.
struct BROADSIDE_PUBLIC GridOptions {
  /// The size of a cell in the boxes' unit, above 0; larger if there would be more than 4 cells per box. In
  /// trackers, the size of the smallest cells.
  std::optional<double> cell{};
  std::size_t threads = 1;
  Update update = Update::automatic;

  operator Spec() const;
};

/// A sorted sweep along one axis, in stripes of a second axis where that pays.
struct BROADSIDE_PUBLIC SweepAndPruneOptions {
  std::optional<Axis> axis{};        ///< the axis to sweep along
  std::optional<bool> is_striped{};  ///< whether a second axis is cut into stripes
  std::size_t threads = 1;
  Update update = Update::automatic;

  operator Spec() const;
};

/// A quadtree, in 3D an octree. Nodes are split at medians until they hold few boxes.
struct BROADSIDE_PUBLIC QuadtreeOptions {
  std::optional<std::size_t> capacity{};  ///< a node with at most this number of boxes is not split; from 1
  std::size_t threads = 1;
  Update update = Update::automatic;

  operator Spec() const;
};

/// A bounding volume hierarchy (AABB tree) with sixteen children per node, joined with itself.
struct BROADSIDE_PUBLIC BvhOptions {
  std::size_t threads = 1;
  Update update = Update::automatic;

  operator Spec() const;
};

}  // namespace broadside
