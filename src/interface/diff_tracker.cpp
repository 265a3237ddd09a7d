// DiffTracker: all pairs found in each frame, and compared with those of the frame before.
#include <stdexcept>
#include <utility>
#include <vector>

#include "broadside/sinks.hpp"
#include "broadside/tracker.hpp"

#include "core/parallel.hpp"
#include "interface/pair_difference.hpp"

namespace broadside {

template <int D, typename Real>
struct BROADSIDE_HIDDEN DiffTracker<D, Real>::Pairs {
  std::vector<Pair> kept;  // pairs that also overlapped in the frame before
  std::vector<Pair> found;
};

template <int D, typename Real>
DiffTracker<D, Real>::DiffTracker(std::unique_ptr<PairFinder<D, Real>> finder)
    : finder_(std::move(finder)), pairs_(std::make_unique<Pairs>()) {
  if (!finder_) throw std::invalid_argument("DiffTracker was given a null finder; expected a finder");
  this->set_workers(finder_->workers());
}

template <int D, typename Real>
DiffTracker<D, Real>::~DiffTracker() = default;

template <int D, typename Real>
std::size_t DiffTracker<D, Real>::algorithm_bytes() const noexcept {
  return (pairs_->kept.capacity() + pairs_->found.capacity()) * sizeof(Pair);
}

template <int D, typename Real>
void DiffTracker<D, Real>::update_valid(const Change<D, Real>& change, PairSink& begun, PairSink& ended) {
  const auto find = [this](std::span<const Box<D, Real>> boxes, std::vector<Pair>& pairs) {
    pairs.clear();
    PairCollector collector(pairs);
    finder_->find(boxes, collector);
  };
  if (change.rebuild) find(change.before, pairs_->kept);
  find(change.now, pairs_->found);
  core::Parallel parallel;
  core::report_differences<D, Real>(change, pairs_->found, pairs_->kept, this->workers(), parallel, begun,
                                    ended);
  std::swap(pairs_->kept, pairs_->found);
  this->count(finder_->statistics());
}

template class DiffTracker<2, float>;
template class DiffTracker<2, double>;
template class DiffTracker<3, float>;
template class DiffTracker<3, double>;

}  // namespace broadside
