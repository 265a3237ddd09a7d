// The world that the paper's grid and quadtree must know before they file a box: declared in a spec, or taken
// from the boxes.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "broadside/algorithm.hpp"
#include "broadside/box.hpp"

namespace broadside::paper {

/// A rectangle; y grows downwards, as the paper has it. Width and height are above 0.
struct World {
  double left;
  double top;
  double width;
  double height;
};

/// The tunables left, top, width and height, each "auto" unless given.
std::vector<Tunable> world_tunables();

/// What a spec declares of the world; the boxes say the rest.
class WorldSettings {
 public:
  /// `settings` must have the tunables of world_tunables().
  explicit WorldSettings(const Settings& settings);

  /// The world as declared; where nothing is, the bounds of the boxes' finite coordinates (1 wide or high
  /// where these have no extent). Boxes may reach beyond it.
  World around(std::span<const Box2> boxes) const;

 private:
  std::optional<double> left_;
  std::optional<double> top_;
  std::optional<double> width_;
  std::optional<double> height_;
};

}  // namespace broadside::paper
