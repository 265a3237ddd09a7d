// Bullet's own worlds over BulletBroadphase, against the same worlds over btDbvtBroadphase.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include <BulletCollision/CollisionDispatch/btGhostObject.h>
#include <BulletDynamics/Character/btKinematicCharacterController.h>
#include <btBulletDynamicsCommon.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bullet_support.hpp"
#include "tests/support/rng.hpp"

namespace broadside::bullet_tests {
namespace {

using testing::IsEmpty;
using testing::Not;

/// A world over `Broadphase`, with a floor whose top is at height 0.
template <typename Broadphase>
class Physics {
 public:
  Physics() {
    world.getDispatchInfo().m_deterministicOverlappingPairs = true;
    add({0, -1, 0}, floor_, 0);
  }

  ~Physics() {
    for (const auto& body : bodies) remove(*body);
  }
  Physics(const Physics&) = delete;
  Physics& operator=(const Physics&) = delete;

  btRigidBody& add(const btVector3& place, btCollisionShape& shape, btScalar mass) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape.calculateLocalInertia(mass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, &shape, inertia);
    info.m_startWorldTransform.setOrigin(place);
    bodies.push_back(std::make_unique<btRigidBody>(info));
    world.addRigidBody(bodies.back().get());
    return *bodies.back();
  }

  void remove(btRigidBody& body) { world.removeRigidBody(&body); }

  /// Boxes and balls in three layers above the floor.
  void add_heap() {
    Rng rng(2);
    for (int i = 0; i < 75; ++i) {
      const btVector3 place(btScalar(i % 5) * btScalar(1.1), btScalar(1 + i / 25 * 2), btScalar(i / 5 % 5));
      const btVector3 jitter(rng.between(-0.1F, 0.1F), rng.between(0, 1), rng.between(-0.1F, 0.1F));
      add(place + jitter, i % 3 == 0 ? static_cast<btCollisionShape&>(ball_) : crate_, 1);
    }
  }

  /// Puts the bodies where they are in `other`, and detects what collides there.
  template <typename Other>
  void put_as(const Other& other) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      bodies[i]->setWorldTransform(other.bodies[i]->getWorldTransform());
      bodies[i]->setInterpolationWorldTransform(other.bodies[i]->getWorldTransform());
    }
    world.performDiscreteCollisionDetection();
  }

  void step() { world.stepSimulation(btScalar(1) / 60, 0); }

  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  Broadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  std::vector<std::unique_ptr<btRigidBody>> bodies;
  btBoxShape crate_{btVector3(btScalar(0.4), btScalar(0.5), btScalar(0.6))};

 private:
  btBoxShape floor_{btVector3(20, 1, 20)};
  btSphereShape ball_{btScalar(0.5)};
};

/// The contacts of each pair of bodies that touch, by unique id.
template <typename World>
std::map<std::pair<int, int>, std::vector<btScalar>> contacts(World& physics) {
  std::map<std::pair<int, int>, std::vector<btScalar>> all;
  for (int i = 0; i < physics.dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *physics.dispatcher.getManifoldByIndexInternal(i);
    if (manifold.getNumContacts() == 0) continue;
    std::vector<btScalar>& numbers = all[{manifold.getBody0()->getBroadphaseHandle()->m_uniqueId,
                                          manifold.getBody1()->getBroadphaseHandle()->m_uniqueId}];
    for (int j = 0; j < manifold.getNumContacts(); ++j) {
      const btManifoldPoint& point = manifold.getContactPoint(j);
      for (const btVector3* const part : {&point.m_positionWorldOnA, &point.m_positionWorldOnB})
        numbers.insert(numbers.end(), {part->x(), part->y(), part->z()});
      numbers.push_back(point.getDistance());
    }
  }
  return all;
}

TEST(BulletWorld, HasTheContactsOfBulletsOwnBroadphaseForTheSameMotion) {
  Physics<btDbvtBroadphase> moving;
  Physics<btDbvtBroadphase> bullets;
  Physics<BulletBroadphase> ours;
  moving.add_heap();
  bullets.add_heap();
  ours.add_heap();
  for (int frame = 0; frame < 150; ++frame) {
    moving.step();
    bullets.put_as(moving);
    ours.put_as(moving);
    ASSERT_EQ(contacts(ours), contacts(bullets)) << "frame " << frame;
  }
  EXPECT_GT(contacts(ours).size(), 75U);
}

