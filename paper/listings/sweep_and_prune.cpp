// The paper's sweep and prune as an algorithm: its finder, and its description.
#include <limits>
#include <memory>
#include <vector>

#include "broadside/debug/outline.hpp"
#include "broadside/finder.hpp"
#include "broadside/tracker.hpp"

#include "paper/listings/coherent_tracker.hpp"
#include "paper/listings/descriptions.hpp"
#include "paper/listings/listing_finder.hpp"
#include "paper/listings/sweep_listing.hpp"
#include "paper/listings/trackers.hpp"

namespace broadside::paper {
namespace {

template <int D>
class SweepAndPrune final : public ListingFinder<D>, public Outlined<D> {
 public:
  Outlined<D>* outlined() noexcept override { return this; }

 private:
  void find_listed(std::span<const Box<D>> boxes, PairSink& pairs, Checkpoint& checkpoint) override {
    SweepListing<D>::sort(boxes, e_);
    this->count(listing_.algorithm_5_sweep(boxes, e_.size(), pairs, checkpoint,
                                           [next = e_.begin()]() mutable { return (next++)->id; }));
  }

  Outline<D> lay_out(std::span<const Box<D>>) override {
    Box<D> all;
    all.min.fill(-std::numeric_limits<float>::infinity());
    all.max.fill(std::numeric_limits<float>::infinity());
    return {.kind = "sweep", .caption = "one sweep along x", .swept_axis = 0, .levels = {{all}}};
  }

  SweepListing<D> listing_;
  std::vector<SweepEntry> e_;
};

}  // namespace

Algorithm sweep_and_prune() {
  return {
      .name = "paper_sweep_and_prune",
      .summary = "one sweep along the x axis with an active list, as the paper lists it, mended",
      .source = "paper.md, sections IV (Algorithms 5 and 6) and VI-C",
      .kind = AlgorithmKind::paper,
      .tunables = {{.name = "update",
                    .summary =
                        "how a tracker mends its order before it sweeps: sorted anew; a heap, from which "
                        "minima are taken as the sweep goes; insertion sort; or a binary search for the "
                        "place of each mover",
                    .standard = "rebuild",
                    .type = Tunable::Type::choice,
                    .choices = {"rebuild", "heap", "insertion", "binary"}},
                   detect_tunable()},
      .finder_2d = [](const Settings&) { return std::make_unique<SweepAndPrune<2>>(); },
      .finder_3d = [](const Settings&) { return std::make_unique<SweepAndPrune<3>>(); },
      .tracker_2d = make_sweep_tracker<2>,
      .tracker_3d = make_sweep_tracker<3>,
  };
}

}  // namespace broadside::paper
