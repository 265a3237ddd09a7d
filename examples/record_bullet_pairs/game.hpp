// A game on Bullet: balls rain into a box without a lid. Its broad phase can be broken on purpose, in a way
// that is typical of bugs in engines: from some step on, it no longer gets the updates of one ball.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <btBulletDynamicsCommon.h>

/// Bullet's usual broad phase; it can skip the updates of one proxy.
class SkippingBroadphase : public btDbvtBroadphase {
 public:
  void skip(const btBroadphaseProxy* proxy) { skipped_ = proxy; }

  void setAabb(btBroadphaseProxy* proxy, const btVector3& min, const btVector3& max,
               btDispatcher* dispatcher) override {
    if (proxy != skipped_) btDbvtBroadphase::setAabb(proxy, min, max, dispatcher);
  }

 private:
  const btBroadphaseProxy* skipped_ = nullptr;
};

class Game {
 public:
  static constexpr std::size_t balls = 60;

  Game() {
    // Lets a pair end in the step in which its boxes part, and not some steps later.
    broadphase_.m_cupdates = 100;
    // Without this, the box of a ball would be stretched along its path.
    world_.getDispatchInfo().m_useContinuous = false;
    put(floor_, 0, btVector3(0, -1, 0));
    for (int side = -1; side <= 1; side += 2) {
      put(wall_x_, 0, btVector3(btScalar(side) * 4, 2, 0));
      put(wall_z_, 0, btVector3(0, 2, btScalar(side) * 4));
    }
    for (std::size_t i = 0; i < balls; ++i) {
      const int column = static_cast<int>(i % 9);
      const btVector3 place(btScalar(column % 3) - btScalar(0.9), btScalar(2 + i / 3),
                            btScalar(column / 3) - btScalar(1.1));
      put(ball_, 1, place);
    }
  }

  ~Game() {
    for (const auto& body : bodies_) world_.removeRigidBody(body.get());
  }
  Game(const Game&) = delete;
  Game& operator=(const Game&) = delete;

  /// Finds the pairs of the current boxes, and then moves the bodies.
  void step() { world_.stepSimulation(btScalar(1) / 60, 0); }

  /// From now on, the broad phase keeps the current position of the body in this slot.
  void break_broadphase(std::size_t slot) { broadphase_.skip(bodies_[slot]->getBroadphaseProxy()); }

  const std::vector<std::unique_ptr<btRigidBody>>& bodies() const { return bodies_; }

  /// The pairs that the broad phase reports.
  const btBroadphasePairArray& pairs() {
    return broadphase_.getOverlappingPairCache()->getOverlappingPairArray();
  }

 private:
  void put(btCollisionShape& shape, btScalar mass, const btVector3& place) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape.calculateLocalInertia(mass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, &shape, inertia);
    info.m_startWorldTransform.setOrigin(place);
    bodies_.emplace_back(new btRigidBody(info));
    bodies_.back()->setUserIndex(static_cast<int>(bodies_.size()) - 1);
    world_.addRigidBody(bodies_.back().get());
  }

  btBoxShape floor_{btVector3(5, 1, 5)};
  btBoxShape wall_x_{btVector3(1, 4, 5)};
  btBoxShape wall_z_{btVector3(5, 4, 1)};
  btSphereShape ball_{0.4F};
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  SkippingBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  std::vector<std::unique_ptr<btRigidBody>> bodies_;  // a body's user index is its slot
};
