// IncrementalTracker: the choice between following what changed and finding all pairs anew.
#include "interface/incremental_tracker.hpp"

#include <algorithm>
#include <utility>

namespace broadside::core {
namespace {

/// The other way is taken when it would have saved so much of a search. Coming back costs about one.
constexpr double patience = 0.5;

}  // namespace

template <int D>
IncrementalTracker<D>::IncrementalTracker(Way way, double worthwhile, std::unique_ptr<PairFinder<D>> finder)
    : way_(way), worthwhile_(worthwhile), rebuilt_(std::move(finder)), is_rebuilding_(way == Way::rebuild) {}

template <int D>
void IncrementalTracker<D>::update_valid(const Change<D>& change, PairSink& begun, PairSink& ended) {
  Change<D> seen = change;
  const bool was_rebuilding = is_rebuilding_;
  if (way_ == Way::choose) choose(change);
  seen.rebuild |= !std::exchange(has_kept_, false) || is_rebuilding_ != was_rebuilding;
  if (is_rebuilding_)
    this->update_with(rebuilt_, seen, begun, ended);
  else
    follow(seen, begun, ended);
  has_kept_ = true;
}

template <int D>
void IncrementalTracker<D>::choose(const Change<D>& change) {
  changed_ = change.changed.size();
  count_ = change.now.size();
  if (count_ == 0) return;
  // What following costs, in searches.
  const double cost = static_cast<double>(changed_) / (worthwhile_ * static_cast<double>(count_));
  if (change.rebuild) {
    is_rebuilding_ = cost > 1;
    debt_ = 0;
    return;
  }
  debt_ = std::max(0.0, debt_ + (is_rebuilding_ ? 1 - cost : cost - 1));
  if (debt_ < patience) return;
  is_rebuilding_ = !is_rebuilding_;
  debt_ = 0;
}

template <int D>
std::size_t IncrementalTracker<D>::take_sample(std::span<const Box<D>> boxes, Sample<D>& sample,
                                               std::vector<Box<D>>& sampled) {
  constexpr std::size_t most = 256;
  sampled.clear();
  const auto take = [&](const Box<D>& box) {
    if (is_present(box)) sampled.push_back(box);
  };
  std::size_t looks = 0;
  if (boxes.size() <= 4 * most) {
    for (; looks < boxes.size(); ++looks) take(boxes[looks]);
  } else {
    for (; looks < 4 * most && sampled.size() < most; ++looks)
      take(boxes[sampled_place(looks, boxes.size())]);
  }
  sample.take(sampled);
  return looks == 0 ? 0 : boxes.size() * sampled.size() / looks;
}

template <int D>
std::string IncrementalTracker<D>::explanation() const {
  if (way_ != Way::choose) return {};
  return (is_rebuilding_ ? "all pairs anew: " : "followed: ") + std::to_string(changed_) + " of " +
         std::to_string(count_) + " boxes changed";
}

template class IncrementalTracker<2>;
template class IncrementalTracker<3>;

}  // namespace broadside::core
