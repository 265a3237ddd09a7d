// Bullet simulations on either broad phase, for bench/engines/bullet.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <ctime>
#include <memory>
#include <string>
#include <vector>

#include <btBulletDynamicsCommon.h>

namespace broadside::bench {

/// Processor time of this thread; other programs on the machine disturb it less than wall-clock time.
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

/// Initial state of a simulation.
struct BulletScene {
  std::string name;
  std::string what;
};

/// The scenes fall, sheet and statics.
const std::vector<BulletScene>& bullet_scenes();

/// A Bullet world that times its broad-phase stage.
class TimedWorld final : public btDiscreteDynamicsWorld {
 public:
  using btDiscreteDynamicsWorld::btDiscreteDynamicsWorld;

  void updateAabbs() override;
  void computeOverlappingPairs() override;

  double stage_us = 0;  ///< in updateAabbs() and computeOverlappingPairs(), since the last reset to 0
};

/// Totals over a simulation's bodies.
struct Sums {
  double energy = 0;       ///< kinetic energy, plus potential energy above the ground, in joules
  double penetration = 0;  ///< total of all penetrating contacts, in metres
  std::size_t contacts = 0;
};

/// A simulation at 60 steps per second, with Bullet's default settings except that pairs are deterministic.
class Simulation {
 public:
  /// Creates at least `bodies` bodies besides the ground and the walls.
  Simulation(const std::string& scene, std::size_t bodies, std::unique_ptr<btBroadphaseInterface> broadphase);
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  void step();

  /// Copies all transforms from another simulation of the same scene, and only detects collisions.
  void detect(const Simulation& other);

  Sums sums() const;

  /// All contacts of each pair of bodies, as numbers; pairs are ordered by unique ids.
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
  std::vector<btRigidBody*> waving_;  // kinematic bodies that move up and down
  int steps_ = 0;
};

}  // namespace broadside::bench
