// Recordings of Bullet: the three scenes of Broadmark (Serpa and Rodrigues 2019), free fall, Brownian motion
// and moving gravity.
//
// Each body is a box: the exact bounds of its box or ball, without the margin that Bullet adds to the bounds
// of a rotated box. Ground and walls are the first boxes.
#include <algorithm>
#include <cmath>
#include <memory>

#include <btBulletDynamicsCommon.h>

#include "lab/recordings/recordings.hpp"
#include "lab/scenes/random.hpp"

namespace broadside::lab::recordings {
namespace {

/// A world of boxes and balls of about 1 m in a container, at 60 steps per second.
class BulletWorld {
 public:
  /// Bodies start on a lattice, each in its own cube of `spacing` metres; `height` is the container's height
  /// over its width.
  BulletWorld(const SceneRequest& request, double spacing, double height)
      : count_(request.boxes), random_(request.seed) {
    const double cells = std::cbrt(static_cast<double>(count_) / height);
    const auto columns = static_cast<std::size_t>(std::max(2.0, std::ceil(cells)));
    const std::size_t layers = count_ / (columns * columns) + 1;
    const double width = spacing * static_cast<double>(columns);
    const double top = spacing * static_cast<double>(layers);
    add_walls({width / 2, top / 2, width / 2});
    for (std::size_t i = 0; bodies_.size() < count_; ++i) {
      const std::array<std::size_t, 3> cell = {i % columns, i / (columns * columns), i / columns % columns};
      std::array<double, 3> place;
      for (int axis = 0; axis < 3; ++axis) {
        const double jitter = random_.between(0.4, 0.6);
        place[axis] = spacing * (static_cast<double>(cell[axis]) + jitter);
      }
      place[0] -= width / 2;
      place[1] -= top / 2;
      place[2] -= width / 2;
      add_moving(vector(place));
    }
  }

  ~BulletWorld() {
    for (const auto& body : bodies_) world_.removeRigidBody(body.get());
  }
  BulletWorld(const BulletWorld&) = delete;
  BulletWorld& operator=(const BulletWorld&) = delete;

  void step() {
    constexpr int no_substeps = 0;
    world_.stepSimulation(btScalar(1) / 60, no_substeps);
  }

  /// The first bodies, as many as were requested.
  std::vector<Box3> boxes() const {
    std::vector<Box3> boxes(count_);
    for (std::size_t i = 0; i < count_; ++i) {
      btVector3 min;
      btVector3 max;
      const btTransform& transform = bodies_[i]->getWorldTransform();
      if (const auto* box = dynamic_cast<const btBoxShape*>(shapes_[i].get()))
        btTransformAabb(box->getHalfExtentsWithMargin(), 0, transform, min, max);
      else
        shapes_[i]->getAabb(transform, min, max);
      for (int axis = 0; axis < 3; ++axis) {
        boxes[i].min[axis] = static_cast<float>(min[axis]);
        boxes[i].max[axis] = static_cast<float>(max[axis]);
      }
    }
    return boxes;
  }

 protected:
  static btVector3 vector(const std::array<double, 3>& values) {
    return {btScalar(values[0]), btScalar(values[1]), btScalar(values[2])};
  }

  btDiscreteDynamicsWorld& world() { return world_; }
  Random& random() { return random_; }

  std::span<const std::unique_ptr<btRigidBody>> moving() const { return std::span(bodies_).subspan(walls); }

  /// Prevents bodies from falling asleep, for scenes in which something other than a contact may move them.
  void keep_awake() {
    for (const auto& body : moving()) body->setActivationState(DISABLE_DEACTIVATION);
  }

 private:
  static constexpr std::size_t walls = 6;

  void add(std::unique_ptr<btCollisionShape> shape, btScalar mass, const btVector3& place) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(mass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape.get(), inertia);
    info.m_startWorldTransform.setOrigin(place);
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    shapes_.push_back(std::move(shape));
    world_.addRigidBody(bodies_.back().get());
  }

  void add_walls(const std::array<double, 3>& half) {
    constexpr double thickness = 1;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) {
        std::array<double, 3> wall = half;
        std::array<double, 3> place{};
        wall[axis] = thickness;
        place[axis] = side * (half[axis] + thickness);
        add(std::make_unique<btBoxShape>(vector(wall)), 0, vector(place));
      }
    }
  }

  void add_moving(const btVector3& place) {
    const std::array<double, 3> half = {random_.between(0.3, 0.6), random_.between(0.3, 0.6),
                                        random_.between(0.3, 0.6)};
    if (bodies_.size() % 3 == 0)
      add(std::make_unique<btSphereShape>(btScalar(half[0])), 1, place);
    else
      add(std::make_unique<btBoxShape>(vector(half)), 1, place);
  }

  std::size_t count_;
  Random random_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

/// Bodies fall from all heights and pile up on the ground.
class FreeFall : public BulletWorld {
 public:
  static constexpr std::size_t warm_up = 60;

  explicit FreeFall(const SceneRequest& request) : BulletWorld(request, 2, 2) {
    world().setGravity({0, -10, 0});
  }
};

/// Weightless bodies that are kicked in random directions now and then.
class Brownian : public BulletWorld {
 public:
  static constexpr std::size_t warm_up = 60;

  explicit Brownian(const SceneRequest& request) : BulletWorld(request, 1.6, 1) {
    world().setGravity({0, 0, 0});
    keep_awake();
    for (const auto& body : moving()) body->setDamping(0.2F, 0.2F);
  }

  void step() {
    constexpr double kicks_per_step = 0.1;
    constexpr btScalar strength = 3;
    for (const auto& body : moving()) {
      if (random().chance(kicks_per_step))
        body->applyCentralImpulse(strength * vector(random().direction<3>()));
    }
    BulletWorld::step();
  }
};

/// Bodies fall from wall to wall of a closed container, as gravity turns.
class MovingGravity : public BulletWorld {
 public:
  static constexpr std::size_t warm_up = 60;

  explicit MovingGravity(const SceneRequest& request) : BulletWorld(request, 1.8, 1) { keep_awake(); }

  void step() {
    // One turn in three seconds, and a slower one of its plane.
    const double angle = 2 * SIMD_PI * static_cast<double>(steps_++) / 180;
    const double tilt = angle / 5;
    world().setGravity(vector({10 * std::sin(angle) * std::cos(tilt), -10 * std::cos(angle),
                               10 * std::sin(angle) * std::sin(tilt)}));
    BulletWorld::step();
  }

 private:
  std::size_t steps_ = 0;
};

template <typename World>
Scene bullet_recording(const char* name, const char* summary) {
  return {
      .name = name,
      .summary = summary,
      .source = fmt::format("Bullet {}.{}", btGetVersion() / 100, btGetVersion() % 100),
      .kind = SceneKind::recorded,
      .history_3d =
          [](const Settings&, const SceneRequest& request) {
            World world(request);
            return record<3>(world, World::warm_up, request.frames);
          },
  };
}

}  // namespace

std::vector<Scene> bullet() {
  return {
      bullet_recording<FreeFall>("bullet_free_fall", "bodies falling from all heights onto a growing heap"),
      bullet_recording<Brownian>("bullet_brownian", "weightless bodies kicked at random"),
      bullet_recording<MovingGravity>("bullet_moving_gravity",
                                      "bodies in a closed container while gravity turns"),
  };
}

}  // namespace broadside::lab::recordings
