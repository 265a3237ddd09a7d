// Boxes of about one size, anywhere alike: the case that most broad phases are made for.
#include "lab/scenes/descriptions.hpp"
#include "lab/scenes/scatter.hpp"

namespace broadside::lab::generated {
namespace {

template <int D>
std::vector<Box<D>> make(const Settings& settings, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Size<D>> sizes(count);
  for (Size<D>& size : sizes) size = modest_size<D>(random);
  return scatter<D>(sizes, settings.number("neighbours"), random);
}

}  // namespace

Scene uniform() {
  return {
      .name = "uniform",
      .summary = "boxes of about one size, anywhere alike",
      .source = "Broadside",
      .tunables = {neighbours_tunable()},
      .boxes_2d = make<2>,
      .boxes_3d = make<3>,
  };
}

}  // namespace broadside::lab::generated
