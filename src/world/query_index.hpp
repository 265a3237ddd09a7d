// The index for a world's queries while its tracker has no index of the current boxes.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/filter.hpp"
#include "broadside/pair.hpp"
#include "broadside/queries.hpp"

#include "core/grow.hpp"

namespace broadside::core {

/// The first query that needs the index builds it. From then on QueryIndex lists the slots that changed since
/// the index took them, each once. So a query costs time for the changes since the last query, however many
/// updates lie between. Memory besides the index: 5 bytes per slot.
template <int D, typename Real>
class QueryIndex {
 public:
  /// Makes room for slots below `count`, so that marking them does not throw.
  void reserve(std::size_t count) {
    if (index_ != nullptr) make_room(count);
  }

  /// Lists a slot whose box or filter has changed. reserve() must have made room for it.
  void mark(std::uint32_t slot) noexcept {
    if (index_ == nullptr) return;
    is_current_.store(false, std::memory_order_relaxed);
    if (is_marked_[slot] != 0) return;
    is_marked_[slot] = 1;
    marked_.push_back(BoxId{slot});
  }

  /// Says that the last slots are gone, which are not marked: the next query must not find them.
  void shorten() noexcept { is_current_.store(false, std::memory_order_relaxed); }

  /// Whether the index is up to date. Several threads may call it at once.
  bool is_current() const noexcept { return is_current_.load(std::memory_order_acquire); }

  const BoxIndex<D, Real>& get() const noexcept { return *index_; }

  /// Brings the index up to date with a world's boxes and filters, by slot. One thread at a time.
  void update(std::span<const Box<D, Real>> boxes, std::span<const Filter> filters) {
    if (index_ == nullptr) {
      make_room(boxes.size());
      index_ = std::make_unique<BoxIndex<D, Real>>();
    }
    // Slots that are gone need not be listed; slots that came and went in between must not be listed.
    std::erase_if(marked_, [&](BoxId slot) {
      const bool is_gone = index(slot) >= boxes.size();
      if (is_gone) is_marked_[index(slot)] = 0;
      return is_gone;
    });
    index_->update({.boxes = boxes, .changed = marked_, .filters = filters});
    for (const BoxId slot : marked_) is_marked_[index(slot)] = 0;
    marked_.clear();
    is_current_.store(true, std::memory_order_release);
  }

  /// Whether a rebuild costs about as much as an update, by the number of slots changed since the last query.
  bool is_outdated(std::size_t slots) const noexcept { return marked_.size() > slots / 2 + 1024; }

  /// Releases all memory; the next query builds the index.
  void drop() noexcept {
    index_.reset();
    give_back(marked_, is_marked_);
    is_current_.store(false, std::memory_order_relaxed);
  }

  /// Takes over another world's index and its list of changed slots.
  void take(QueryIndex& other) noexcept {
    index_ = std::move(other.index_);
    marked_ = std::move(other.marked_);
    is_marked_ = std::move(other.is_marked_);
    is_current_.store(other.is_current(), std::memory_order_relaxed);
    other.drop();
  }

  bool exists() const noexcept { return index_ != nullptr; }

  std::size_t bytes() const noexcept {
    return marked_.capacity() * sizeof(BoxId) + is_marked_.capacity() +
           (index_ != nullptr ? index_->bytes() : 0);
  }

 private:
  void make_room(std::size_t count) {
    if (is_marked_.size() < count) is_marked_.resize(std::max(count, is_marked_.capacity()));
    if (marked_.capacity() < is_marked_.size()) marked_.reserve(is_marked_.capacity());
  }

  std::unique_ptr<BoxIndex<D, Real>> index_;  // null until a query needs it
  std::vector<BoxId> marked_;
  std::vector<std::uint8_t> is_marked_;  // by slot
  std::atomic<bool> is_current_ = false;
};

}  // namespace broadside::core
