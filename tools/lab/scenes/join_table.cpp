// The uniform boxes of SwiftSpatial (Jiang et al., SIGMOD 2025, arXiv 2309.16520), as its data_gen.py makes
// them: squares of side 1 in a world 10,000 wide, from NumPy's legacy generator, written with two decimals.
#include "lab/scenes/join_table.hpp"

#include <cmath>
#include <random>

#include "lab/scenes/registry.hpp"

namespace broadside::lab {
namespace {

/// The numbers of numpy.random.rand() after numpy.random.seed(): the Mersenne twister, with 53 bits from two
/// of its numbers.
class LegacyNumpy {
 public:
  explicit LegacyNumpy(std::uint32_t seed) : twister_(seed) {}

  double fraction() {
    const std::uint_fast32_t high = twister_() >> 5;
    const std::uint_fast32_t low = twister_() >> 6;
    return (static_cast<double>(high) * 0x1p26 + static_cast<double>(low)) * 0x1p-53;
  }

 private:
  std::mt19937 twister_;
};

/// The number read back after `coordinate` was written with two decimals, as by printf's %.2f: the decimal
/// nearest to its exact value. In close cases, the product's rounding error, computed by fma, decides.
double with_two_decimals(double coordinate) {
  const double product = coordinate * 100;
  const double error = std::fma(coordinate, 100.0, -product);
  const double below = std::floor(product);
  const double beyond_half = (product - below) - 0.5;  // exact
  return (beyond_half + error > 0 ? below + 1 : below) / 100;
}

}  // namespace

std::vector<DoubleBox2> join_table_set(std::size_t count, std::uint32_t seed) {
  constexpr double world = 10'000;
  std::vector<DoubleBox2> boxes(count);
  for (std::uint32_t axis = 0; axis < 2; ++axis) {
    LegacyNumpy random(seed + axis);
    for (DoubleBox2& box : boxes) {
      const double low = random.fraction() * world;
      box.min[axis] = with_two_decimals(low);
      box.max[axis] = with_two_decimals(low + 1);
    }
  }
  return boxes;
}

namespace generated {
namespace {

std::vector<Box2> make_join_table(const Settings& settings, std::size_t count, std::uint64_t) {
  const bool is_left = settings.text("set") == "left";
  std::vector<Box2> boxes(count);
  const std::vector<DoubleBox2> exact = join_table_set(count, is_left ? join_table_left : join_table_right);
  for (std::size_t i = 0; i < count; ++i) {
    for (int axis = 0; axis < 2; ++axis) {
      boxes[i].min[axis] = static_cast<float>(exact[i].min[axis]);
      boxes[i].max[axis] = static_cast<float>(exact[i].max[axis]);
    }
  }
  return boxes;
}

}  // namespace

Scene join_table() {
  return {
      .name = "join_table",
      .summary =
          "a set of SwiftSpatial's uniform boxes: of side 1 in a world of 10,000^2; bench/join_table joins "
          "two",
      .source = "Jiang et al., SwiftSpatial, SIGMOD 2025: data_gen.py",
      .tunables = {{.name = "set",
                    .summary = "which of the two sets that are joined",
                    .default_value = "left",
                    .type = Tunable::Type::choice,
                    .choices = {"left", "right"}}},
      .boxes_2d = make_join_table,
      .fixed_seed = true,
      .hard = true,
  };
}

}  // namespace generated
}  // namespace broadside::lab
