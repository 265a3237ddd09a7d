// FCL with Broadside as its broad phase: boxes and balls fly about a room; the program reports their
// contacts, and the closest approach of a drone that passes outside. It runs the same simulation with FCL's
// own tree, and the results must agree.
#include <cmath>
#include <cstdio>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include <broadside/fcl.hpp>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/default_broadphase_callbacks.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision_object.h>

namespace {

using Manager = fcl::BroadPhaseCollisionManagerd;

class Room {
 public:
  Room() {
    const auto box = std::make_shared<fcl::Boxd>(0.4, 0.6, 0.8);
    const auto ball = std::make_shared<fcl::Sphered>(0.3);
    for (int i = 0; i < bodies; ++i) {
      if (i % 2 == 0)
        add(box);
      else
        add(ball);
    }
  }

  std::vector<fcl::CollisionObjectd*> objects() const {
    std::vector<fcl::CollisionObjectd*> all;
    for (const Body& body : bodies_) all.push_back(body.object.get());
    return all;
  }
  fcl::CollisionObjectd* drone() { return &drone_; }

  /// All bodies move on and bounce off the walls.
  void step() {
    for (Body& body : bodies_) {
      fcl::Vector3d place = body.object->getTranslation() + body.velocity;
      for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(place[axis]) > half_room) body.velocity[axis] = -body.velocity[axis];
      }
      body.object->setTranslation(place);
      body.object->computeAABB();  // FCL requires its users to do this
    }
    drone_.setTranslation(drone_.getTranslation() + fcl::Vector3d(0.05, 0, 0));
    drone_.computeAABB();
  }

 private:
  static constexpr int bodies = 400;
  static constexpr double half_room = 6;

  struct Body {
    std::unique_ptr<fcl::CollisionObjectd> object;
    fcl::Vector3d velocity;
  };

  void add(const std::shared_ptr<fcl::CollisionGeometryd>& shape) {
    const auto anywhere = [this](double max) {
      std::uniform_real_distribution<> value(-max, max);
      return fcl::Vector3d(value(random_), value(random_), value(random_));
    };
    auto object = std::make_unique<fcl::CollisionObjectd>(shape);
    object->setTranslation(anywhere(half_room));
    object->computeAABB();
    bodies_.push_back({std::move(object), anywhere(0.1)});
  }

  std::mt19937_64 random_{1};
  std::vector<Body> bodies_;
  fcl::CollisionObjectd drone_{std::make_shared<fcl::Sphered>(0.1), fcl::Matrix3d::Identity(),
                               fcl::Vector3d(-3, 7.5, 0)};
};

struct Seen {
  int touching = 0;     ///< pairs of touching shapes, over all frames
  double closest = 99;  ///< smallest distance of the drone to a body
};

/// A user's callback: runs FCL's narrow phase on the two shapes.
bool count_touching(fcl::CollisionObjectd* first, fcl::CollisionObjectd* second, void* data) {
  fcl::CollisionResultd result;
  if (fcl::collide(first, second, fcl::CollisionRequestd(), result) > 0) ++static_cast<Seen*>(data)->touching;
  return false;  // continue
}

Seen simulate(Manager& manager) {
  Room room;
  manager.registerObjects(room.objects());
  manager.setup();
  Seen seen;
  for (int frame = 0; frame < 100; ++frame) {
    room.step();
    manager.update();
    manager.collide(&seen, count_touching);
    fcl::DefaultDistanceData<double> nearest;
    manager.distance(room.drone(), &nearest, fcl::DefaultDistanceFunction<double>);
    if (nearest.result.min_distance < seen.closest) seen.closest = nearest.result.min_distance;
  }
  manager.clear();  // the room's objects are destroyed next
  return seen;
}

}  // namespace

int main() {
  broadside::FclCollisionManagerd broadside_manager;
  fcl::DynamicAABBTreeCollisionManagerd tree;
  const Seen seen = simulate(broadside_manager);
  const Seen expected = simulate(tree);
  const bool same = seen.touching == expected.touching && std::abs(seen.closest - expected.closest) < 1e-9;
  std::printf("%d touching pairs in 100 frames; the drone came as close as %.3f\n", seen.touching,
              seen.closest);
  std::printf("the same with FCL's tree: %s\n", same ? "yes" : "no");
}
