// Inputs of the worst-case hunt, by name.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "broadside/algorithm.hpp"
#include "broadside/debug/history.hpp"

#include "lab/scenes/random.hpp"
#include "lab/scenes/scene.hpp"
#include "lab/worst/family.hpp"

namespace broadside::lab {

/// The call made with the boxes.
enum class HardCall { find, between, track };

/// A kind of boxes, and the call made with them; everything but the number of boxes.
struct HardInput {
  Spec family;  ///< and the values of its own tunables
  int dimension = 2;
  bool in_double = false;  ///< the precision of the boxes
  HardCall call = HardCall::find;
  double left = 0.5;           ///< for find_across(): the fraction of the boxes in the left set
  double moving = 0;           ///< for trackers: the fraction that moves
  double drift = 0;            ///< distance that a mover goes in a frame, in units of its size
  double teleport = 0;         ///< the fraction of movers that jump in a frame
  double exponent = 0;         ///< coordinates are multiplied by 10^exponent
  double offset = 0;           ///< added to each coordinate before scaling
  std::string order = "made";  ///< "made", "shuffled" or "reversed"
  std::uint64_t seed = 1;

  /// The text from which parse_input() reads the same input.
  std::string text() const;
};

/// Parses an input such as "plates:regions=4:dimension=3:call=track:moving=0.01". Omitted values have their
/// defaults. Throws InvalidSpec.
HardInput parse_input(std::string_view text);

/// Draws a family, its values and the rest. For trackers, a hundredth, a tenth, all or `movers` of `boxes`
/// boxes move.
HardInput draw_input(Random& random, std::size_t boxes, std::size_t movers = 100);

/// The boxes, set moving for `frames` frames if the call is to a tracker. In float, coordinates out of range
/// become the largest float. The same on every machine.
template <int D, typename Real>
History<D, Real> make_input(const HardInput& input, std::size_t boxes, std::size_t frames);

/// The number of `boxes` boxes that are in the left set; 0 unless the call is to find_across().
std::size_t left_count(const HardInput& input, std::size_t boxes);

/// Uniform boxes with the same call: the input that this one is compared with.
HardInput uniform_for(const HardInput& input);

/// Every family with its default values, in both dimensions and precisions and with every call, and inputs
/// that were slow in the past.
std::vector<HardInput> fixed_inputs();

}  // namespace broadside::lab
