// How boxes are set moving: the options that verbs share.
#include "cli/motion_options.hpp"

#include <cmath>

#include <fmt/format.h>

#include "cli/unusable.hpp"
#include "cli/values.hpp"

namespace broadside::cli {

void add_motion_options(CLI::App& verb, MotionOptions& options) {
  verb.add_option("--drift", options.drift,
                  fmt::format("How far a mover goes in a frame, in units of its own size (standard: {})",
                              options.drift_or_standard()));
  verb.add_option("--teleport", options.teleport,
                  "Fraction of the movers that jump anywhere instead, in each frame (standard: 0)");
}

void check(const MotionOptions& options) {
  if (options.drift && !(*options.drift >= 0 && std::isfinite(*options.drift)))
    throw Unusable(fmt::format("--drift is {}; expected a number of at least 0", *options.drift));
  if (options.teleport) check_fraction("--teleport", *options.teleport);
}

}  // namespace broadside::cli
