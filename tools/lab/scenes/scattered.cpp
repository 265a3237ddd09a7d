// Scenes of boxes scattered at random, with different distributions of sizes and places.
#include <algorithm>

#include "lab/scenes/registry.hpp"
#include "lab/scenes/scatter.hpp"

namespace broadside::lab::generated {
namespace {

/// Boxes of similar size, uniformly distributed: the case that most broad phases are made for.
template <int D>
std::vector<Box<D>> make_uniform(const Settings& settings, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Size<D>> sizes(count);
  for (Size<D>& size : sizes) size = modest_size<D>(random);
  return scatter<D>(sizes, settings.number("neighbours"), random);
}

/// A size from 1 to `ratio` with density size^-exponent: the inverse of the distribution function at
/// `fraction`.
double draw(double exponent, double ratio, double fraction) {
  if (std::abs(exponent - 1) < 1e-6) return power(ratio, fraction);
  const double last = power(ratio, 1 - exponent);
  return power(1 + fraction * (last - 1), 1 / (1 - exponent));
}

/// Boxes whose sizes follow a power law: no size is typical, as with real maps and models.
template <int D>
std::vector<Box<D>> make_power_law(const Settings& settings, std::size_t count, std::uint64_t seed) {
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

/// A few huge boxes among many small ones. The worst case for a grid with one cell size.
template <int D>
std::vector<Box<D>> make_mixed(const Settings& settings, std::size_t count, std::uint64_t seed) {
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

/// Boxes in clusters with empty space between them. The worst case for a structure that divides space evenly.
template <int D>
std::vector<Box<D>> make_clustered(const Settings& settings, std::size_t count, std::uint64_t seed) {
  const auto clusters = static_cast<std::uint64_t>(settings.integer("clusters"));
  const double spread = settings.number("spread");
  const double neighbours = settings.number("neighbours");

  // On one axis, two centres of the same cluster are within r << deviation of each other with probability r /
  // (deviation sqrt(pi)), and centres of two clusters with probability 2 r / world. The mean r of two boxes
  // is 1.
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

/// Long thin boxes along the axes, like roads, walls and wires.
template <int D>
std::vector<Box<D>> make_thin(const Settings& settings, std::size_t count, std::uint64_t seed) {
  const double aspect = settings.number("aspect");
  Random random(seed);
  std::vector<Size<D>> sizes(count);
  for (Size<D>& size : sizes) {
    size = modest_size<D>(random);
    size[random.below(D)] *= aspect;
  }
  return scatter<D>(sizes, settings.number("neighbours"), random);
}

/// A few boxes as long as the world among many small ones, like walls, rivers and power lines. The worst case
/// for a partition that copies a box into each part it touches.
template <int D>
std::vector<Box<D>> make_walls(const Settings& settings, std::size_t count, std::uint64_t seed) {
  const auto one_in = std::min<std::size_t>(static_cast<std::size_t>(settings.integer("one_in")), count);
  constexpr double thickness = 0.01;
  Random random(seed);
  std::vector<Size<D>> sizes(count);
  for (Size<D>& size : sizes) size = modest_size<D>(random);
  const double neighbours = settings.number("neighbours");
  const double side = world_side<D>(sizes, neighbours);
  std::vector<Box<D>> boxes = scatter<D>(sizes, neighbours, random);
  for (std::size_t i = one_in / 2; i < count; i += one_in) {
    std::array<double, D> centre;
    Size<D> size;
    for (double& coordinate : centre) coordinate = random.between(0, side);
    size.fill(thickness);
    const auto along = random.below(D);
    centre[along] = side / 2;
    size[along] = side;
    boxes[i] = box_around<D>(centre, size);
  }
  return boxes;
}

/// Boxes with the same interval on the x axis: a sweep along x prunes nothing.
template <int D>
std::vector<Box<D>> make_one_line(const Settings& settings, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Size<D>> sizes(count);
  for (Size<D>& size : sizes) {
    size = modest_size<D>(random);
    size[0] = 1;
  }
  const double side = world_side<D>(sizes, settings.number("neighbours"), 1);
  std::vector<Box<D>> boxes;
  boxes.reserve(count);
  for (const Size<D>& size : sizes) {
    std::array<double, D> centre{};
    for (int axis = 1; axis < D; ++axis) centre[axis] = random.between(0, side);
    boxes.push_back(box_around<D>(centre, size));
  }
  return boxes;
}

/// Boxes that share a point, so that every two overlap: the worst case for every algorithm.
template <int D>
std::vector<Box<D>> make_one_point(const Settings&, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Box<D>> boxes(count);
  for (Box<D>& box : boxes) {
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] = static_cast<float>(random.between(-1, 0));
      box.max[axis] = static_cast<float>(random.between(0, 1));
    }
  }
  return boxes;
}

}  // namespace

Scene uniform() {
  return {
      .name = "uniform",
      .summary = "boxes of about one size, anywhere alike",
      .source = "Broadside",
      .tunables = {neighbours_tunable()},
      .boxes_2d = make_uniform<2>,
      .boxes_3d = make_uniform<3>,
  };
}

Scene power_law() {
  return {
      .name = "power_law",
      .summary = "sizes by a power law: many small boxes, few large ones, none typical",
      .source = "Broadside",
      .tunables = {neighbours_tunable(),
                   {.name = "exponent",
                    .summary = "how fast large boxes become rare: their density goes with size^-exponent",
                    .default_value = "2.5",
                    .min = 0,
                    .max = 10},
                   {.name = "ratio",
                    .summary = "the largest size over the smallest",
                    .default_value = "1000",
                    .min = 1,
                    .max = 1e6}},
      .boxes_2d = make_power_law<2>,
      .boxes_3d = make_power_law<3>,
  };
}

Scene mixed() {
  return {
      .name = "mixed",
      .summary = "one box in a hundred is huge, the others are small",
      .source = "Broadside",
      .tunables = {neighbours_tunable(),
                   {.name = "scale",
                    .summary = "the size of a huge box over that of a small one",
                    .default_value = "100",
                    .min = 1,
                    .max = 1e6}},
      .boxes_2d = make_mixed<2>,
      .boxes_3d = make_mixed<3>,
  };
}

Scene clustered() {
  return {
      .name = "clustered",
      .summary = "normal clusters, far from each other",
      .source = "Broadside",
      .tunables = {neighbours_tunable(),
                   {.name = "clusters",
                    .summary = "how many clusters there are",
                    .default_value = "16",
                    .type = Tunable::Type::integer,
                    .min = 1,
                    .max = 1e6},
                   {.name = "spread",
                    .summary = "a cluster's standard deviation over the side of the world",
                    .default_value = "0.02",
                    .min = 1e-6,
                    .max = 1}},
      .boxes_2d = make_clustered<2>,
      .boxes_3d = make_clustered<3>,
  };
}

Scene thin() {
  return {
      .name = "thin",
      .summary = "long thin boxes, each along one axis",
      .source = "Broadside",
      .tunables = {neighbours_tunable(),
                   {.name = "aspect",
                    .summary = "a box's length over its width",
                    .default_value = "50",
                    .min = 1,
                    .max = 1e6}},
      .boxes_2d = make_thin<2>,
      .boxes_3d = make_thin<3>,
  };
}

Scene walls() {
  return {
      .name = "walls",
      .summary = "a few thin boxes as long as the world, the others are small",
      .source = "Broadside",
      .tunables = {neighbours_tunable(),
                   {.name = "one_in",
                    .summary = "how many boxes there are for each long one",
                    .default_value = "10000",
                    .type = Tunable::Type::integer,
                    .min = 1,
                    .max = 1e9}},
      .boxes_2d = make_walls<2>,
      .boxes_3d = make_walls<3>,
      .hard = true,
  };
}

Scene one_line() {
  return {
      .name = "one_line",
      .summary = "all boxes have the same interval on the x axis",
      .source = "Broadside",
      .tunables = {neighbours_tunable()},
      .boxes_2d = make_one_line<2>,
      .boxes_3d = make_one_line<3>,
  };
}

Scene one_point() {
  return {
      .name = "one_point",
      .summary = "every box contains the origin: all n (n - 1) / 2 pairs overlap",
      .source = "Broadside",
      .boxes_2d = make_one_point<2>,
      .boxes_3d = make_one_point<3>,
  };
}

}  // namespace broadside::lab::generated
