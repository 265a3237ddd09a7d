// Recordings of Box2D: rain, a tumbler and pyramids, modelled on Box2D's own samples.
//
// Each fixture is a box: its shape's own bounds, not the enlarged ones of the engine's tree, but with the
// skin of 1 cm that Box2D gives to polygons. Ground, walls and platforms are the first boxes.
#include <algorithm>
#include <cmath>
#include <string>

#include <box2d/box2d.h>

#include "lab/recordings/recordings.hpp"
#include "lab/scenes/random.hpp"

namespace broadside::lab::recordings {
namespace {

/// A world of boxes and circles of about 1 m, the size that the engine is tuned for, at 60 steps per second.
class Box2dWorld {
 public:
  explicit Box2dWorld(const SceneRequest& request) : count_(request.boxes), random_(request.seed) {}

  void step() {
    constexpr int velocity_iterations = 8;
    constexpr int position_iterations = 3;
    world_.Step(1.0F / 60, velocity_iterations, position_iterations);
  }

  /// The first fixtures, as many as were requested.
  std::vector<Box2> boxes() const {
    std::vector<Box2> boxes(count_);
    for (std::size_t i = 0; i < count_; ++i) {
      b2AABB bounds;
      fixtures_[i]->GetShape()->ComputeAABB(&bounds, fixtures_[i]->GetBody()->GetTransform(), 0);
      boxes[i] = {{bounds.lowerBound.x, bounds.lowerBound.y}, {bounds.upperBound.x, bounds.upperBound.y}};
    }
    return boxes;
  }

 protected:
  /// The number of fixtures still missing.
  std::size_t wanted() const { return count_ - std::min(count_, fixtures_.size()); }

  float between(double low, double high) { return static_cast<float>(random_.between(low, high)); }

  b2Body* add_body(b2BodyType type, b2Vec2 place) {
    b2BodyDef definition;
    definition.type = type;
    definition.position = place;
    return world_.CreateBody(&definition);
  }

  void add_fixture(b2Body& body, const b2Shape& shape, float density = 1) {
    fixtures_.push_back(body.CreateFixture(&shape, density));
  }

  void add_box(b2Body& body, float half_width, float half_height, b2Vec2 centre = {0, 0}, float angle = 0) {
    b2PolygonShape shape;
    shape.SetAsBox(half_width, half_height, centre, angle);
    add_fixture(body, shape);
  }

  void add_circle(b2Body& body, float radius, float density = 1) {
    b2CircleShape shape;
    shape.m_radius = radius;
    add_fixture(body, shape, density);
  }

 private:
  std::size_t count_;
  Random random_;
  b2World world_{b2Vec2(0, -10)};
  std::vector<b2Fixture*> fixtures_;
};

/// The side of a square with `area` square metres for each of `count` bodies, at least 10 m.
float square_side(std::size_t count, double area) {
  return static_cast<float>(std::max(10.0, std::sqrt(static_cast<double>(count) * area)));
}

/// Boxes and balls fall through a square with slanting platforms; those that leave it below start again
/// above.
class Rain : public Box2dWorld {
 public:
  static constexpr std::size_t warm_up = 120;

  explicit Rain(const SceneRequest& request) : Box2dWorld(request), side_(square_side(request.boxes, 2.5)) {
    b2Body* const fixed = add_body(b2_staticBody, {0, 0});
    add_box(*fixed, 1, side_, {-1, side_ / 2});
    add_box(*fixed, 1, side_, {side_ + 1, side_ / 2});
    for (std::size_t platforms = request.boxes / 20; platforms > 0; --platforms)
      add_box(*fixed, between(0.5, 2.5), 0.2F, {between(0, side_), between(0, side_)}, between(-0.5, 0.5));
    while (wanted() > 0) {
      b2Body* const body = add_body(b2_dynamicBody, {between(1, side_ - 1), between(0, 1.2 * side_)});
      if (drops_.size() % 3 == 0)
        add_circle(*body, between(0.2, 0.5));
      else
        add_box(*body, between(0.2, 0.5), between(0.2, 0.5));
      drops_.push_back(body);
    }
  }

  void step() {
    for (b2Body* const drop : drops_) {
      if (drop->GetPosition().y > -2) continue;
      drop->SetTransform({between(1, side_ - 1), between(1.0 * side_, 1.2 * side_)}, 0);
      drop->SetLinearVelocity({0, 0});
    }
    Box2dWorld::step();
  }

