// The world that the paper's grid and quadtree must know before they add a box: given in a spec, or computed
// from the boxes.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "broadside/algorithm.hpp"
#include "broadside/box.hpp"

namespace broadside::paper {

/// A rectangle; y grows downwards, as in the paper. Width and height are positive.
struct World {
  double left;
  double top;
  double width;
  double height;
};

/// The tunables left, top, width and height, each "auto" unless given.
std::vector<Tunable> world_tunables();

/// The parts of the world that a spec gives; the boxes determine the rest.
class WorldSettings {
 public:
  /// `settings` must have the tunables of world_tunables().
  explicit WorldSettings(const Settings& settings);

  /// The world as given; otherwise the bounds of the boxes' finite coordinates (1 wide or high if these have
  /// no extent). Boxes may extend beyond it.
  World around(std::span<const Box2> boxes) const;

 private:
  std::optional<double> left_;
  std::optional<double> top_;
  std::optional<double> width_;
  std::optional<double> height_;
};

}  // namespace broadside::paper
