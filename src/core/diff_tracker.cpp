// DiffTracker: all pairs found in each frame, and compared with those of the frame before.
#include <stdexcept>
#include <utility>

#include "broadside/pair_tracker.hpp"
#include "broadside/sinks.hpp"

namespace broadside {

template <int D, typename Real>
DiffTracker<D, Real>::DiffTracker(std::unique_ptr<PairFinder<D, Real>> finder) : finder_(std::move(finder)) {
  if (!finder_) throw std::invalid_argument("DiffTracker was given a null finder; expected a finder");
  this->set_workers(finder_->workers());
}

template <int D, typename Real>
void DiffTracker<D, Real>::update_valid(const Change<D, Real>& change, PairSink& begun, PairSink& ended) {
  const auto find = [this](std::span<const Box<D, Real>> boxes, std::vector<Pair>& pairs) {
    pairs.clear();
    PairCollector collector(pairs);
    finder_->find(boxes, collector);
  };
  if (change.rebuild) find(change.before, pairs_);
  find(change.now, found_);
  // Events need no search in the stored pairs: what a pair was in the other frame can be seen from its boxes;
  // and of two boxes that rested nothing has to be asked.
  const auto report = [&](Pair pair) {
    if ((change.flags[index(pair.first)] | change.flags[index(pair.second)]) != 0)
      change.report(pair.first, pair.second, begun, ended);
  };
  for (const Pair pair : found_) report(pair);
  for (const Pair pair : pairs_) report(pair);
  std::swap(pairs_, found_);
  this->count(finder_->statistics());
}

template class DiffTracker<2, float>;
template class DiffTracker<2, double>;
template class DiffTracker<3, float>;
template class DiffTracker<3, double>;

}  // namespace broadside
