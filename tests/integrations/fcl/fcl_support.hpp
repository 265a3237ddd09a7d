// Objects for FCL that are nothing but boxes, and callbacks that note what they get.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include <fcl/broadphase/broadphase_collision_manager.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision_object.h>

#include "broadside/box.hpp"

namespace broadside::fcl_tests {

template <typename S>
class BoxObject final : public fcl::CollisionObject<S> {
 public:
  BoxObject(std::size_t id, const Box<3, S>& box) : fcl::CollisionObject<S>(sphere()), id_(id) { set(box); }

  std::size_t id() const { return id_; }
  void set(const Box<3, S>& box) {
    for (int axis = 0; axis < 3; ++axis) {
      this->aabb.min_[axis] = box.min[axis];
      this->aabb.max_[axis] = box.max[axis];
    }
  }

 private:
  /// Trees ask an object for its geometry's type.
  static std::shared_ptr<fcl::CollisionGeometry<S>> sphere() {
    static const auto geometry = std::make_shared<fcl::Sphere<S>>(S{1});
    return geometry;
  }

  std::size_t id_;
};

/// Objects with random boxes, half of which have whole coordinates, so that many touch.
template <typename S>
class RandomObjects {
 public:
  RandomObjects(std::size_t count, double extent, unsigned seed) : extent_(extent), random_(seed) {
    for (std::size_t id = 0; id < count; ++id)
      owned_.push_back(std::make_unique<BoxObject<S>>(id, random_box()));
  }

  std::size_t size() const { return owned_.size(); }
  BoxObject<S>* operator[](std::size_t id) const { return owned_[id].get(); }
  std::vector<fcl::CollisionObject<S>*> pointers() const {
    std::vector<fcl::CollisionObject<S>*> all;
    for (const auto& object : owned_) all.push_back(object.get());
    return all;
  }

  std::size_t below(std::size_t count) { return random_() % count; }
  void jump(std::size_t id) { owned_[id]->set(random_box()); }

 private:
  Box<3, S> random_box() {
    std::uniform_real_distribution<double> place(-extent_, extent_);
    std::uniform_real_distribution<double> side(0, 2);
    const bool is_whole = below(2) == 0;
    Box<3, S> box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double min = is_whole ? std::round(place(random_)) : place(random_);
      box.min[axis] = static_cast<S>(min);
      box.max[axis] = static_cast<S>(min + (is_whole ? std::round(side(random_)) : side(random_)));
    }
    return box;
  }

  double extent_;
  std::mt19937_64 random_;
  std::vector<std::unique_ptr<BoxObject<S>>> owned_;
};

/// Ids of two objects, as the callback gets them.
using IdPair = std::pair<std::size_t, std::size_t>;

template <typename S>
IdPair ids(const fcl::CollisionObject<S>* first, const fcl::CollisionObject<S>* second) {
  return {static_cast<const BoxObject<S>*>(first)->id(), static_cast<const BoxObject<S>*>(second)->id()};
}

/// Appends the pair to a std::vector<IdPair>. Drops an object with itself, which some of FCL's managers
/// report.
template <typename S>
bool note_pair(fcl::CollisionObject<S>* first, fcl::CollisionObject<S>* second, void* data) {
  if (first != second && first->getAABB().overlap(second->getAABB()))
    static_cast<std::vector<IdPair>*>(data)->push_back(ids(first, second));
  return false;
}

/// What a distance query was told of, and the least distance.
template <typename S>
struct Nearest {
  std::vector<IdPair> asked{};
  S distance = std::numeric_limits<S>::max();

  /// The distance of two objects is that of their boxes and something more that depends on their ids alone.
  static bool take(fcl::CollisionObject<S>* first, fcl::CollisionObject<S>* second, void* data, S& least) {
    if (first == second) return false;
    auto& nearest = *static_cast<Nearest*>(data);
    const IdPair pair = ids(first, second);
    nearest.asked.push_back(pair);
    const S more = static_cast<S>((pair.first * 7 + pair.second * 7) % 5) / 8;
    nearest.distance = std::min(nearest.distance, first->getAABB().distance(second->getAABB()) + more);
    least = nearest.distance;
    return false;
  }
};

/// In ascending order, each pair with its lesser id first.
inline std::vector<IdPair> as_set(std::vector<IdPair> pairs) {
  for (IdPair& pair : pairs) {
    if (pair.second < pair.first) std::swap(pair.first, pair.second);
  }
  std::ranges::sort(pairs);
  return pairs;
}

}  // namespace broadside::fcl_tests
