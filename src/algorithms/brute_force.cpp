// Brute force: every box against every later one. Section II of the paper; the reference for all others.
#include <memory>

#include "broadside/broad_phase.hpp"

#include "algorithms/descriptions.hpp"
#include "kernels/sweep.hpp"

namespace broadside::own {
namespace {

template <int D>
class BruteForce final : public PairFinder<D> {
 private:
  void find_valid(std::span<const Box<D>> boxes, PairSink& pairs) override {
    const std::size_t left = this->left_count();
    gather(boxes, left, boxes.size(), run_);
    Statistics statistics{.tests = 0, .references = boxes.size()};
    if (left == 0) {
      statistics.tests = kernels::compare_all(run_.view(), pairs);
    } else {
      gather(boxes, 0, left, left_run_);
      statistics.tests = kernels::compare_all(left_run_.view(), run_.view(), pairs);
    }
    this->count(statistics);
  }

  static void gather(std::span<const Box<D>> boxes, std::size_t begin, std::size_t end,
                     kernels::RunBuffer<D>& run) {
    run.clear();
    run.reserve(end - begin);
    for (std::size_t i = begin; i < end; ++i) run.append(boxes[i], BoxId(i));
  }

  kernels::RunBuffer<D> run_;  // all boxes, or the right set
  kernels::RunBuffer<D> left_run_;
};

}  // namespace

Algorithm brute_force() {
  return {
      .name = "brute_force",
      .summary = "every box against every other, over a structure of arrays",
      .source = "paper.md, section II",
      .finder_2d = [](const Settings&) { return std::make_unique<BruteForce<2>>(); },
      .finder_3d = [](const Settings&) { return std::make_unique<BruteForce<3>>(); },
  };
}

}  // namespace broadside::own