TEST(BulletWorld, LetsBodiesFallIntoAHeap) {
  Physics<BulletBroadphase> physics;
  physics.add_heap();
  for (int frame = 0; frame < 300; ++frame) physics.step();
  for (std::size_t i = 1; i < physics.bodies.size(); ++i) {
    const btScalar height = physics.bodies[i]->getWorldTransform().getOrigin().y();
    EXPECT_GT(height, btScalar(0.3)) << "sank into the floor";
    EXPECT_LT(height, 3) << "flew off";
  }
}

/// Kinematic lifts, bodies that are removed and put back in the tick, new ones, static ones that are moved.
void play(auto& physics) {
  physics.add_heap();
  btRigidBody& lift = *physics.bodies[5];
  lift.setMassProps(0, {0, 0, 0});
  lift.setCollisionFlags(lift.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  lift.setActivationState(DISABLE_DEACTIVATION);
  physics.world.setInternalTickCallback(
      [](btDynamicsWorld* world, btScalar) {
        auto& mine = *static_cast<std::remove_reference_t<decltype(physics)>*>(world->getWorldUserInfo());
        Rng rng(mine.bodies.size());
        btRigidBody& body = *mine.bodies[1 + rng.below(mine.bodies.size() - 1)];
        mine.remove(body);
        mine.world.addRigidBody(&body);
      },
      &physics);
  for (int frame = 0; frame < 60; ++frame) {
    lift.getWorldTransform().getOrigin().setY(1 + std::sin(btScalar(frame) / 10));
    if (frame % 3 == 0) physics.add({0, 6, btScalar(frame % 5)}, physics.crate_, frame % 2 == 0 ? 1 : 0);
    physics.bodies.back()->getWorldTransform().getOrigin() += btVector3(btScalar(0.1), 0, 0);
    physics.step();
  }
}

TEST(BulletWorld, HasThePairsOfAllBoxesWhateverComesAndGoes) {
  Physics<BulletBroadphase> physics;
  play(physics);
  physics.world.performDiscreteCollisionDetection();
  std::vector<std::pair<int, int>> expected;
  for (const auto& a : physics.bodies) {
    for (const auto& b : physics.bodies) {
      const btBroadphaseProxy& p = *a->getBroadphaseProxy();
      const btBroadphaseProxy& q = *b->getBroadphaseProxy();
      const bool meet = (p.m_collisionFilterGroup & q.m_collisionFilterMask) != 0 &&
                        (q.m_collisionFilterGroup & p.m_collisionFilterMask) != 0;
      if (p.m_uniqueId < q.m_uniqueId && meet &&
          TestAabbAgainstAabb2(p.m_aabbMin, p.m_aabbMax, q.m_aabbMin, q.m_aabbMax))
        expected.emplace_back(p.m_uniqueId, q.m_uniqueId);
    }
  }
  std::vector<std::pair<int, int>> found;
  const btBroadphasePairArray& pairs = physics.world.getPairCache()->getOverlappingPairArray();
  for (int i = 0; i < pairs.size(); ++i)
    found.emplace_back(pairs[i].m_pProxy0->m_uniqueId, pairs[i].m_pProxy1->m_uniqueId);
  EXPECT_THAT(found, testing::IsSupersetOf(expected));
  std::ranges::sort(found);
  EXPECT_EQ(std::ranges::adjacent_find(found), found.end());
  EXPECT_THAT(expected, Not(IsEmpty()));
}

TEST(BulletWorld, RunsTheSameWayTwice) {
  const auto final_places = [] {
    Physics<BulletBroadphase> physics;
    play(physics);
    std::vector<btScalar> places;
    for (const auto& body : physics.bodies) {
      const btVector3& place = body->getWorldTransform().getOrigin();
      places.insert(places.end(), {place.x(), place.y(), place.z()});
    }
    return places;
  };
  EXPECT_EQ(final_places(), final_places());
}

/// The fraction at which a ray or a moved ball first hits something, and how many contacts a crate has.
std::vector<btScalar> answers(auto& physics) {
  std::vector<btScalar> all;
  btSphereShape ball(btScalar(0.2));
  Rng rng(3);
  for (int i = 0; i < 50; ++i) {
    const btVector3 from(rng.between(-1, 6), rng.between(1, 6), rng.between(-1, 6));
    const btVector3 to(rng.between(-1, 6), rng.between(-2, 2), rng.between(-1, 6));
    btCollisionWorld::ClosestRayResultCallback ray(from, to);
    physics.world.rayTest(from, to, ray);
    btCollisionWorld::ClosestConvexResultCallback sweep(from, to);
    const btQuaternion turn = btQuaternion::getIdentity();
    physics.world.convexSweepTest(&ball, btTransform(turn, from), btTransform(turn, to), sweep);
    struct Count final : btCollisionWorld::ContactResultCallback {
      btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                               const btCollisionObjectWrapper*, int, int) override {
        // Bullet's own broad phase finds some that are apart, in its enlarged boxes.
        if (point.getDistance() <= 0) ++contacts;
        return 0;
      }
      btScalar contacts = 0;
    } count;
    physics.world.contactTest(physics.bodies[1 + rng.below(70)].get(), count);
    all.insert(all.end(), {ray.m_closestHitFraction, sweep.m_closestHitFraction, count.contacts});
  }
  return all;
}

