// FrameLog: the last frames of a history, in bounded memory.
#include "debug/frame_log.hpp"

#include <utility>

namespace broadside::core {

template <int D, typename Real>
void FrameLog<D, Real>::prepare(const Frame<D, Real>& frame, const std::vector<Pair>& toggled) {
  Step<D, Real> step{frame.boxes.size(), {frame.changed.begin(), frame.changed.end()}, {}, {}, toggled};
  for (const BoxId id : step.changed) {
    const bool is_there = index(id) < frame.boxes.size();
    step.boxes.push_back(is_there ? frame.boxes[index(id)] : absent_box<D, Real>());
    if (!frame.filters.empty()) step.filters.push_back(is_there ? frame.filters[index(id)] : Filter{});
  }
  if (count_ == 0) {
    first_ = {};
    first_.next(step);
    return;
  }
  while (!steps_.empty() && (steps_.size() >= max_frames_ || bytes_ + bytes_of(step) > max_bytes_)) {
    Replay<D, Real> second = first_;  // a step that is taken by halves could not be taken again
    second.next(steps_.front());
    first_ = std::move(second);
    bytes_ -= bytes_of(steps_.front());
    steps_.pop_front();
  }
  prepared_.clear();
  prepared_.push_back(std::move(step));
}

template <int D, typename Real>
void FrameLog<D, Real>::add() noexcept {
  if (count_++ == 0) return;
  bytes_ += bytes_of(prepared_.front());
  steps_.splice(steps_.end(), prepared_);
}

template <int D, typename Real>
History<D, Real> FrameLog<D, Real>::history() const {
  return history_of(first_.frame(), {steps_.begin(), steps_.end()});
}

template <int D, typename Real>
std::size_t FrameLog<D, Real>::bytes_of(const Step<D, Real>& step) noexcept {
  return sizeof step + step.changed.capacity() * sizeof(BoxId) +
         step.boxes.capacity() * sizeof(Box<D, Real>) + step.filters.capacity() * sizeof(Filter) +
         step.toggled.capacity() * sizeof(Pair);
}

template class FrameLog<2, float>;
template class FrameLog<2, double>;
template class FrameLog<3, float>;
template class FrameLog<3, double>;

}  // namespace broadside::core
