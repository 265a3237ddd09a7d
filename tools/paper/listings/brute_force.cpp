// Brute force as in section II of paper.md: Algorithm 1 over all boxes. docs/paper/errata.md lists the
// corrections and their reasons.
#include <vector>

#include "broadside/searcher.hpp"

#include "kernels/observed_tests.hpp"
#include "paper/listings/algorithm_1.hpp"
#include "paper/listings/listing_searcher.hpp"
#include "paper/listings/registry.hpp"

namespace broadside::paper {
namespace {

template <int D>
class BruteForce final : public ListingSearcher<D> {
 private:
  Statistics search_listed(std::span<const Box<D>> boxes, PairSink& pairs, Checkpoint& checkpoint) override {
    e_.clear();
    for (std::size_t i = 0; i < boxes.size(); ++i) e_.push_back(BoxId(i));
    this->end_phase(&Phases::adding_ms);
    Statistics statistics{.references = e_.size()};
    algorithm_1_brute_force(e_, checkpoint, [&](BoxId a, BoxId b) {
      ++statistics.tests;
      if constexpr (kernels::is_observing) kernels::observe_test(a, b);
      if (overlap(boxes[index(a)], boxes[index(b)])) pairs.add(a, b);
    });
    return statistics;
  }

  std::vector<BoxId> e_;
};

}  // namespace

Algorithm brute_force() {
  return {
      .name = "paper_brute_force",
      .summary = "every box against every later one, as the paper lists it, mended",
      .source = "paper.md, section II, Algorithm 1",
      .kind = AlgorithmKind::paper,
      .in_2d = {.searcher = make_strategy<BruteForce<2>>},
      .in_3d = {.searcher = make_strategy<BruteForce<3>>},
  };
}

}  // namespace broadside::paper
