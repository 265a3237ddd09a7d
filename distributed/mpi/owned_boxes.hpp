// The boxes that a rank of a distributed world owns, at the last update and now.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/error.hpp"

namespace broadside::mpi {

template <int D, typename Real>
struct OwnedBox {
  std::uint64_t id;
  Box<D, Real> before;  ///< absent if it was not in the world
  Box<D, Real> now;     ///< absent if removed
  bool is_listed;       ///< in the list of changed boxes
  bool is_handed_over;  ///< to this rank, since the last update

  bool is_changed() const noexcept { return is_handed_over || !(before == now); }
  bool is_added() const noexcept { return !is_present(before) && is_present(now); }
  bool is_removed() const noexcept { return is_present(before) && !is_present(now); }
};

/// A map from ids to boxes. The boxes are in an unordered array: the last box replaces a removed one.
template <int D, typename Real>
class OwnedBoxes {
 public:
  void add(std::uint64_t id, const Box<D, Real>& box) {
    check(id, box);
    if (const auto found = slots_.find(id); found != slots_.end()) {
      OwnedBox<D, Real>& owned = boxes_[found->second];
      if (is_present(owned.now))
        throw InvalidFrame("box " + std::to_string(id) +
                           " is added and in the world; expected an id that no other box has");
      if (is_present(owned.before))
        throw InvalidFrame("box " + std::to_string(id) +
                           " is added and was removed since the last update; expected another id");
      owned.now = box;
      --absent_;
      return;
    }
    insert({id, absent_box<D, Real>(), box, false, false});
  }

  void move(std::uint64_t id, const Box<D, Real>& box) {
    const std::size_t slot = slot_of(id);
    check(id, box);
    list(slot);
    boxes_[slot].now = box;
  }

  void remove(std::uint64_t id) {
    const std::size_t slot = slot_of(id);
    list(slot);
    boxes_[slot].now = absent_box<D, Real>();
    ++absent_;
  }

  /// Takes over a box from another rank, and lists it as changed. Throws InvalidFrame if this rank has
  /// another box with its id; a box that was added and removed since the last update is replaced.
  void take(OwnedBox<D, Real> box) {
    if (const auto found = slots_.find(box.id); found != slots_.end()) {
      OwnedBox<D, Real>& old = boxes_[found->second];
      if (is_present(old.before) || is_present(old.now))
        throw InvalidFrame("box " + std::to_string(box.id) +
                           " is handed over to this rank, which has a box of that id; expected an id that no "
                           "other box has");
      box.is_listed = old.is_listed;
      old = box;
      --absent_;
      return;
    }
    insert(box);
  }

  /// Forgets boxes, so that a returning box is not listed twice.
  void forget(std::span<const std::uint64_t> ids) noexcept {
    if (ids.empty()) return;
    for (const std::uint64_t id : ids) forget(id);
    std::erase_if(changed_, [this](std::uint64_t id) { return !slots_.contains(id); });
  }

  /// Calls visit(box) for each box that may have changed.
  template <typename Visit>
  void for_each_changed(const Visit& visit) const {
    for (const std::uint64_t id : changed_)
      if (const auto found = slots_.find(id); found != slots_.end() && boxes_[found->second].is_changed())
        visit(boxes_[found->second]);
  }

  /// Makes the current boxes the previous ones.
  void commit() noexcept {
    for (const std::uint64_t id : changed_) {
      const auto found = slots_.find(id);
      if (found == slots_.end()) continue;
      OwnedBox<D, Real>& owned = boxes_[found->second];
      owned.before = owned.now;
      owned.is_listed = owned.is_handed_over = false;
      if (!is_present(owned.now)) forget(id);
    }
    changed_.clear();
  }

  /// The index of a box in the world; valid until boxes are added or removed. Throws InvalidHandle.
  std::size_t slot_of(std::uint64_t id) const {
    const auto found = slots_.find(id);
    if (found == slots_.end() || !is_present(boxes_[found->second].now))
      throw InvalidHandle("box " + std::to_string(id) + " is not owned by this rank; expected one that is");
    return found->second;
  }

  bool contains(std::uint64_t id) const noexcept {
    const auto found = slots_.find(id);
    return found != slots_.end() && is_present(boxes_[found->second].now);
  }

  std::size_t size() const noexcept { return boxes_.size() - absent_; }

  const OwnedBox<D, Real>& at(std::size_t slot) const noexcept { return boxes_[slot]; }
  std::span<const OwnedBox<D, Real>> all() const noexcept { return boxes_; }

 private:
  static void check(std::uint64_t id, const Box<D, Real>& box) {
    if (!is_present(box))
      throw InvalidInput(0, "box " + std::to_string(id) + " has a NaN or min > max; expected min <= max");
  }

  /// Appends a box with a new id, and lists it as changed.
  void insert(OwnedBox<D, Real> box) {
    box.is_listed = false;
    boxes_.push_back(box);
    try {
      slots_.emplace(box.id, boxes_.size() - 1);
    } catch (...) {
      boxes_.pop_back();
      throw;
    }
    try {
      list(boxes_.size() - 1);
    } catch (...) {
      forget(box.id);
      throw;
    }
  }

  /// Forgets a box if it exists.
  void forget(std::uint64_t id) noexcept {
    const auto found = slots_.find(id);
    if (found == slots_.end()) return;
    const std::size_t slot = found->second;
    if (!is_present(boxes_[slot].now)) --absent_;
    slots_.erase(found);
    if (slot + 1 < boxes_.size()) {
      boxes_[slot] = boxes_.back();
      slots_.find(boxes_[slot].id)->second = slot;
    }
    boxes_.pop_back();
  }

  void list(std::size_t slot) {
    if (boxes_[slot].is_listed) return;
    changed_.push_back(boxes_[slot].id);
    boxes_[slot].is_listed = true;
  }

  std::vector<OwnedBox<D, Real>> boxes_;
  std::unordered_map<std::uint64_t, std::size_t> slots_;
  std::vector<std::uint64_t> changed_;
  std::size_t absent_ = 0;  // removed boxes, until commit()
};

}  // namespace broadside::mpi
