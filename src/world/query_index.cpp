// QueryIndex: the index for a world's queries while its tracker has no index of the current boxes.
#include "world/query_index.hpp"

#include <algorithm>

#include "core/grow.hpp"

namespace broadside::world {

template <int D, typename Real>
const BoxIndex<D, Real>& QueryIndex<D, Real>::updated(const BoxTable<D, Real>& table) {
  if (!is_current_.load(std::memory_order_acquire)) {
    const std::lock_guard lock(updating_);
    if (!is_current_.load(std::memory_order_relaxed)) update(table);
  }
  return *index_;
}

template <int D, typename Real>
void QueryIndex<D, Real>::update(const BoxTable<D, Real>& table) {
  const std::size_t slots = table.boxes().size();
  if (index_ == nullptr) {
    make_room(slots);
    index_ = std::make_unique<BoxIndex<D, Real>>();
  }
  // Slots that are gone need not be listed; slots that came and went in between must not be listed.
  std::erase_if(marked_, [&](BoxId slot) {
    const bool is_gone = index(slot) >= slots;
    if (is_gone) is_marked_[index(slot)] = 0;
    return is_gone;
  });
  index_->update({.boxes = table.boxes(), .changed = marked_, .filters = table.filters().values()});
  for (const BoxId slot : marked_) is_marked_[index(slot)] = 0;
  marked_.clear();
  updates_unused_ = 0;
  is_current_.store(true, std::memory_order_release);
}

template <int D, typename Real>
void QueryIndex<D, Real>::mark_differences(const BoxTable<D, Real>& old, const BoxTable<D, Real>& now) {
  if (index_ == nullptr) return;
  const std::size_t old_slots = old.boxes().size();
  const std::size_t new_slots = now.boxes().size();
  reserve(new_slots);
  // Slots that are gone are not marked, and yet the next query must not find them.
  if (new_slots < old_slots) is_current_.store(false, std::memory_order_relaxed);
  for (std::uint32_t slot = 0; slot < new_slots; ++slot) {
    const bool is_same = slot < old_slots && old.boxes()[slot] == now.boxes()[slot] &&
                         old.filters().get(slot) == now.filters().get(slot);
    if (!is_same) mark(slot);
  }
}

template <int D, typename Real>
void QueryIndex<D, Real>::drop() noexcept {
  index_.reset();
  updates_unused_ = 0;
  core::give_back(marked_, is_marked_);
  is_current_.store(false, std::memory_order_relaxed);
}

template <int D, typename Real>
std::size_t QueryIndex<D, Real>::bytes() const {
  const std::lock_guard lock(updating_);
  return core::bytes_of(marked_, is_marked_) + (index_ != nullptr ? index_->bytes() : 0);
}

template <int D, typename Real>
void QueryIndex<D, Real>::make_room(std::size_t count) {
  if (is_marked_.size() < count) is_marked_.resize(std::max(count, is_marked_.capacity()));
  if (marked_.capacity() < is_marked_.size()) marked_.reserve(is_marked_.capacity());
}

template class QueryIndex<2, float>;
template class QueryIndex<2, double>;
template class QueryIndex<3, float>;
template class QueryIndex<3, double>;

}  // namespace broadside::world
