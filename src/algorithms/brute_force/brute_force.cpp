// Brute force: every box against every later one. Section II of the paper; the reference for all others.
#include <algorithm>

#include "broadside/algorithm.hpp"

#include "algorithms/follow_costs.hpp"
#include "algorithms/followers.hpp"
#include "algorithms/registry.hpp"
#include "core/parallel.hpp"
#include "core/tunables.hpp"
#include "kernels/few_boxes.hpp"
#include "kernels/observed_tests.hpp"
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
    if (boxes.size() <= kernels::max_few_boxes) {
      if (compare_few(input, pairs)) return few_statistics(boxes.size(), left);
      if (input.may_refuse) {
        input.successor->finish([](const Box<D>&, BoxId, const Box<D>&, BoxId) { return true; });
        return Statistics{};
      }
    }
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
  /// False, and nothing is written, if bytes do not suit the boxes.
  bool compare_few(const SearchInput<D>& input, PairSink& pairs) {
    parallel_.start(input.workers, 0);  // fewer than a thread is worth
    bool is_done = false;
    parallel_.search(1, pairs, [&](core::Range, std::size_t worker, PairSink& sink) {
      is_done = kernels::compare_few(input.boxes, input.left_count, input.doubles, sink);
      if (is_done && parallel_.checkpoint(worker) != nullptr)
        parallel_.checkpoint(worker)->count(few_statistics(input.boxes.size(), input.left_count).tests);
      return Statistics{};
    });
    if constexpr (kernels::is_observing) {
      const std::size_t rows = input.left_count == 0 ? input.boxes.size() : input.left_count;
      for (std::size_t i = 0; i < rows && is_done; ++i) {
        for (std::size_t j = std::max(i + 1, input.left_count); j < input.boxes.size(); ++j)
          kernels::observe_test(BoxId(i), BoxId(j));
      }
    }
    return is_done;
  }

  static Statistics few_statistics(std::size_t boxes, std::size_t left) {
    return {.tests = left == 0 ? boxes * (boxes - 1) / 2 : left * (boxes - left), .references = boxes};
  }

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