TEST(BulletWorld, AnswersRaysSweepsAndContactTestsAsWithBulletsOwn) {
  Physics<btDbvtBroadphase> bullets;
  Physics<BulletBroadphase> ours;
  bullets.add_heap();
  ours.add_heap();
  for (int frame = 0; frame < 30; ++frame) bullets.step();
  ours.put_as(bullets);
  EXPECT_EQ(answers(ours), answers(bullets));
}

/// Where a character that walks against a wall for two seconds, and is put into a crate then, ends up.
btVector3 end_of_walk(auto& physics) {
  btBoxShape wall(btVector3(1, 5, 20));
  physics.add({5, 0, 0}, wall, 0);
  btCapsuleShape capsule(btScalar(0.4), 1);
  btPairCachingGhostObject ghost;
  ghost.setWorldTransform(btTransform(btQuaternion::getIdentity(), {0, 2, 0}));
  ghost.setCollisionShape(&capsule);
  ghost.setCollisionFlags(btCollisionObject::CF_CHARACTER_OBJECT);
  btGhostPairCallback callback;
  physics.broadphase.getOverlappingPairCache()->setInternalGhostPairCallback(&callback);
  btKinematicCharacterController character(&ghost, &capsule, btScalar(0.3), {0, 1, 0});
  physics.world.addCollisionObject(&ghost, btBroadphaseProxy::CharacterFilter,
                                   btBroadphaseProxy::StaticFilter | btBroadphaseProxy::DefaultFilter);
  physics.world.addAction(&character);
  character.setWalkDirection({btScalar(0.06), 0, 0});
  for (int frame = 0; frame < 120; ++frame) physics.step();
  EXPECT_GT(ghost.getNumOverlappingObjects(), 0);
  physics.add({-5, 1, 0}, physics.crate_, 0);
  character.setWalkDirection({0, 0, 0});
  character.warp({btScalar(-5.2), btScalar(1.2), 0});
  for (int frame = 0; frame < 30; ++frame) physics.step();
  const btVector3 end = ghost.getWorldTransform().getOrigin();
  physics.world.removeAction(&character);
  physics.world.removeCollisionObject(&ghost);
  physics.broadphase.getOverlappingPairCache()->setInternalGhostPairCallback(nullptr);
  return end;
}

TEST(BulletWorld, CarriesACharacterAsBulletsOwn) {
  Physics<btDbvtBroadphase> bullets;
  Physics<BulletBroadphase> ours;
  const btVector3 expected = end_of_walk(bullets);
  const btVector3 found = end_of_walk(ours);
  EXPECT_LT(found.distance(expected), btScalar(0.001))
      << found.x() << " " << found.y() << " " << found.z() << "; expected " << expected.x() << " "
      << expected.y() << " " << expected.z();
}

TEST(BulletWorld, TellsAGhostWhatItMeetsAsSoonAsItIsPut) {
  Physics<BulletBroadphase> physics;
  btGhostPairCallback callback;
  physics.broadphase.getOverlappingPairCache()->setInternalGhostPairCallback(&callback);
  btSphereShape ball(1);
  btGhostObject ghost;
  ghost.setCollisionShape(&ball);
  ghost.setWorldTransform(btTransform(btQuaternion::getIdentity(), {0, 0, 0}));
  physics.world.addCollisionObject(&ghost, btBroadphaseProxy::SensorTrigger, btBroadphaseProxy::AllFilter);
  EXPECT_EQ(ghost.getNumOverlappingObjects(), 1) << "the floor";
  physics.step();
  EXPECT_EQ(ghost.getNumOverlappingObjects(), 1);
  for (const btScalar height : {9, 0, 9}) {
    ghost.getWorldTransform().getOrigin().setY(height);
    physics.world.updateSingleAabb(&ghost);
  }
  physics.step();
  EXPECT_EQ(ghost.getNumOverlappingObjects(), 0);
  physics.world.removeCollisionObject(&ghost);
}

}  // namespace
}  // namespace broadside::bullet_tests
