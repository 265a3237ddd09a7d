// A ball falls onto a floor, over the installed broad phase. Exit status 0 if it lies there in the end.
#include <cmath>

#include <broadside/bullet.hpp>
#include <btBulletDynamicsCommon.h>

int main() {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  broadside::BulletBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  btBoxShape flat(btVector3(9, 1, 9));
  btSphereShape round(1);
  btRigidBody floor(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &flat));
  btRigidBody ball(btRigidBody::btRigidBodyConstructionInfo(1, nullptr, &round));
  ball.getWorldTransform().setOrigin({0, 5, 0});
  world.addRigidBody(&floor);
  world.addRigidBody(&ball);
  for (int i = 0; i < 200; ++i) world.stepSimulation(btScalar(1) / 60, 0);
  const btScalar height = ball.getWorldTransform().getOrigin().y();
  world.removeRigidBody(&ball);
  world.removeRigidBody(&floor);
  return std::abs(height - 2) < btScalar(0.1) ? 0 : 1;
}
