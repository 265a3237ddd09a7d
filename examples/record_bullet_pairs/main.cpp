// Records a game on Bullet, including the pairs of Bullet's broad phase, for Broadside to check. Usage:
// example_record_bullet_pairs [FILE [SLOT STEP]]. With a slot and a step, the broad phase is broken on
// purpose: from that step on, it no longer gets the updates of the body in that slot.
//
// Then: broadside verify FILE
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include <broadside/recorder.hpp>
#include <btBulletDynamicsCommon.h>

#include "game.hpp"

namespace {

std::uint32_t slot_of(const btBroadphaseProxy* proxy) {
  const void* const object = proxy->m_clientObject;
  return static_cast<std::uint32_t>(static_cast<const btCollisionObject*>(object)->getUserIndex());
}

}  // namespace

int main(int argc, char** argv) {
  const char* const path = argc > 1 ? argv[1] : "bullet.btrace";
  const std::size_t broken_slot = argc > 3 ? std::strtoul(argv[2], nullptr, 10) : 0;
  const int broken_from = argc > 3 ? std::atoi(argv[3]) : -1;

  // Bullet adds 0.02 to the box of a body. Its tree enlarges that by 0.05 and keeps the enlarged box until
  // the body leaves it. After the body has moved to the opposite side, the enlarged box extends 0.1 beyond
  // the box.
  const double margin = 0.12;
  Game game;
  broadside::Recorder<3, btScalar> recorder;
  recorder.open(path, margin);
  for (int step = 0; step < 240; ++step) {
    if (step == broken_from) game.break_broadphase(broken_slot);
    // A step finds pairs before it moves the bodies, so these are the boxes that it uses.
    for (const auto& body : game.bodies()) {
      const auto slot = static_cast<std::uint32_t>(body->getUserIndex());
      btVector3 min;
      btVector3 max;
      body->getAabb(min, max);
      recorder.set(slot, min, max);
      const btBroadphaseProxy& proxy = *body->getBroadphaseProxy();
      recorder.set_filter(slot, static_cast<std::uint32_t>(proxy.m_collisionFilterGroup),
                          static_cast<std::uint32_t>(proxy.m_collisionFilterMask));
    }
    game.step();
    const btBroadphasePairArray& pairs = game.pairs();
    for (int i = 0; i < pairs.size(); ++i)
      recorder.add_pair(slot_of(pairs[i].m_pProxy0), slot_of(pairs[i].m_pProxy1));
    recorder.end_frame();
  }
  if (!recorder.close()) {
    std::fprintf(stderr, "%s\n", recorder.error().c_str());
    return 1;
  }
  std::printf("%s\n", path);
}
