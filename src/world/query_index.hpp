// QueryIndex: the index for a world's queries while its tracker has no index of the current boxes.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/filter.hpp"
#include "broadside/index.hpp"
#include "broadside/pair.hpp"
#include "broadside/world.hpp"

#include "world/box_table.hpp"

namespace broadside::world {

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

  /// The same for many handles. Handles of slots that do not exist are skipped.
  void mark(std::span<const Handle> handles) noexcept {
    if (index_ == nullptr) return;
    for (const Handle handle : handles) {
      if (handle.slot < is_marked_.size()) mark(handle.slot);
    }
  }

  /// The index of a world's boxes and filters, by slot, brought up to date. Several threads may call it at
  /// once.
  const BoxIndex<D, Real>& updated(const BoxTable<D, Real>& table);

  /// Lists the slots in which `old` differs from `now`, the table of boxes that replaces it. O(slots).
  void mark_differences(const BoxTable<D, Real>& old, const BoxTable<D, Real>& now);

  /// Called by each update of the world: drops the index if most of `slots` slots have changed and queries
  /// have not used it for some updates, so that marking changes costs no more. The next query builds it anew.
  void drop_outdated(std::size_t slots) noexcept {
    if (marked_.size() > slots / 2 + 1024 && ++updates_unused_ >= max_updates_unused) drop();
  }

  /// Releases all memory; the next query builds the index.
  void drop() noexcept;

  std::size_t bytes() const;

 private:
  /// Queries of every few frames need the index, which takes many changes in a fraction of a build's time.
  static constexpr int max_updates_unused = 16;

  void make_room(std::size_t count);
  void update(const BoxTable<D, Real>& table);

  std::unique_ptr<BoxIndex<D, Real>> index_;  // null until a query needs it
  std::vector<BoxId> marked_;
  std::vector<std::uint8_t> is_marked_;  // by slot
  std::atomic<bool> is_current_ = false;
  int updates_unused_ = 0;  // since the last query, counted while most slots are marked
  mutable std::mutex updating_;
};

}  // namespace broadside::world
