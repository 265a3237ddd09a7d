// PairTracker: what every tracker does around its algorithm; and DiffTracker.
#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "broadside/broad_phase.hpp"
#include "broadside/error.hpp"
#include "broadside/sinks.hpp"

#include "core/input_check.hpp"

namespace broadside {
namespace {

void deliver(std::vector<Pair>& events, PairSink& sink) {
  std::sort(events.begin(), events.end());
  for (const Pair pair : events) sink.add(pair.first, pair.second);
  sink.flush();
}

}  // namespace

template <int D, typename Real>
void PairTracker<D, Real>::update(const Frame<D, Real>& frame, PairSink& begun, PairSink& ended) {
  const std::span<const Box<D, Real>> boxes = frame.boxes;
  const std::size_t known = before_.size();
  const std::size_t size = std::max(boxes.size(), known);

  // Everything that can be wrong with the frame, before anything changes. A box beyond the ones known is new
  // and counts as listed; after a failed update every box does. The first wrong one is named, whatever the
  // order of the list.
  core::check_count(boxes.size());
  std::size_t first = dirty_ ? 0 : std::min(known, boxes.size());
  for (const BoxId id : frame.changed) {
    if (index(id) >= size) {
      throw InvalidInput(index(id), "changed box " + std::to_string(index(id)) + " of a frame of " +
                                        std::to_string(boxes.size()) +
                                        " boxes; expected a place in this frame or the last");
    }
    if (index(id) < first && !is_present(boxes[index(id)]) && !is_absent(boxes[index(id)])) first = index(id);
  }
  core::check_boxes(boxes, first);

  const bool rebuild = std::exchange(dirty_, true);  // until the end of this update
  before_.resize(size, absent_box<D, Real>());
  now_.resize(size, absent_box<D, Real>());
  changed_.clear();
  flags_.assign(size, 0);
  const auto take = [&](std::size_t i) {
    if (flags_[i] != 0) return;
    flags_[i] = 1;
    changed_.push_back(BoxId(i));
    now_[i] = i < boxes.size() ? boxes[i] : absent_box<D, Real>();
  };
  if (rebuild) {
    for (std::size_t i = 0; i < size; ++i) take(i);
  } else {
    for (const BoxId id : frame.changed) take(index(id));
    for (std::size_t i = std::min(known, boxes.size()); i < size; ++i) take(i);
  }

  begun_.clear();
  ended_.clear();
  PairCollector begun_pairs(begun_);
  PairCollector ended_pairs(ended_);
  statistics_.reset();
  update_valid({before_, now_, changed_, flags_, rebuild}, begun_pairs, ended_pairs);
  begun_pairs.flush();
  ended_pairs.flush();
  try {
    deliver(begun_, begun);
    deliver(ended_, ended);
  } catch (...) {
    begun.discard();
    ended.discard();
    throw;
  }

  before_.resize(boxes.size());
  now_.resize(boxes.size());
  for (const BoxId id : changed_) {
    if (index(id) < boxes.size()) before_[index(id)] = now_[index(id)];
  }
  dirty_ = false;
}

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
  // Events need no search in the stored pairs: a pair of this frame began unless its boxes overlapped before,
  // and one of the frame before ended unless they overlap now; and neither can be said of two boxes that
  // rested.
  const auto differs = [&change](Pair pair, std::span<const Box<D, Real>> boxes) {
    const std::uint32_t a = index(pair.first);
    const std::uint32_t b = index(pair.second);
    if ((change.flags[a] | change.flags[b]) == 0) return false;
    return !is_present(boxes[a]) || !is_present(boxes[b]) || !overlap(boxes[a], boxes[b]);
  };
  if (change.rebuild) find(change.before, pairs_);
  find(change.now, found_);
  for (const Pair pair : found_) {
    if (differs(pair, change.before)) begun.add(pair.first, pair.second);
  }
  for (const Pair pair : pairs_) {
    if (differs(pair, change.now)) ended.add(pair.first, pair.second);
  }
  std::swap(pairs_, found_);
  this->count(finder_->statistics());
}

template class PairTracker<2, float>;
template class PairTracker<2, double>;
template class PairTracker<3, float>;
template class PairTracker<3, double>;
template class DiffTracker<2, float>;
template class DiffTracker<2, double>;
template class DiffTracker<3, float>;
template class DiffTracker<3, double>;

}  // namespace broadside
