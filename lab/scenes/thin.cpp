// Long thin boxes along the axes, as roads, walls and wires are.
#include "lab/scenes/descriptions.hpp"
#include "lab/scenes/scatter.hpp"

namespace broadside::lab::generated {
namespace {

template <int D>
std::vector<Box<D>> make(const Settings& settings, std::size_t count, std::uint64_t seed) {
  const double aspect = settings.number("aspect");
  Random random(seed);
  std::vector<Size<D>> sizes(count);
  for (Size<D>& size : sizes) {
    size = modest_size<D>(random);
    size[random.below(D)] *= aspect;
  }
  return scatter<D>(sizes, settings.number("neighbours"), random);
}

}  // namespace

Scene thin() {
  return {
      .name = "thin",
      .summary = "long thin boxes, each along one axis",
      .source = "Broadside",
      .tunables = {neighbours_tunable(),
                   {.name = "aspect",
                    .summary = "a box's length over its width",
                    .standard = "50",
                    .least = 1,
                    .most = 1e6}},
      .boxes_2d = make<2>,
      .boxes_3d = make<3>,
  };
}

}  // namespace broadside::lab::generated