 private:
  float side_;
  std::vector<b2Body*> drops_;
};

/// Boxes tumble in a square drum that turns about its middle.
class Tumbler : public Box2dWorld {
 public:
  static constexpr std::size_t warm_up = 100;

  explicit Tumbler(const SceneRequest& request) : Box2dWorld(request) {
    const float half = square_side(request.boxes, 2) / 2;
    b2Body* const drum = add_body(b2_kinematicBody, {0, 0});
    drum->SetAngularVelocity(0.05F * b2_pi);
    for (const float side : {-1.0F, 1.0F}) {
      add_box(*drum, half + 2, 1, {0, side * (half + 1)});
      add_box(*drum, 1, half + 2, {side * (half + 1), 0});
    }
    const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(wanted()))));
    const float spacing = 2 * half / static_cast<float>(columns + 1);
    for (std::size_t i = 0; wanted() > 0; ++i) {
      const std::size_t column = 1 + i % columns;
      const std::size_t row = 1 + i / columns;
      const b2Vec2 corner{-half, -half};
      const b2Vec2 way{static_cast<float>(column), static_cast<float>(row)};
      add_box(*add_body(b2_dynamicBody, corner + spacing * way), between(0.3, 0.5), between(0.3, 0.5));
    }
  }
};

/// Pyramids stand and sleep, until a ball hits one of them, and then the next.
class Pyramid : public Box2dWorld {
 public:
  static constexpr std::size_t warm_up = 150;

  explicit Pyramid(const SceneRequest& request) : Box2dWorld(request) {
    constexpr int rows = 10;
    constexpr std::size_t bodies = 1 + rows * (rows + 1) / 2;
    constexpr float distance = 20;
    const std::size_t pyramids = request.boxes / bodies + 1;
    const float length = distance * static_cast<float>(pyramids);
    add_box(*add_body(b2_staticBody, {0, 0}), length, 1, {length / 2, -1});
    for (float x = 0; wanted() > 0; x += distance) {
      const b2Vec2 home{x, 0.5F};
      b2Body* const ball = add_body(b2_dynamicBody, home);
      add_circle(*ball, 0.5F, 5);
      // A rolling ball would never sleep.
      ball->SetAngularDamping(0.5F);
      balls_.push_back({ball, home, static_cast<std::size_t>(between(0, period))});
      for (int row = 0; row < rows; ++row) {
        for (int i = 0; i < rows - row && wanted() > 0; ++i) {
          const float left = x + 5 + 0.55F * static_cast<float>(row);
          const b2Vec2 place{left + 1.1F * static_cast<float>(i), 0.5F + 1.02F * static_cast<float>(row)};
          add_box(*add_body(b2_dynamicBody, place), 0.5F, 0.5F);
        }
      }
    }
  }

  void step() {
    for (const Ball& ball : balls_) {
      if (steps_ < first_shot || (steps_ - first_shot) % period != ball.start) continue;
      ball.body->SetTransform(ball.home, 0);
      ball.body->SetLinearVelocity({between(15, 30), between(0, 6)});
    }
    ++steps_;
    Box2dWorld::step();
  }

 private:
  static constexpr std::size_t first_shot = 60;
  static constexpr std::size_t period = 300;

  struct Ball {
    b2Body* body;
    b2Vec2 home;
    std::size_t start;  // the step within each period at which the ball is shot
  };

  std::vector<Ball> balls_;
  std::size_t steps_ = 0;
};

template <typename World>
Scene box2d_recording(const char* name, const char* summary) {
  return {
      .name = name,
      .summary = summary,
      .source = std::string("Box2D ") + BOX2D_VERSION,
      .kind = SceneKind::recorded,
      .history_2d =
          [](const Settings&, const SceneRequest& request) {
            World world(request);
            return record<2>(world, World::warm_up, request.frames);
          },
  };
}

}  // namespace

std::vector<Scene> box2d() {
  return {
      box2d_recording<Rain>("box2d_rain", "boxes and balls falling through platforms, again and again"),
      box2d_recording<Tumbler>("box2d_tumbler", "boxes tumbling in a turning drum"),
      box2d_recording<Pyramid>("box2d_pyramid", "pyramids at rest, hit by balls one after the other"),
  };
}

}  // namespace broadside::lab::recordings
