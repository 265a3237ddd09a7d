// Boxes of doubles, followed by their floats.
#include "double_follower.hpp"

#include "core/candidate_sink.hpp"

namespace broadside::own {

template <int D>
void DoubleFollower<D>::update_valid(const Change<D, double>& change, PairSink& begun, PairSink& ended) {
  if (change.rebuild || !grid_) start(change);
  before_.resize(change.now.size(), absent_box<D>());
  now_.resize(change.now.size(), absent_box<D>());
  for (const BoxId id : change.changed) now_[index(id)] = rounded(change.now[index(id)]);
  core::CandidateSink<D, double> candidates(change, begun, ended);
  Statistics statistics = grid_->candidates({.before = before_,
                                             .now = now_,
                                             .changed = change.changed,
                                             .flags = change.flags,
                                             .rebuild = change.rebuild},
                                            candidates);
  candidates.flush();
  statistics.hits = candidates.count();
  for (const BoxId id : change.changed) before_[index(id)] = now_[index(id)];
  this->count(statistics);
}

/// Rounds all boxes of the frame before, in a way that suits this one.
template <int D>
void DoubleFollower<D>::start(const Change<D, double>& change) {
  fit_ = core::fit_linear<D>(change.now);
  by_quantiles_ = core::makes_false_pairs<D>(fit_, change.now, 0);
  quantiles_ = by_quantiles_ ? core::fit_quantiles<D>(change.now) : std::array<core::QuantileRounding, D>{};
  grid_ = std::make_unique<HierarchicalGridTracker<D>>();
  before_.resize(change.before.size());
  for (std::size_t i = 0; i < before_.size(); ++i) before_[i] = rounded(change.before[i]);
  now_ = before_;
}

template <int D>
Box<D> DoubleFollower<D>::rounded(const Box<D, double>& box) const {
  if (!is_present(box)) return absent_box<D>();
  if (by_quantiles_)
    return core::rounded(
        box, [&](int axis) -> const auto& { return quantiles_[axis]; });
  return core::rounded(
      box, [&](int axis) -> const auto& { return fit_[axis].rounding; });
}

template <int D>
std::size_t DoubleFollower<D>::algorithm_bytes() const noexcept {
  std::size_t bytes = (before_.capacity() + now_.capacity()) * sizeof(Box<D>);
  for (const core::QuantileRounding& rounding : quantiles_) bytes += rounding.bytes();
  return bytes + (grid_ ? grid_->kept_bytes() : 0);
}

template class DoubleFollower<2>;
template class DoubleFollower<3>;

}  // namespace broadside::own
