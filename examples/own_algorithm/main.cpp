// Adds your own broad phase to the program: a sweep over the first axis, which all verbs know as "mine".
#include <algorithm>
#include <cstdint>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include <broadside/broadside.hpp>
#include <broadside/program.hpp>

namespace {

template <int D>
class FirstAxisSweep final : public broadside::Searcher<D> {
 public:
  explicit FirstAxisSweep(const broadside::Settings& settings)
      : touching_counts_(settings.text("touching") == "yes") {}

  // An algorithm only has to implement this. The boxes are valid and none is absent. The pairs may come in
  // any order that depends only on the boxes.
  std::optional<broadside::Statistics> search(const broadside::SearchInput<D>& input,
                                              broadside::PairSink& pairs) override {
    const auto boxes = input.boxes;
    order_.resize(boxes.size());
    std::iota(order_.begin(), order_.end(), 0U);
    std::ranges::sort(order_, {}, [&](std::uint32_t i) { return std::pair(boxes[i].min[0], i); });
    broadside::Statistics done{.references = boxes.size()};
    for (auto a = order_.begin(); a != order_.end(); ++a) {
      const float end = boxes[*a].max[0];
      for (auto b = a + 1; b != order_.end() && boxes[*b].min[0] <= end; ++b) {
        if (boxes[*b].min[0] == end && !touching_counts_) break;
        ++done.tests;
        if (overlap(boxes[*a], boxes[*b])) pairs.add(broadside::BoxId{*a}, broadside::BoxId{*b});
      }
    }
    return done;
  }

 private:
  bool touching_counts_;
  std::vector<std::uint32_t> order_;  // kept between calls to reuse its memory
};

broadside::Algorithm mine() {
  return {
      .name = "mine",
      .summary = "boxes sorted along the first axis, each compared with those that start before it ends",
      .source = "examples/own_algorithm",
      // Can be set in a spec: mine:touching=no. Pairs are then missing, which shows how `verify` reports an
      // error.
      .tunables = {{.name = "touching",
                    .summary =
                        "whether boxes that touch on the first axis overlap; they do, so `no` is a fault",
                    .default_value = "yes",
                    .type = broadside::Tunable::Type::choice,
                    .choices = {"yes", "no"}}},
      .in_2d = {.searcher = broadside::make_strategy<FirstAxisSweep<2>>},
      .in_3d = {.searcher = broadside::make_strategy<FirstAxisSweep<3>>},
  };
}

}  // namespace

int main(int count, char** values) { return broadside::run_program(count, values, {mine()}); }
