// A broad phase of one's own, a sweep over the first axis: put under the law on every scene, and into the
// comparison beside the library's grid.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include "broadside/broadside.hpp"

#include "lab/catalogue.hpp"
#include "lab/measure/compare.hpp"
#include "lab/report/table.hpp"
#include "lab/verify.hpp"

namespace {

using broadside::BoxId;

template <int D>
class FirstAxisSweep final : public broadside::PairFinder<D> {
 private:
  // All that an algorithm must do. The boxes are valid and none is absent; the pairs may come in any order.
  void find_valid(std::span<const broadside::Box<D>> boxes, broadside::PairSink& pairs) override {
    order_.resize(boxes.size());
    std::iota(order_.begin(), order_.end(), 0U);
    std::ranges::sort(order_, {}, [&](std::uint32_t i) { return std::pair(boxes[i].min[0], i); });
    broadside::Statistics done{.references = boxes.size()};
    for (auto a = order_.begin(); a != order_.end(); ++a) {
      for (auto b = a + 1; b != order_.end() && boxes[*b].min[0] <= boxes[*a].max[0]; ++b) {
        ++done.tests;
        if (overlap(boxes[*a], boxes[*b])) pairs.add(BoxId{*a}, BoxId{*b});
      }
    }
    this->count(done);
  }

  std::vector<std::uint32_t> order_;  // kept between calls for its memory
};

broadside::Algorithm first_axis_sweep() {
  return {
      .name = "first_axis_sweep",
      .summary = "boxes sorted along the first axis, each compared with those that start before it ends",
      .source = "examples/own_algorithm",
      .finder_2d = [](const broadside::Settings&) { return std::make_unique<FirstAxisSweep<2>>(); },
      .finder_3d = [](const broadside::Settings&) { return std::make_unique<FirstAxisSweep<3>>(); },
  };
}

/// Whether the algorithm gives exactly the right pairs and events on every scene of D dimensions.
template <int D>
bool keeps_the_law(const broadside::Algorithm& algorithm) {
  bool kept = true;
  for (const broadside::lab::Scene& scene : broadside::lab::scenes()) {
    if (!scene.has_dimension(D)) continue;
    const auto history = make_history<D>(scene, {scene.name, {}}, {.boxes = 300, .frames = 5});
    const auto tracker = make_tracker<D>(algorithm, {algorithm.name, {}});
    if (const auto divergence = broadside::lab::check_tracker<D>(*tracker, history, algorithm.name)) {
      std::printf("%s: %s\n", scene.name.c_str(), divergence->text.c_str());
      kept = false;
    }
  }
  return kept;
}

}  // namespace

int main() {
  broadside::lab::Catalogue catalogue;
  catalogue.add(first_axis_sweep());
  const broadside::lab::Comparison comparison = compare(
      catalogue, {.algorithms = "first_axis_sweep,grid",
                  .plan = {{"uniform", 2, 5'000}, {"one_line", 3, 5'000}},
                  .finished = [](const auto& result) { std::fputs(table_of(result).c_str(), stdout); }});
  const bool lawful = keeps_the_law<2>(first_axis_sweep()) && keeps_the_law<3>(first_axis_sweep());
  std::printf("first_axis_sweep is %s on every scene\n", lawful ? "right" : "not right");
  return lawful && comparison.all_verified() ? 0 : 1;
}
