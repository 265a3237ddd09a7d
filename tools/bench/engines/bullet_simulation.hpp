// Simulations of Bullet's over one broad phase or another, for bench/engines/bullet.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <ctime>
#include <memory>
#include <string>
#include <vector>

#include <btBulletDynamicsCommon.h>

namespace broadside::bench {

/// The processor time of this thread, which other programs on the machine disturb less than they do the time
/// of day.
class ThreadStopwatch {
 public:
  double microseconds() const { return now() - start_; }

 private:
  static double now() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return double(time.tv_sec) * 1e6 + double(time.tv_nsec) / 1e3;
  }

  double start_ = now();
};

/// How a simulation begins.
struct BulletScene {
  std::string name;
  std::string what;
};

/// fall, sheet, statics.
const std::vector<BulletScene>& bullet_scenes();

/// A Bullet world that times what concerns its broad phase.
class TimedWorld final : public btDiscreteDynamicsWorld {
 public:
  using btDiscreteDynamicsWorld::btDiscreteDynamicsWorld;

  void updateAabbs() override;
  void computeOverlappingPairs() override;

  double stage_us = 0;  ///< in updateAabbs() and computeOverlappingPairs() since it was last set to 0
};

/// What a simulation's bodies amount to.
struct Sums {
  double energy = 0;       ///< kinetic, and potential above the floor, in joules
  double penetration = 0;  ///< of all contacts that penetrate, in metres
  std::size_t contacts = 0;
};

/// A scene in motion, 60 steps a second, with Bullet's standard settings but for deterministic pairs.
class Simulation {
 public:
  /// Of at least `bodies` bodies besides the floor and the walls.
  Simulation(const std::string& scene, std::size_t bodies, std::unique_ptr<btBroadphaseInterface> broadphase);
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  void step();

  /// Puts all bodies where another simulation of the same scene has them, and detects collisions alone.
  void detect(const Simulation& other);

  Sums sums() const;

  /// Each contact of each pair of bodies, as numbers; pairs by unique ids.
  std::vector<double> contacts() const;

  std::size_t size() const { return bodies_.size(); }
  int pairs() const { return broadphase_->getOverlappingPairCache()->getNumOverlappingPairs(); }
  btBroadphaseInterface& broadphase() { return *broadphase_; }
  TimedWorld& world() { return world_; }

 private:
  btRigidBody& add(std::unique_ptr<btCollisionShape> shape, btScalar mass, const btVector3& place);
  void add_box_of_walls(btScalar half_width, btScalar height);
  void fall(std::size_t bodies);
  void sheet(std::size_t bodies);
  void statics(std::size_t bodies);

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  std::unique_ptr<btBroadphaseInterface> broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  TimedWorld world_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<btRigidBody*> waving_;  // kinematic bodies that go up and down
  int steps_ = 0;
};

}  // namespace broadside::bench
