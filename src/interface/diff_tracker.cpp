// DiffTracker: all pairs found in each frame, and compared with those of the frame before.
#include <stdexcept>
#include <utility>

#include "broadside/sinks.hpp"
#include "broadside/tracker.hpp"

#include "core/parallel.hpp"
#include "interface/pair_difference.hpp"

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
  core::Parallel parallel;
  core::report_differences<D, Real>(change, found_, pairs_, this->workers(), parallel, begun, ended);
  std::swap(pairs_, found_);
  this->count(finder_->statistics());
}

template class DiffTracker<2, float>;
template class DiffTracker<2, double>;
template class DiffTracker<3, float>;
template class DiffTracker<3, double>;

}  // namespace broadside
