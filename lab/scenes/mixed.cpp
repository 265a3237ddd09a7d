// A few huge boxes among many small ones: what grids with one cell size fear.
#include "lab/scenes/descriptions.hpp"
#include "lab/scenes/scatter.hpp"

namespace broadside::lab::generated {
namespace {

template <int D>
std::vector<Box<D>> make(const Settings& settings, std::size_t count, std::uint64_t seed) {
  constexpr std::size_t one_in = 100;
  const double scale = settings.number("scale");
  Random random(seed);
  std::vector<Size<D>> sizes(count);
  for (std::size_t i = 0; i < count; ++i) {
    sizes[i] = modest_size<D>(random);
    if (i % one_in != one_in / 2) continue;
    for (double& extent : sizes[i]) extent *= scale;
  }
  return scatter<D>(sizes, settings.number("neighbours"), random);
}

}  // namespace

Scene mixed() {
  return {
      .name = "mixed",
      .summary = "one box in a hundred is huge, the others are small",
      .source = "Broadside",
      .tunables = {neighbours_tunable(),
                   {.name = "scale",
                    .summary = "the size of a huge box over that of a small one",
                    .standard = "100",
                    .least = 1,
                    .most = 1e6}},
      .boxes_2d = make<2>,
      .boxes_3d = make<3>,
  };
}

}  // namespace broadside::lab::generated
