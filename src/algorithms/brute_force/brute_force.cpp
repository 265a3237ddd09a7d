// Brute force: every box against every later one. Section II of the paper; the reference for all others.
#include <algorithm>
#include <memory>

#include "broadside/finder.hpp"
#include "broadside/tracker.hpp"

#include "algorithms/brute_force/tracker.hpp"
#include "algorithms/descriptions.hpp"
#include "core/dimensions.hpp"
#include "core/lean.hpp"
#include "core/parallel.hpp"
#include "interface/adaptive_tracker.hpp"
#include "interface/follow_costs.hpp"
#include "interface/last_test.hpp"
#include "kernels/sweep.hpp"

namespace broadside::algorithm {
namespace {

/// The work for a box in algorithms other than this one, in boxes compared.
constexpr std::size_t tests_per_box = 128;

/// Boxes that one thread compares with all others at a time.
constexpr std::size_t rows_at_once = 64;

template <int D>
class BruteForce final : public PairFinder<D>, public core::LastTest<D> {
 public:
  core::LastTest<D>* last_test() noexcept override { return this; }

 private:
  void find_valid(std::span<const Box<D>> boxes, PairSink& pairs) override {
    const std::size_t left = this->left_count();
    gather(boxes, left, boxes.size(), run_);
    gather(boxes, 0, left, left_run_);
    const kernels::Run<D> run = run_.view(this->doubles());
    const kernels::Run<D> left_run = left_run_.view(this->doubles());
    const std::size_t rows = left == 0 ? run.size : left;
    parallel_.start(this->workers(), rows * run.size / tests_per_box);
    const auto compare = [&](core::Range some, std::size_t worker, PairSink& sink) {
      const std::size_t begin = some.begin * rows_at_once;
      const std::size_t end = std::min(some.end * rows_at_once, rows);
      kernels::Run<D> some_rows = kernels::rows_of(left == 0 ? run : left_run, begin, end);
      some_rows.checkpoint = parallel_.checkpoint(worker);
      if (left == 0) return Statistics{.tests = kernels::compare_all(some_rows, sink)};
      some_rows.size = end - begin;
      return Statistics{.tests = kernels::compare_all(some_rows, run, sink)};
    };
    Statistics statistics = parallel_.search((rows + rows_at_once - 1) / rows_at_once, pairs, compare);
    statistics.references = boxes.size();
    this->count(statistics);
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
std::unique_ptr<PairFinder<D>> make_brute_force(const Settings&) {
  return std::make_unique<BruteForce<D>>();
}

template <int D>
std::unique_ptr<PairTracker<D>> make_brute_force_tracking(const Settings& settings) {
  return std::make_unique<core::AdaptiveTracker<D>>(
      core::update_of(settings), make_brute_force<D>(settings), core::brute_force_finding,
      std::vector<core::Follower<D, float>>{
          {"brute_force", make_brute_force_tracker<D>, core::brute_force_following}});
}

}  // namespace

Algorithm brute_force() {
  return {
      .name = "brute_force",
      .summary = core::unless_lean("every box against every other, over a structure of arrays"),
      .source = core::unless_lean("paper.md, sections II and VI-A"),
      .tunables = {core::update_tunable(), core::threads_tunable()},
      .finder_2d = core::in_dimension<2>(make_brute_force<2>),
      .finder_3d = core::in_dimension<3>(make_brute_force<3>),
      .tracker_2d = core::in_dimension<2>(make_brute_force_tracking<2>),
      .tracker_3d = core::in_dimension<3>(make_brute_force_tracking<3>),
  };
}

}  // namespace broadside::algorithm
