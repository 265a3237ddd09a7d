// FclCollisionManager's members.
#pragma once

#include "broadside/fcl.hpp"

namespace broadside {

template <typename S>
void FclCollisionManager<S>::add(std::span<Object* const> objects) {
  refuse_within_query();
  pairs_.reserve(size() + objects.size());
  objects_.add(objects, [this](std::size_t place) { pairs_.changed(place); });
}

template <typename S>
void FclCollisionManager<S>::unregisterObject(Object* object) {
  refuse_within_query();
  objects_.remove(object, [this](std::size_t place) { pairs_.changed(place); });
  pairs_.shrunk();
}

template <typename S>
void FclCollisionManager<S>::clear() {
  refuse_within_query();
  objects_.clear();
  pairs_.shrunk();
}

template <typename S>
void FclCollisionManager<S>::update() {
  refuse_within_query();
  objects_.update([this](std::size_t place) { pairs_.changed(place); });
}

template <typename S>
void FclCollisionManager<S>::update_some(std::span<Object* const> objects) {
  refuse_within_query();
  objects_.update(objects, [this](std::size_t place) { pairs_.changed(place); });
}

template <typename S>
const FclCollisionManager<S>& FclCollisionManager<S>::same_kind(const Manager* other) {
  if (const auto* const same = dynamic_cast<const FclCollisionManager*>(other)) return *same;
  throw std::invalid_argument(std::string("the other manager is ") +
                              (other == nullptr ? "null" : std::string("a ") + typeid(*other).name()) +
                              "; expected a broadside::FclCollisionManager of the same scalar");
}

template <typename S>
void FclCollisionManager<S>::collide(Object* object, void* data, CollisionCallBack callback) const {
  const QueryGuard query(*this);
  const std::span<Object* const> objects = objects_.objects();
  box_index().overlapping(objects_.box_of(object),
                          [&](BoxId place) { return !callback(objects[index(place)], object, data); },
                          {.except = objects_.place_of(object)});
}

template <typename S>
void FclCollisionManager<S>::collide(void* data, CollisionCallBack callback) const {
  const QueryGuard query(*this);
  const std::span<Object* const> objects = objects_.objects();
  std::unique_lock lock(mutex_);
  const std::span<const Pair> pairs = pairs_.pairs(objects_.boxes());
  lock.unlock();
  for (const Pair pair : pairs) {
    if (callback(objects[index(pair.first)], objects[index(pair.second)], data)) return;
  }
}

template <typename S>
void FclCollisionManager<S>::collide(Manager* other_manager, void* data, CollisionCallBack callback) const {
  const FclCollisionManager& other = same_kind(other_manager);
  if (&other == this) return collide(data, callback);
  const QueryGuard query(*this);
  const QueryGuard other_query(other);
  const std::span<Object* const> objects = objects_.objects();
  const std::span<Object* const> others = other.objects_.objects();
  std::vector<Pair> pairs;
  PairCollector collector(pairs);
  std::unique_lock lock(mutex_);
  pairs_.finder().find_between(objects_.boxes(), other.objects_.boxes(), collector);
  lock.unlock();
  for (const Pair pair : pairs) {
    Object* const first = objects[index(pair.first)];
    Object* const second = others[index(pair.second)];
    if (first != second && callback(first, second, data)) return;
  }
}

template <typename S>
S FclCollisionManager<S>::beyond(S reached, std::span<const Box<3, S>> boxes, bool are_own) const {
  constexpr std::size_t samples = 64;
  const BoxIndex<3, S>& all = box_index();
  S min_distance = std::numeric_limits<S>::infinity();
  const std::size_t step = std::max<std::size_t>(boxes.size() / samples, 1);
  for (std::size_t place = 0; place < boxes.size(); place += step) {
    const std::optional<BoxId> except = are_own ? std::optional(BoxId(place)) : std::nullopt;
    min_distance =
        std::min(min_distance, detail::distance_beyond(boxes[place], reached, all, objects_.boxes(), except));
  }
  return min_distance;
}

template <typename S>
void FclCollisionManager<S>::distance(Object* object, void* data, DistanceCallBack callback) const {
  const QueryGuard query(*this);
  const std::span<Object* const> objects = objects_.objects();
  const std::span<const Box<3, S>> boxes = objects_.boxes();
  const Box<3, S> box = objects_.box_of(object);
  const std::optional<BoxId> self = objects_.place_of(object);
  const BoxIndex<3, S>& all = box_index();
  detail::visit_by_distance<S>(
      [&](S radius, Pairs& pairs) {
        all.overlapping(detail::enlarged(box, radius),
                        [&](BoxId place) {
                          pairs.push_back({detail::distance_of(box, boxes[index(place)]), index(place), 0});
                        },
                        {.except = self});
      },
      [&](S reached) { return detail::distance_beyond(box, reached, all, boxes, self); },
      [&](const auto& pair, S& min_distance) {
        return callback(objects[pair.first], object, data, min_distance);
      });
}

template <typename S>
void FclCollisionManager<S>::distance(void* data, DistanceCallBack callback) const {
  const QueryGuard query(*this);
  const std::span<Object* const> objects = objects_.objects();
  const std::span<const Box<3, S>> boxes = objects_.boxes();
  std::vector<Box<3, S>> enlarged(boxes.size());
  detail::visit_by_distance<S>(
      [&](S radius, Pairs& pairs) {
        std::ranges::transform(boxes, enlarged.begin(),
                               [&](const auto& box) { return detail::enlarged(box, radius / 2); });
        PairFunction function([&](std::span<const Pair> found) {
          for (const auto [first, second] : found) {
            pairs.push_back({detail::distance_of(boxes[index(first)], boxes[index(second)]), index(first),
                             index(second)});
          }
        });
        const std::lock_guard lock(mutex_);
        pairs_.finder().find(enlarged, function);
      },
      [&](S reached) { return beyond(reached, boxes, true); },
      [&](const auto& pair, S& min_distance) {
        return callback(objects[pair.first], objects[pair.second], data, min_distance);
      });
}

template <typename S>
void FclCollisionManager<S>::distance(Manager* other_manager, void* data, DistanceCallBack callback) const {
  const FclCollisionManager& other = same_kind(other_manager);
  if (&other == this) return distance(data, callback);
  const QueryGuard query(*this);
  const QueryGuard other_query(other);
  const std::span<const Box<3, S>> boxes = objects_.boxes();
  const std::span<const Box<3, S>> other_boxes = other.objects_.boxes();
  std::vector<Box<3, S>> enlarged(boxes.size());
  detail::visit_by_distance<S>(
      [&](S radius, Pairs& pairs) {
        std::ranges::transform(boxes, enlarged.begin(),
                               [&](const auto& box) { return detail::enlarged(box, radius); });
        PairFunction function([&](std::span<const Pair> found) {
          for (const auto [first, second] : found) {
            pairs.push_back({detail::distance_of(boxes[index(first)], other_boxes[index(second)]),
                             index(first), index(second)});
          }
        });
        const std::lock_guard lock(mutex_);
        pairs_.finder().find_between(enlarged, other_boxes, function);
      },
      [&](S reached) { return beyond(reached, other_boxes, false); },
      [&](const auto& pair, S& min_distance) {
        Object* const first = objects_.objects()[pair.first];
        Object* const second = other.objects_.objects()[pair.second];
        return first != second && callback(first, second, data, min_distance);
      });
}

}  // namespace broadside
