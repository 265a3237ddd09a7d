// Boxes in clusters with empty space between: what a structure that divides space evenly fears.
#include "lab/scenes/descriptions.hpp"
#include "lab/scenes/scatter.hpp"

namespace broadside::lab::generated {
namespace {

template <int D>
std::vector<Box<D>> make(const Settings& settings, std::size_t count, std::uint64_t seed) {
  const auto clusters = static_cast<std::uint64_t>(settings.integer("clusters"));
  const double spread = settings.number("spread");
  const double neighbours = settings.number("neighbours");

  // Two centres of one cluster lie within r << deviation of each other, on one axis, with a chance of
  // r / (deviation sqrt(pi)); of two clusters, 2 r / world. The mean r of two boxes is 1.
  const double others = count < 2 ? 1 : static_cast<double>(count - 1);
  const double in_one = 1 / static_cast<double>(clusters);
  const double root_of_pi = 1.7724538509055160;
  const double chance = in_one * power(1 / root_of_pi, D) + (1 - in_one) * power(2 * spread, D);
  const double deviation = power(others * chance / neighbours, 1.0 / D);
  const double world = deviation / spread;

  Random random(seed);
  std::vector<std::array<double, D>> middles(clusters);
  for (auto& middle : middles) {
    for (double& coordinate : middle) coordinate = random.between(0, world);
  }
  std::vector<Box<D>> boxes;
  boxes.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::array<double, D> centre = middles[random.below(clusters)];
    for (double& coordinate : centre) coordinate += deviation * random.gaussian();
    boxes.push_back(box_around<D>(centre, modest_size<D>(random)));
  }
  return boxes;
}

}  // namespace

Scene clustered() {
  return {
      .name = "clustered",
      .summary = "normal clusters, far from each other",
      .source = "Broadside",
      .tunables = {neighbours_tunable(),
                   {.name = "clusters",
                    .summary = "how many clusters there are",
                    .standard = "16",
                    .type = Tunable::Type::integer,
                    .least = 1,
                    .most = 1e6},
                   {.name = "spread",
                    .summary = "a cluster's standard deviation over the side of the world",
                    .standard = "0.02",
                    .least = 1e-6,
                    .most = 1}},
      .boxes_2d = make<2>,
      .boxes_3d = make<3>,
  };
}

}  // namespace broadside::lab::generated
