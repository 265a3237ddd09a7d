// Scenes and stages of Bullet's simulations.
#include "bench/engines/bullet_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include "lab/scenes/random.hpp"

namespace broadside::bench {

const std::vector<BulletScene>& bullet_scenes() {
  static const std::vector<BulletScene> scenes = {
      {"fall", "boxes and balls fall from all heights into a heap"},
      {"sheet", "boxes side by side fall flat onto the floor and lie there"},
      {"statics", "a floor of kinematic boxes that wave, and balls on it"},
  };
  return scenes;
}

void TimedWorld::updateAabbs() {
  const ThreadStopwatch watch;
  btDiscreteDynamicsWorld::updateAabbs();
  stage_us += watch.microseconds();
}

void TimedWorld::computeOverlappingPairs() {
  const ThreadStopwatch watch;
  btDiscreteDynamicsWorld::computeOverlappingPairs();
  stage_us += watch.microseconds();
}

Simulation::Simulation(const std::string& scene, std::size_t bodies,
                       std::unique_ptr<btBroadphaseInterface> broadphase)
    : broadphase_(std::move(broadphase)), world_(&dispatcher_, broadphase_.get(), &solver_, &configuration_) {
  world_.getDispatchInfo().m_deterministicOverlappingPairs = true;
  if (scene == "fall")
    fall(bodies);
  else if (scene == "sheet")
    sheet(bodies);
  else if (scene == "statics")
    statics(bodies);
  else
    throw std::invalid_argument("unknown scene '" + scene + "'; expected fall, sheet or statics");
}

Simulation::~Simulation() {
  for (const auto& body : bodies_) world_.removeRigidBody(body.get());
}

void Simulation::step() {
  constexpr btScalar turns_per_step = btScalar(SIMD_2_PI) / 90;
  for (std::size_t i = 0; i < waving_.size(); ++i) {
    const btScalar phase = btScalar(steps_) * turns_per_step + btScalar(i % 100) / 5;
    waving_[i]->getWorldTransform().getOrigin().setY(std::sin(phase) / 2);
  }
  ++steps_;
  constexpr int no_substeps = 0;
  world_.stepSimulation(btScalar(1) / 60, no_substeps);
}

void Simulation::detect(const Simulation& other) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    bodies_[i]->setWorldTransform(other.bodies_[i]->getWorldTransform());
    bodies_[i]->setInterpolationWorldTransform(other.bodies_[i]->getWorldTransform());
  }
  world_.performDiscreteCollisionDetection();
}

Sums Simulation::sums() const {
  Sums sums;
  for (const auto& body : bodies_) {
    if (body->isStaticOrKinematicObject()) continue;
    const double mass = 1 / double(body->getInvMass());
    const double height = double(body->getWorldTransform().getOrigin().y());
    sums.energy += mass * (10 * height + double(body->getLinearVelocity().length2()) / 2);
    const btVector3 turn = body->getAngularVelocity() * body->getWorldTransform().getBasis();
    const btVector3 inertia = body->getLocalInertia();
    sums.energy += double((turn * turn).dot(inertia)) / 2;
  }
  for (int i = 0; i < dispatcher_.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold =
        *const_cast<btCollisionDispatcher&>(dispatcher_).getManifoldByIndexInternal(i);
    for (int j = 0; j < manifold.getNumContacts(); ++j) {
      ++sums.contacts;
      sums.penetration += std::max(0.0, -double(manifold.getContactPoint(j).getDistance()));
    }
  }
  return sums;
}

std::vector<double> Simulation::contacts() const {
  std::map<std::pair<int, int>, const btPersistentManifold*> touching;
  for (int i = 0; i < dispatcher_.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold =
        *const_cast<btCollisionDispatcher&>(dispatcher_).getManifoldByIndexInternal(i);
    if (manifold.getNumContacts() == 0) continue;
    touching[{manifold.getBody0()->getBroadphaseHandle()->m_uniqueId,
              manifold.getBody1()->getBroadphaseHandle()->m_uniqueId}] = &manifold;
  }
  std::vector<double> numbers;
  for (const auto& [ids, manifold] : touching) {
    numbers.insert(numbers.end(), {double(ids.first), double(ids.second)});
    for (int j = 0; j < manifold->getNumContacts(); ++j) {
      const btManifoldPoint& point = manifold->getContactPoint(j);
      for (const btVector3* const place : {&point.m_positionWorldOnA, &point.m_positionWorldOnB})
        numbers.insert(numbers.end(), {double(place->x()), double(place->y()), double(place->z())});
      numbers.push_back(double(point.getDistance()));
    }
  }
  return numbers;
}

