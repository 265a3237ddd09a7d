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
    run_.clear();
    run_.reserve(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) run_.append(boxes[i], BoxId(i));
    this->count({.tests = kernels::compare_all(run_.view(), pairs), .references = boxes.size()});
  }

  kernels::RunBuffer<D> run_;
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
