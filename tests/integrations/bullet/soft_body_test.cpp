// Soft bodies over BulletBroadphase.
#include <algorithm>
#include <memory>

#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include "broadside/bullet.hpp"

namespace broadside::bullet_tests {
namespace {

TEST(BulletSoftBody, FallsOntoABoxAndStaysThere) {
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  BulletBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btSoftRigidDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  world.getWorldInfo().m_sparsesdf.Initialize();
  btBoxShape shape(btVector3(2, 1, 2));
  btRigidBody box(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &shape));
  world.addRigidBody(&box);
  const auto corner = [](btScalar x, btScalar z) { return btVector3(x, btScalar(1.5), z); };
  const std::unique_ptr<btSoftBody> cloth(btSoftBodyHelpers::CreatePatch(
      world.getWorldInfo(), corner(-1, -1), corner(1, -1), corner(-1, 1), corner(1, 1), 9, 9, 0, true));
  world.addSoftBody(cloth.get());
  for (int frame = 0; frame < 120; ++frame) world.stepSimulation(btScalar(1) / 60, 0);
  for (int i = 0; i < cloth->m_nodes.size(); ++i) EXPECT_NEAR(cloth->m_nodes[i].m_x.y(), 1, 0.3);
  world.removeSoftBody(cloth.get());
  world.removeRigidBody(&box);
  EXPECT_EQ(broadphase.world().size(), 0U);
}

}  // namespace
}  // namespace broadside::bullet_tests
