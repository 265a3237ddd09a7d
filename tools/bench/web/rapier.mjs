// Rapier as a broad phase: kinematic sensors, which report overlaps and exert no force.
import rapier from "@dimforge/rapier2d-simd-compat";

await rapier.init();

export const rapier2d = {
  name: "rapier2d-simd",
  dimension: 2,
  maxCount: 20_000,
  // Its narrow phase tests the boxes as well, as centres and half extents.
  isOther: true,
  motion(boxes) {
    const world = new rapier.World({ x: 0, y: 0 });
    const events = new rapier.EventQueue(true);
    const bodies = [];
    const idOf = new Map();
    const centre = (of, i) => ({ x: (of[4 * i] + of[4 * i + 2]) / 2, y: (of[4 * i + 1] + of[4 * i + 3]) / 2 });
    for (let i = 0; i < boxes.length / 4; ++i) {
      const { x, y } = centre(boxes, i);
      const body = world.createRigidBody(rapier.RigidBodyDesc.kinematicPositionBased().setTranslation(x, y));
      const shape = rapier.ColliderDesc.cuboid((boxes[4 * i + 2] - boxes[4 * i]) / 2,
        (boxes[4 * i + 3] - boxes[4 * i + 1]) / 2).setSensor(true)
        .setActiveEvents(rapier.ActiveEvents.COLLISION_EVENTS)
        .setActiveCollisionTypes(rapier.ActiveCollisionTypes.ALL);
      idOf.set(world.createCollider(shape, body).handle, i);
      bodies.push(body);
    }
    const step = () => {
      const begun = [], ended = [];
      world.step(events);
      events.drainCollisionEvents((a, b, isBegun) => (isBegun ? begun : ended).push(idOf.get(a), idOf.get(b)));
      return { begun, ended };
    };
    step();
    const update = (now, list) => {
      for (const i of list) bodies[i].setTranslation(centre(now, i), true);
      return step();
    };
    update.free = () => world.free();
    return update;
  },
};
