// Boxes whose sizes follow a power law: no size is typical, as with real maps and models.
#include "lab/scenes/descriptions.hpp"
#include "lab/scenes/scatter.hpp"

namespace broadside::lab::generated {
namespace {

/// A size from 1 to `ratio` with density size^-exponent, by the inverse of the distribution at `fraction`.
double draw(double exponent, double ratio, double fraction) {
  if (std::abs(exponent - 1) < 1e-6) return power(ratio, fraction);
  const double last = power(ratio, 1 - exponent);
  return power(1 + fraction * (last - 1), 1 / (1 - exponent));
}

template <int D>
std::vector<Box<D>> make(const Settings& settings, std::size_t count, std::uint64_t seed) {
  const double exponent = settings.number("exponent");
  const double ratio = settings.number("ratio");
  Random random(seed);
  std::vector<Size<D>> sizes(count);
  for (Size<D>& size : sizes) {
    size = modest_size<D>(random);
    const double scale = draw(exponent, ratio, random.fraction());
    for (double& extent : size) extent *= scale;
  }
  return scatter<D>(sizes, settings.number("neighbours"), random);
}

}  // namespace

Scene power_law() {
  return {
      .name = "power_law",
      .summary = "sizes by a power law: many small boxes, few large ones, none typical",
      .source = "Broadside",
      .tunables = {neighbours_tunable(),
                   {.name = "exponent",
                    .summary = "how fast large boxes become rare: their density goes with size^-exponent",
                    .standard = "2.5",
                    .least = 0,
                    .most = 10},
                   {.name = "ratio",
                    .summary = "the largest size over the smallest",
                    .standard = "1000",
                    .least = 1,
                    .most = 1e6}},
      .boxes_2d = make<2>,
      .boxes_3d = make<3>,
  };
}

}  // namespace broadside::lab::generated
