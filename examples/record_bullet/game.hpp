// A game on Bullet: crates and balls rain onto a platform, pile up there, and are removed once they have
// fallen off.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <btBulletDynamicsCommon.h>

class Game {
 public:
  Game() { put(floor_, 0, btVector3(0, -1, 0)); }

  ~Game() {
    for (const auto& body : bodies_) {
      if (body) world_.removeRigidBody(body.get());
    }
  }
  Game(const Game&) = delete;
  Game& operator=(const Game&) = delete;

  void step() {
    if (steps_++ % 4 == 0) {
      btCollisionShape& shape = steps_ % 3 == 0 ? static_cast<btCollisionShape&>(ball_) : crate_;
      put(shape, 1, btVector3(btScalar(steps_ % 7) - 3, 8, btScalar(steps_ % 5) - 2));
    }
    world_.stepSimulation(btScalar(1) / 60, 0);
    for (auto& body : bodies_) {
      if (!body || body->getWorldTransform().getOrigin().y() > -10) continue;
      world_.removeRigidBody(body.get());
      body.reset();
    }
  }

  /// The number of slots for bodies.
  std::size_t slots() const { return bodies_.size(); }

  /// Whether there is a body in a slot; if so, sets `min` and `max` to its bounds.
  bool bounds(std::size_t slot, btVector3& min, btVector3& max) const {
    if (!bodies_[slot]) return false;
    bodies_[slot]->getAabb(min, max);
    return true;
  }

 private:
  void put(btCollisionShape& shape, btScalar mass, const btVector3& place) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape.calculateLocalInertia(mass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, &shape, inertia);
    info.m_startWorldTransform.setOrigin(place);
    std::unique_ptr<btRigidBody> added(new btRigidBody(info));
    world_.addRigidBody(added.get());

    for (auto& body : bodies_) {
      if (body) continue;
      body = std::move(added);
      return;
    }
    bodies_.push_back(std::move(added));
  }

  btBoxShape floor_{btVector3(4, 1, 4)};
  btBoxShape crate_{btVector3(0.4F, 0.5F, 0.6F)};
  btSphereShape ball_{0.5F};
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  std::vector<std::unique_ptr<btRigidBody>> bodies_;  // empty in a free slot
  int steps_ = 0;
};
