// A Bullet simulation on Broadside: crates and balls rain onto the ground and form a heap, some of them are
// removed, and a ray finds the top of the rest. Only one line differs from any other Bullet program: the
// broad phase.
#include <cstdio>
#include <exception>
#include <memory>
#include <vector>

#include <broadside/bullet.hpp>
#include <btBulletDynamicsCommon.h>

namespace {

class Game {
 public:
  Game() { add(floor_, 0, {0, -1, 0}); }

  ~Game() {
    for (const auto& body : bodies_) world_.removeRigidBody(body.get());
  }
  Game(const Game&) = delete;
  Game& operator=(const Game&) = delete;

  void rain(int bodies) {
    for (int i = 0; i < bodies; ++i) {
      const int row = i / 6;
      const int layer = row / 5;
      const btVector3 place(btScalar(i % 6) * 1.3F, btScalar(1 + layer) * 1.3F, btScalar(row % 5) * 1.4F);
      const btVector3 shift(btScalar(i % 7) / 20, 0, btScalar(i % 11) / 30);
      add(i % 3 == 0 ? static_cast<btCollisionShape&>(ball_) : crate_, 1, place + shift);
    }
  }

  void take_out_every_fourth() {
    for (std::size_t i = 4; i < bodies_.size(); i += 3) {
      world_.removeRigidBody(bodies_[i].get());
      bodies_.erase(bodies_.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }

  void step(int times) {
    for (int i = 0; i < times; ++i) world_.stepSimulation(btScalar(1) / 60, 0);
  }

  /// Height at which a ray from above first hits something.
  btScalar height(btScalar x, btScalar z) const {
    const btVector3 from(x, 50, z);
    const btVector3 to(x, -50, z);
    btCollisionWorld::ClosestRayResultCallback result(from, to);
    world_.rayTest(from, to, result);
    return result.hasHit() ? result.m_hitPointWorld.y() : -50;
  }

  bool is_at_rest() const {
    for (const auto& body : bodies_) {
      if (body->getLinearVelocity().length() > 1) return false;
    }
    return true;
  }

  std::size_t bodies() const { return bodies_.size() - 1; }
  void print() { broadphase_.printStats(); }

 private:
  void add(btCollisionShape& shape, btScalar mass, const btVector3& place) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape.calculateLocalInertia(mass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, &shape, inertia);
    info.m_startWorldTransform.setOrigin(place);
    info.m_rollingFriction = info.m_spinningFriction = btScalar(0.1);
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    world_.addRigidBody(bodies_.back().get());
  }

  btBoxShape floor_{btVector3(60, 1, 60)};
  btBoxShape crate_{btVector3(0.4F, 0.5F, 0.6F)};
  btSphereShape ball_{0.5F};
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  broadside::BulletBroadphase broadphase_;  // instead of btDbvtBroadphase
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  std::vector<std::unique_ptr<btRigidBody>> bodies_;  // the ground first
};

void play() {
  Game game;
  game.rain(300);
  game.step(600);
  const btScalar before = game.height(3, 3);
  game.print();
  game.take_out_every_fourth();
  game.step(900);
  const btScalar after = game.height(3, 3);
  game.print();
  std::printf("%zu bodies %s in a heap, whose middle is %s\n", game.bodies(),
              game.is_at_rest() ? "lie still" : "move",
              after < before && after > 0 ? "lower than before" : "no lower than before");
}

}  // namespace

int main() {
  try {
    play();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
