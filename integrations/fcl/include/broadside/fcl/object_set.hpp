// The objects of an FCL manager in one array, with their boxes as of the last registration or update.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fcl/narrowphase/collision_object.h>

#include "broadside/box.hpp"
#include "broadside/error.hpp"
#include "broadside/pair.hpp"

namespace broadside::detail {

/// Objects at contiguous indices from 0: the last object replaces a removed one.
///
/// Functions that change something have the strong exception guarantee. Functions that change boxes call
/// `changed(place)`, which must not throw, for each index whose box changed.
template <typename S>
class FclObjectSet {
 public:
  using Object = fcl::CollisionObject<S>;

  std::span<Object* const> objects() const noexcept { return objects_; }
  std::span<const Box<3, S>> boxes() const noexcept { return boxes_; }
  std::size_t size() const noexcept { return objects_.size(); }

  /// The object's index; empty if it is not registered.
  std::optional<BoxId> place_of(const Object* object) const {
    const auto found = places_.find(object);
    return found == places_.end() ? std::nullopt : std::optional(found->second);
  }

  template <typename Changed>
  void add(std::span<Object* const> added, const Changed& changed) {
    const std::size_t before = size();
    if (added.size() > std::numeric_limits<std::uint32_t>::max() - before)
      throw std::length_error(std::to_string(before + added.size()) + " objects; expected less than 2^32");
    try {
      for (Object* const object : added) {
        const std::size_t number = size() - before;
        const Box<3, S> box = box_of(object, number);
        if (const std::optional<BoxId> place = place_of(object)) {
          throw std::invalid_argument(
              named(number) + (index(*place) < before ? " is registered already" : " is given twice") +
              "; expected objects that are not registered");
        }
        boxes_.push_back(box);
        objects_.push_back(object);
        places_.emplace(object, BoxId(size() - 1));
      }
    } catch (...) {
      for (; size() > before; objects_.pop_back()) places_.erase(objects_.back());
      boxes_.resize(before);
      throw;
    }
    for (std::size_t place = before; place < size(); ++place) changed(place);
  }

  template <typename Changed>
  void remove(const Object* object, const Changed& changed) {
    const std::size_t place = index(registered(object, 0));
    places_.erase(object);
    if (place + 1 < size()) {
      objects_[place] = objects_.back();
      boxes_[place] = boxes_.back();
      places_.find(objects_[place])->second = BoxId(place);
      changed(place);
    }
    objects_.pop_back();
    boxes_.pop_back();
  }

  void clear() noexcept {
    objects_.clear();
    boxes_.clear();
    places_.clear();
  }

  /// Updates the boxes of all objects.
  template <typename Changed>
  void update(const Changed& changed) {
    moved_.resize(size());
    for (std::size_t place = 0; place < size(); ++place) moved_[place] = box_of(objects_[place], place);
    for (std::size_t place = 0; place < size(); ++place) {
      if (moved_[place] != boxes_[place]) changed(place);
    }
    boxes_.swap(moved_);
  }

  /// Updates the boxes of these objects.
  template <typename Changed>
  void update(std::span<Object* const> objects, const Changed& changed) {
    moved_.clear();
    moved_places_.clear();
    for (std::size_t i = 0; i < objects.size(); ++i) {
      moved_places_.push_back(registered(objects[i], i));
      moved_.push_back(box_of(objects[i], i));
    }
    for (std::size_t i = 0; i < objects.size(); ++i) {
      Box<3, S>& box = boxes_[index(moved_places_[i])];
      if (std::exchange(box, moved_[i]) != moved_[i]) changed(index(moved_places_[i]));
    }
  }

  /// The current box of the object. `number` is its index in the caller's list, for the message.
  static Box<3, S> box_of(const Object* object, std::size_t number = 0) {
    if (object == nullptr) throw std::invalid_argument(named(number) + " is null; expected an object");
    const fcl::AABB<S>& bounds = object->getAABB();
    Box<3, S> box;
    for (int axis = 0; axis < 3; ++axis) {
      box.min[axis] = bounds.min_[axis];
      box.max[axis] = bounds.max_[axis];
    }
    if (!is_present(box)) refuse(box, number);
    return box;
  }

 private:
  static std::string named(std::size_t number) { return "object " + std::to_string(number); }

  [[noreturn]] static void refuse(const Box<3, S>& box, std::size_t number) {
    for (int axis = 0; axis < 3; ++axis) {
      if (box.min[axis] <= box.max[axis]) continue;
      throw InvalidInput(number, named(number) + " has an AABB from " + std::to_string(box.min[axis]) +
                                     " to " + std::to_string(box.max[axis]) + " on axis " +
                                     std::to_string(axis) + "; expected min <= max");
    }
    std::terminate();
  }

  BoxId registered(const Object* object, std::size_t number) const {
    if (const std::optional<BoxId> place = place_of(object)) return *place;
    throw std::invalid_argument(named(number) + (object == nullptr ? " is null" : " is not registered") +
                                "; expected a registered object");
  }

  std::vector<Object*> objects_;
  std::vector<Box<3, S>> boxes_;
  std::unordered_map<const Object*, BoxId> places_;
  std::vector<Box<3, S>> moved_;  // boxes read by update() before it changes anything
  std::vector<BoxId> moved_places_;
};

}  // namespace broadside::detail
