// The boxes that a rank of a distributed world owns: as they were at the last update, and as they are.
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
  Box<D, Real> before;  ///< absent where it was not in the world
  Box<D, Real> now;     ///< absent where it is removed
  bool is_listed;       ///< among the changed ones
  bool is_handed_over;  ///< to this rank, since the last update

  bool is_changed() const noexcept { return is_handed_over || !(before == now); }
  bool is_added() const noexcept { return !is_present(before) && is_present(now); }
  bool is_removed() const noexcept { return is_present(before) && !is_present(now); }
};

/// One behind the other, in no order.
template <int D, typename Real>
class OwnedBoxes {
 public:
  void add(std::uint64_t id, const Box<D, Real>& box) {
    check(id, box);
    if (const auto found = places_.find(id); found != places_.end()) {
      OwnedBox<D, Real>& owned = boxes_[found->second];
      if (is_present(owned.now))
        throw InvalidFrame("box " + std::to_string(id) +
                           " is added and in the world; expected a number of its own");
      if (is_present(owned.before))
        throw InvalidFrame("box " + std::to_string(id) +
                           " is added and was removed since the last update; expected another number");
      owned.now = box;
      --absent_;
      return;
    }
    take({id, absent_box<D, Real>(), box, false, false});
  }

  void move(std::uint64_t id, const Box<D, Real>& box) {
    const std::size_t place = place_of(id);
    check(id, box);
    list(place);
    boxes_[place].now = box;
  }

  void remove(std::uint64_t id) {
    const std::size_t place = place_of(id);
    list(place);
    boxes_[place].now = absent_box<D, Real>();
    ++absent_;
  }

  /// Takes in a box that is in the world, as one that has changed. Throws InvalidFrame if there is one of its
  /// number.
  void take(OwnedBox<D, Real> box) {
    if (places_.contains(box.id))
      throw InvalidFrame("box " + std::to_string(box.id) +
                         " is handed over to this rank, which has added one; expected a number of its own");
    box.is_listed = false;
    boxes_.push_back(box);
    try {
      places_.emplace(box.id, boxes_.size() - 1);
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

  /// Forgets a box, if it is there.
  void forget(std::uint64_t id) noexcept {
    const auto found = places_.find(id);
    if (found == places_.end()) return;
    const std::size_t place = found->second;
    if (!is_present(boxes_[place].now)) --absent_;
    places_.erase(found);
    if (place + 1 < boxes_.size()) {
      boxes_[place] = boxes_.back();
      places_.find(boxes_[place].id)->second = place;
    }
    boxes_.pop_back();
  }

  /// Forgets boxes that another rank has taken, so that they are not listed twice if they come back.
  void hand_over(std::span<const std::uint64_t> ids) noexcept {
    for (const std::uint64_t id : ids) forget(id);
    std::erase_if(changed_, [this](std::uint64_t id) { return !places_.contains(id); });
  }

  /// Calls visit(box) for each box that may have changed.
  template <typename Visit>
  void for_each_changed(const Visit& visit) const {
    for (const std::uint64_t id : changed_)
      if (const auto found = places_.find(id); found != places_.end() && boxes_[found->second].is_changed())
        visit(boxes_[found->second]);
  }

  /// What is now becomes what was before.
  void commit() noexcept {
    for (const std::uint64_t id : changed_) {
      const auto found = places_.find(id);
      if (found == places_.end()) continue;
      OwnedBox<D, Real>& owned = boxes_[found->second];
      owned.before = owned.now;
      owned.is_listed = owned.is_handed_over = false;
      if (!is_present(owned.now)) forget(id);
    }
    changed_.clear();
  }

  /// The place of a box that is in the world. Throws InvalidHandle.
  std::size_t place_of(std::uint64_t id) const {
    const auto found = places_.find(id);
    if (found == places_.end() || !is_present(boxes_[found->second].now))
      throw InvalidHandle("box " + std::to_string(id) + " is not owned by this rank; expected one that is");
    return found->second;
  }

  bool contains(std::uint64_t id) const noexcept {
    const auto found = places_.find(id);
    return found != places_.end() && is_present(boxes_[found->second].now);
  }

  /// The number of boxes in the world.
  std::size_t size() const noexcept { return boxes_.size() - absent_; }

  const OwnedBox<D, Real>& at(std::size_t place) const noexcept { return boxes_[place]; }
  std::span<const OwnedBox<D, Real>> all() const noexcept { return boxes_; }

 private:
  static void check(std::uint64_t id, const Box<D, Real>& box) {
    if (!is_present(box))
      throw InvalidInput(0, "box " + std::to_string(id) + " has a NaN or min > max; expected min <= max");
  }

  void list(std::size_t place) {
    if (boxes_[place].is_listed) return;
    changed_.push_back(boxes_[place].id);
    boxes_[place].is_listed = true;
  }

  std::vector<OwnedBox<D, Real>> boxes_;
  std::unordered_map<std::uint64_t, std::size_t> places_;
  std::vector<std::uint64_t> changed_;
  std::size_t absent_ = 0;  // boxes that are removed, until commit()
};

}  // namespace broadside::mpi
