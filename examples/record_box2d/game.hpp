// A game on Box2D: crates rain onto a ledge, pile up there, and are removed once they have fallen off.
#pragma once

#include <cstddef>
#include <vector>

#include <box2d/box2d.h>

class Game {
 public:
  Game() {
    b2PolygonShape ledge;
    ledge.SetAsBox(4, 0.5F);
    const b2BodyDef at_rest;
    bodies_.push_back(world_.CreateBody(&at_rest));
    bodies_.back()->CreateFixture(&ledge, 0);
  }

  void step() {
    if (steps_++ % 6 == 0) drop_crate();
    world_.Step(1.0F / 60, 8, 3);
    for (b2Body*& body : bodies_) {
      if (body == nullptr || body->GetPosition().y > -10) continue;
      world_.DestroyBody(body);
      body = nullptr;
    }
  }

  /// The number of slots for bodies.
  std::size_t slots() const { return bodies_.size(); }

  /// Whether there is a body in a slot; if so, sets `box` to its bounds.
  bool bounds(std::size_t slot, b2AABB& box) const {
    const b2Body* const body = bodies_[slot];
    if (body == nullptr) return false;
    body->GetFixtureList()->GetShape()->ComputeAABB(&box, body->GetTransform(), 0);
    return true;
  }

 private:
  void drop_crate() {
    b2BodyDef definition;
    definition.type = b2_dynamicBody;
    definition.position.Set(static_cast<float>(steps_ % 13) - 6, 12);
    definition.angle = static_cast<float>(steps_ % 7);
    b2PolygonShape shape;
    shape.SetAsBox(0.5F, 0.4F);
    b2Body* const crate = world_.CreateBody(&definition);
    crate->CreateFixture(&shape, 1);

    for (b2Body*& body : bodies_) {
      if (body != nullptr) continue;
      body = crate;
      return;
    }
    bodies_.push_back(crate);
  }

  b2World world_{b2Vec2(0, -10)};
  std::vector<b2Body*> bodies_;  // nullptr in a free slot
  int steps_ = 0;
};
