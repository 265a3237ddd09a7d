// The inputs that the worst-case hunt uses unless others are requested.
#include <array>
#include <utility>

#include "lab/worst/hard_input.hpp"

namespace broadside::lab {
namespace {

/// Slow in the past, each for a different reason; float and find() unless stated otherwise.
constexpr std::array known = {
    // Doubles beyond the range of floats.
    "even:neighbours=4:dimension=3:real=double:exponent=60",
    "even:neighbours=4:dimension=3:real=double:exponent=-60",
    "even:neighbours=4:dimension=2:real=double:exponent=60",
    "even:neighbours=4:dimension=2:real=double:exponent=-60",
    "even:neighbours=4:dimension=2:real=double:exponent=-60:call=track:moving=0.001",
    "even:neighbours=4:dimension=2:real=double:exponent=60:call=track:moving=0.001",
    // Trackers: two stacks of plates, and lines.
    "plates:neighbours=0.1:regions=2:axes=same:dimension=3:call=track:moving=0.01",
    "plates:neighbours=1:regions=2:axes=alternate:dimension=3:call=track:moving=0.01",
    "lines:neighbours=1:dimension=3:call=track:moving=0.01:order=shuffled",
    "lines:neighbours=1:axes=1:dimension=3:call=track:moving=0.01:order=shuffled",
    // Samples that mislead.
    "fooled:hidden=plates:dimension=2:seed=2",
    "fooled:hidden=plates:dimension=3:seed=3",
    "fooled:hidden=lines:dimension=3:seed=4",
    "fooled:hidden=clusters:dimension=2:seed=5",
    "fooled:hidden=heaps:dimension=2:seed=6",
    "fooled:hidden=plates:places=golden:samples=256:dimension=3:real=double",
    "fooled:hidden=plates:places=golden:dimension=3:call=track:moving=0.01",
    // Long thin boxes in double, and clusters of clusters.
    "lines:neighbours=0.001:dimension=3:real=double:order=shuffled",
    "lines:neighbours=1:dimension=3:real=double:order=shuffled",
    "lines:neighbours=1:layout=lattice:dimension=3:real=double:order=shuffled",
    "clusters:levels=6:branches=6:shrink=100:dimension=2:real=double",
    "clusters:levels=12:branches=3:shrink=20:dimension=2:real=double:order=shuffled",
    // Inputs that are hard for a single algorithm.
    "magnitudes:of=sizes:decades=36:dimension=3:order=shuffled",
    "magnitudes:of=places:decades=36:dimension=2:order=shuffled",
    "plates:neighbours=1:regions=60:dimension=2:order=shuffled",
    "plates:neighbours=1:regions=60:dimension=3:order=shuffled",
    "plates:neighbours=1:regions=300:axes=alternate:layout=row:dimension=3:order=shuffled",
};

}  // namespace

std::vector<HardInput> fixed_inputs() {
  std::vector<HardInput> inputs;
  for (const char* text : known) inputs.push_back(parse_input(text));
  for (const InputFamily& family : input_families()) {
    for (const int dimension : {2, 3}) {
      for (const bool in_double : {false, true}) {
        for (const HardCall call : {HardCall::find, HardCall::between, HardCall::track}) {
          if (family.two_sets && call != HardCall::between) continue;
          // Plates and lines have too many pairs with each other in 3D.
          Spec spec{family.name, {}};
          if (family.name == "mixture" && dimension == 3)
            spec.values = {{"first", "clusters"}, {"second", "plates"}};
          inputs.push_back({.family = std::move(spec),
                            .dimension = dimension,
                            .in_double = in_double,
                            .call = call,
                            .moving = dimension == 2 ? 0.1 : 0.01,
                            .drift = 0.02,
                            .order = family.fixed_order || call == HardCall::track ? "made" : "shuffled"});
        }
      }
    }
  }
  return inputs;
}

}  // namespace broadside::lab
