// Brute force: every box against every later one. Section II of the paper; the reference for all others.
#include <algorithm>

#include "broadside/algorithm.hpp"

#include "algorithms/follow_costs.hpp"
#include "algorithms/followers.hpp"
#include "algorithms/registry.hpp"
#include "core/parallel.hpp"
#include "core/tunables.hpp"
#include "kernels/sweep.hpp"

namespace broadside::algorithm {
namespace {

/// Parallel measures work in boxes of other algorithms: this many tests take as long as one.
constexpr std::size_t tests_costing_one_box = 128;

/// Boxes that a worker compares with all others at a time.
constexpr std::size_t rows_at_once = 64;

template <int D>
class BruteForceSearcher final : public Searcher<D> {
 public:
  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) override {
    const std::span<const Box<D>> boxes = input.boxes;
    const std::size_t left = input.left_count;
    gather(boxes, left, boxes.size(), run_);
    gather(boxes, 0, left, left_run_);
    const kernels::Run<D> run = run_.view(input.doubles);
    const kernels::Run<D> left_run = left_run_.view(input.doubles);
    const std::size_t rows = left == 0 ? run.size : left;
    parallel_.start(input.workers, rows * run.size / tests_costing_one_box);
    const auto compare = [&](core::Range some, std::size_t worker, PairSink& sink) {
      const std::size_t begin = some.begin * rows_at_once;
      const std::size_t end = std::min(some.end * rows_at_once, rows);
      kernels::Run<D> some_rows =
          kernels::rows_of(left == 0 ? run : left_run, begin, end, parallel_.checkpoint(worker));
      if (left == 0) return Statistics{.tests = kernels::compare_all(some_rows, sink)};
      some_rows.size = end - begin;
      return Statistics{.tests = kernels::compare_all(some_rows, run, sink)};
    };
    Statistics statistics = parallel_.search((rows + rows_at_once - 1) / rows_at_once, pairs, compare);
    statistics.references = boxes.size();
    return statistics;
  }

 private:
  static void gather(std::span<const Box<D>> boxes, std::size_t begin, std::size_t end,
                     kernels::RunBuffer<D>& run) {
    run.clear();
    run.reserve(end - begin);
    for (std::size_t i = begin; i < end; ++i) run.append(boxes[i], BoxId(i));
  }

  core::Parallel parallel_;
  kernels::RunBuffer<D> run_;  // all boxes, or the right set
  kernels::RunBuffer<D> left_run_;
};

template <int D>
Strategies<D> brute_force_strategies() {
  return {.searcher = make_strategy<BruteForceSearcher<D>>,
          .followers = {{"brute_force", make_brute_force_follower<D>, brute_force_following, 1}},
          .find_costs = brute_force_finding};
}

}  // namespace

Algorithm brute_force() {
  return {
      .name = "brute_force",
      .summary = "every box against every other, over a structure of arrays",
      .source = "paper.md, sections II and VI-A",
      .tunables = {core::update_tunable(), core::threads_tunable()},
      .in_2d = core::in_dimension<2, brute_force_strategies<2>>(),
      .in_3d = core::in_dimension<3, brute_force_strategies<3>>(),
      .tests_doubles = true,
      .gives_candidates = true,
  };
}

}  // namespace broadside::algorithm