btRigidBody& Simulation::add(std::unique_ptr<btCollisionShape> shape, btScalar mass, const btVector3& place) {
  btVector3 inertia(0, 0, 0);
  if (mass > 0) shape->calculateLocalInertia(mass, inertia);
  btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape.get(), inertia);
  info.m_startWorldTransform.setOrigin(place);
  bodies_.push_back(std::make_unique<btRigidBody>(info));
  shapes_.push_back(std::move(shape));
  world_.addRigidBody(bodies_.back().get());
  return *bodies_.back();
}

/// Ground with its top at height 0, and four walls.
void Simulation::add_box_of_walls(btScalar half_width, btScalar height) {
  const btScalar half_height = height / 2;
  add(std::make_unique<btBoxShape>(btVector3(half_width, 1, half_width)), 0, {0, -1, 0});
  for (const btScalar side : {-1, 1}) {
    const btScalar place = side * (half_width + 1);
    add(std::make_unique<btBoxShape>(btVector3(1, half_height, half_width)), 0, {place, half_height, 0});
    add(std::make_unique<btBoxShape>(btVector3(half_width, half_height, 1)), 0, {0, half_height, place});
  }
}

void Simulation::fall(std::size_t bodies) {
  lab::Random random(1);
  constexpr btScalar spacing = 2;
  const auto columns = static_cast<std::size_t>(std::ceil(std::cbrt(double(bodies) / 2)));
  const btScalar half_width = spacing * btScalar(columns) / 2;
  add_box_of_walls(half_width, 4 * half_width + 20);
  for (std::size_t i = 0; i < bodies; ++i) {
    const auto place = [&](std::size_t cell) {
      return spacing * (btScalar(cell) + btScalar(random.between(0.4, 0.6)));
    };
    const btScalar x = place(i % columns) - half_width;
    const btScalar y = place(i / (columns * columns));
    const btScalar z = place(i / columns % columns) - half_width;
    const auto half = [&] { return btScalar(random.between(0.3, 0.6)); };
    if (i % 3 == 0)
      add(std::make_unique<btSphereShape>(half()), 1, {x, y, z});
    else
      add(std::make_unique<btBoxShape>(btVector3{half(), half(), half()}), 1, {x, y, z});
  }
}

void Simulation::sheet(std::size_t bodies) {
  const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(double(bodies))));
  constexpr btScalar spacing = btScalar(1.01);
  const btScalar half_width = spacing * btScalar(columns) / 2;
  add_box_of_walls(half_width + 1, 10);
  for (std::size_t i = 0; i < columns * columns; ++i) {
    const btScalar x = spacing * (btScalar(i % columns) + btScalar(0.5)) - half_width;
    const btScalar z = spacing * (btScalar(i / columns) + btScalar(0.5)) - half_width;
    const btScalar half = btScalar(0.5);
    add(std::make_unique<btBoxShape>(btVector3(half, half, half)), 1, {x, 1, z});
  }
}

void Simulation::statics(std::size_t bodies) {
  lab::Random random(2);
  const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(double(bodies))));
  const btScalar half_width = btScalar(columns) / 2;
  add_box_of_walls(half_width, 20);
  for (std::size_t i = 0; i < columns * columns; ++i) {
    const btScalar x = btScalar(i % columns) + btScalar(0.5) - half_width;
    const btScalar z = btScalar(i / columns) + btScalar(0.5) - half_width;
    const btScalar half = btScalar(0.5);
    btRigidBody& body = add(std::make_unique<btBoxShape>(btVector3(half, half, half)), 0, {x, 0, z});
    world_.removeRigidBody(&body);
    body.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    body.setActivationState(DISABLE_DEACTIVATION);
    world_.addRigidBody(&body);
    waving_.push_back(&body);
  }
  for (std::size_t i = 0; i < columns * columns / 5; ++i) {
    const auto place = [&] { return btScalar(random.between(-0.95, 0.95)) * half_width; };
    const btScalar x = place();
    add(std::make_unique<btSphereShape>(btScalar(random.between(0.3, 0.6))), 1, {x, 2, place()});
  }
}

}  // namespace broadside::bench
