// Sweep and prune as section IV of paper.md has it: Algorithms 5 and 6, along the x axis. What was mended,
// and why, is in docs/paper/errata.md.
#include <algorithm>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "broadside/broad_phase.hpp"
#include "broadside/outline.hpp"

#include "paper/listings/descriptions.hpp"

namespace broadside::paper {
namespace {

template <int D>
class SweepAndPrune final : public PairFinder<D>, public Outlined<D> {
 public:
  Outlined<D>* outlined() noexcept override { return this; }

 private:
  void find_valid(std::span<const Box<D>> boxes, PairSink& pairs) override {
    boxes_ = boxes;
    statistics_ = {.references = boxes.size()};
    e_.clear();
    for (std::size_t i = 0; i < boxes.size(); ++i) e_.push_back(BoxId(i));
    algorithm_5_sweep(e_, pairs);
    this->count(statistics_);
  }

  Outline<D> lay_out(std::span<const Box<D>>) override {
    Box<D> all;
    all.min.fill(-std::numeric_limits<float>::infinity());
    all.max.fill(std::numeric_limits<float>::infinity());
    return {.kind = "sweep", .caption = "one sweep along x", .swept_axis = 0, .levels = {{all}}};
  }

  /// Algorithm 5, "Sweep".
  void algorithm_5_sweep(std::vector<BoxId>& e, PairSink& pairs) {
    std::sort(e.begin(), e.end(), [this](BoxId a, BoxId b) {  // Erratum 5b
      return std::pair(min_x(a), a) < std::pair(min_x(b), b);
    });
    std::vector<BoxId>& f = active_;
    f.clear();                                    // Erratum 5d
    for (std::size_t i = 0; i < e.size(); ++i) {  // Erratum 5a
      algorithm_6_prune(f, e[i]);
      for (const BoxId active : f) test_collide(active, e[i], pairs);  // Erratum 5c
      f.push_back(e[i]);
    }
  }

  /// Algorithm 6, "Prune".
  void algorithm_6_prune(std::vector<BoxId>& f, BoxId e) const {
    for (std::size_t i = 0; i < f.size();) {  // Erratum 6a
      if (max_x(f[i]) < min_x(e)) {
        f[i] = f.back();  // Erratum 6b: what now stands at place i has not been looked at
        f.pop_back();
      } else {
        ++i;
      }
    }
  }

  void test_collide(BoxId a, BoxId b, PairSink& pairs) {
    ++statistics_.tests;
    if (overlap(boxes_[index(a)], boxes_[index(b)])) pairs.add(a, b);
  }

  float min_x(BoxId e) const { return boxes_[index(e)].min[0]; }
  float max_x(BoxId e) const { return boxes_[index(e)].max[0]; }

  std::span<const Box<D>> boxes_;
  std::vector<BoxId> e_;
  std::vector<BoxId> active_;
  Statistics statistics_;
};

}  // namespace

Algorithm sweep_and_prune() {
  return {
      .name = "paper_sweep_and_prune",
      .summary = "one sweep along the x axis with an active list, as the paper lists it, mended",
      .source = "paper.md, section IV, Algorithms 5 and 6",
      .kind = AlgorithmKind::paper,
      .finder_2d = [](const Settings&) { return std::make_unique<SweepAndPrune<2>>(); },
      .finder_3d = [](const Settings&) { return std::make_unique<SweepAndPrune<3>>(); },
  };
}

}  // namespace broadside::paper
