// The worst inputs that the worst-case hunt (bench/worst) found: its families with the slowest values, each
// slow for a different reason.
#include <array>
#include <string>

#include "lab/scenes/registry.hpp"
#include "lab/worst/hard_input.hpp"

namespace broadside::lab::generated {
namespace {

/// A scene made from an input of the hunt, in float.
struct HuntedScene {
  const char* name;
  const char* summary;
  const char* input;  // the hunt's name for it
  bool fixed_seed = false;
};

constexpr std::array found = {
    HuntedScene{"crossed_plates", "two stacks of parallel plates, the one across the other",
                "plates:neighbours=1:regions=2"},
    HuntedScene{"many_stacks",
                "300 stacks of parallel plates in a row, each along another axis than the one before",
                "plates:neighbours=1:regions=300:layout=row:order=shuffled"},
    HuntedScene{"plates_and_lines", "stacks of parallel plates, and long thin boxes through them",
                "mixture:first=plates:second=lines:order=shuffled"},
    HuntedScene{"wires", "long thin boxes along each axis, in 3D through the whole world",
                "lines:neighbours=1:order=shuffled"},
    HuntedScene{"staircase", "boxes one after the other along the diagonal, in order", "row:overlap=1.5",
                true},
    HuntedScene{"nested_clusters", "clusters of clusters, six times, each a hundredth of the one around it",
                "clusters:levels=6:branches=6:shrink=100:order=shuffled"},
    HuntedScene{"cantor_dust", "boxes at the ends of intervals at the ends of intervals",
                "dust:kept=0.1:order=shuffled"},
    HuntedScene{"many_scales", "places of 20 orders of magnitude, boxes as large as their distance allows",
                "magnitudes:decades=20:order=shuffled"},
    HuntedScene{"many_sizes", "sizes of 30 orders of magnitude",
                "magnitudes:of=sizes:decades=30:order=shuffled"},
    HuntedScene{
        "misleading_sample",
        "even boxes where a sample of the array looks, plates elsewhere; of some thousands of boxes and more",
        "fooled:hidden=plates"},
};

template <int D>
MakeBoxes<D> maker(const char* input) {
  return [text = std::string(input)](const Settings&, std::size_t boxes, std::uint64_t seed) {
    HardInput wanted = parse_input(text);
    wanted.dimension = D;
    wanted.seed = seed;
    return make_input<D, float>(wanted, boxes, 0).boxes;
  };
}

}  // namespace

std::vector<Scene> hard() {
  std::vector<Scene> scenes;
  for (const HuntedScene& input : found) {
    scenes.push_back({.name = input.name,
                      .summary = input.summary,
                      .source = "Broadside's worst-case hunt",
                      .boxes_2d = maker<2>(input.input),
                      .boxes_3d = maker<3>(input.input),
                      .fixed_seed = input.fixed_seed,
                      .hard = true});
  }
  return scenes;
}

}  // namespace broadside::lab::generated
