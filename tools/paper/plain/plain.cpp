// Common parts of the plain searches, and the library's searches restricted to an instruction set.
#include "paper/plain/plain.hpp"

#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "broadside/executor.hpp"
#include "broadside/searcher.hpp"

namespace broadside::plain {
namespace {

/// A search of the library by its name.
template <int D>
std::unique_ptr<Searcher<D>> searcher_called(const std::string& name) {
  const Algorithm& algorithm = *find_algorithm(name);
  return algorithm.in<D>().searcher(Settings(Spec(name), algorithm.tunables));
}

template <int D>
class HeldBack final : public Searcher<D> {
 public:
  explicit HeldBack(const Settings& settings)
      : instruction_set_(settings.text("simd")), searcher_(searcher_called<D>(settings.text("search"))) {}

  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) override {
    limit_instruction_set(instruction_set_);
    const std::optional<Statistics> statistics = searcher_->search(input, pairs);
    limit_instruction_set("");
    return statistics;
  }

 private:
  std::string instruction_set_;
  std::unique_ptr<Searcher<D>> searcher_;
};

}  // namespace

std::vector<Algorithm> algorithms() { return {plain_grid(), plain_bvh(), held_back()}; }

Algorithm held_back() {
  return {.name = "held_back",
          .summary = "a search of the library, held to an instruction set",
          .source = "for the paper's ablation",
          .kind = AlgorithmKind::literature,
          .tunables = {{.name = "search",
                        .summary = "which",
                        .default_value = "grid",
                        .type = Tunable::Type::choice,
                        .choices = {"grid", "bvh", "brute_force"}},
                       {.name = "simd",
                        .summary = "the instruction set",
                        .default_value = instruction_set(),
                        .type = Tunable::Type::choice,
                        .choices = instruction_sets()}},
          .in_2d = {.searcher = make_strategy<HeldBack<2>>},
          .in_3d = {.searcher = make_strategy<HeldBack<3>>}};
}

Tunable switch_tunable(std::string name, std::string summary) {
  return {.name = std::move(name),
          .summary = std::move(summary),
          .default_value = "yes",
          .type = Tunable::Type::choice,
          .choices = {"yes", "no"}};
}

template <int D>
int Shape<D>::best_axis() const {
  int best = 0;
  for (int axis = 1; axis < D; ++axis) {
    if (extent[axis] * (high[best] - low[best]) < extent[best] * (high[axis] - low[axis])) best = axis;
  }
  return best;
}

template <int D>
Shape<D> shape_of(std::span<const Box<D>> boxes, bool sampled) {
  constexpr std::size_t sample = 256;
  const std::size_t step = sampled ? std::max<std::size_t>(1, boxes.size() / sample) : 1;
  Shape<D> shape;
  shape.low.fill(std::numeric_limits<float>::max());
  shape.high.fill(std::numeric_limits<float>::lowest());
  std::array<double, D> sums{};
  double count = 0;
  for (std::size_t i = 0; i < boxes.size(); i += step) {
    ++count;
    for (int axis = 0; axis < D; ++axis) {
      shape.low[axis] = std::min(shape.low[axis], boxes[i].min[axis]);
      shape.high[axis] = std::max(shape.high[axis], boxes[i].max[axis]);
      sums[axis] += static_cast<double>(boxes[i].max[axis]) - boxes[i].min[axis];
    }
  }
  for (int axis = 0; axis < D; ++axis) {
    shape.extent[axis] = static_cast<float>(sums[axis] / std::max(count, 1.0));
    if (!sampled) continue;
    const float more = shape.high[axis] / 16 - shape.low[axis] / 16;  // a sample misses the extremes
    shape.low[axis] -= more;
    shape.high[axis] += more;
  }
  return shape;
}

template struct Shape<2>;
template struct Shape<3>;
template Shape<2> shape_of(std::span<const Box2>, bool);
template Shape<3> shape_of(std::span<const Box3>, bool);

}  // namespace broadside::plain
