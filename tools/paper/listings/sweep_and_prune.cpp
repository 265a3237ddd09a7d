// The paper's sweep and prune as an algorithm: its searcher, its outline, and its description.
#include <limits>
#include <vector>

#include "broadside/debug/outline.hpp"
#include "broadside/searcher.hpp"

#include "paper/listings/coherent_follower.hpp"
#include "paper/listings/followers.hpp"
#include "paper/listings/listing_searcher.hpp"
#include "paper/listings/registry.hpp"
#include "paper/listings/sweep_listing.hpp"

namespace broadside::paper {
namespace {

template <int D>
class SweepAndPrune final : public ListingSearcher<D> {
 private:
  Statistics search_listed(std::span<const Box<D>> boxes, PairSink& pairs, Checkpoint& checkpoint) override {
    SweepListing<D>::sort(boxes, e_);
    this->end_phase(&Phases::adding_ms);
    return listing_.algorithm_5_sweep(boxes, e_.size(), pairs, checkpoint,
                                      [next = e_.begin()]() mutable { return (next++)->id; });
  }

  SweepListing<D> listing_;
  std::vector<SweepEntry> e_;
};

template <int D>
Outline<D> sweep_outline(std::span<const Box<D>>, const Workers&, const Settings&) {
  Box<D> all;
  all.min.fill(-std::numeric_limits<float>::infinity());
  all.max.fill(std::numeric_limits<float>::infinity());
  return {.kind = "sweep", .caption = "one sweep along x", .swept_axis = 0, .levels = {{all}}};
}

template <int D>
Strategies<D> sweep_strategies() {
  return {.searcher = make_strategy<SweepAndPrune<D>>,
          .followers = {{.name = "paper_sweep_and_prune", .make = make_sweep_follower<D>}},
          .outline = sweep_outline<D>};
}

}  // namespace

Algorithm sweep_and_prune() {
  return {
      .name = "paper_sweep_and_prune",
      .summary = "one sweep along the x axis with an active list, as the paper lists it, mended",
      .source = "paper.md, sections IV (Algorithms 5 and 6) and VI-C",
      .kind = AlgorithmKind::paper,
      .tunables = {{.name = "update",
                    .summary =
                        "how a tracker mends its order before it sweeps: sorted anew; gone through for "
                        "each mover and its new place; a heap, from which minima are taken as the sweep "
                        "goes; insertion sort; or a binary search for the place of each mover",
                    .default_value = "rebuild",
                    .type = Tunable::Type::choice,
                    .choices = {"rebuild", "search_delete_reinsert", "heap", "insertion", "binary"}},
                   detect_tunable()},
      .in_2d = sweep_strategies<2>(),
      .in_3d = sweep_strategies<3>(),
  };
}

}  // namespace broadside::paper
