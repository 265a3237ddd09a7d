//! Boxes, and rapier's broad phase over them.
use broadside::{Box3, Pair};
use parry3d::bounding_volume::Aabb;
use rapier3d::dynamics::{IntegrationParameters, RigidBodySet};
use rapier3d::geometry::{
    ActiveCollisionTypes, BroadPhaseBvh, BroadPhasePairEvent, ColliderBuilder, ColliderHandle, ColliderPair,
    ColliderSet,
};

/// A function that returns numbers from 0 to 1.
pub fn random() -> impl FnMut() -> f32 {
    let mut state = 1_u64;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / (1 << 24) as f32
    }
}

/// Boxes of edge 1, spread so that each overlaps some four others.
pub fn uniform(count: usize, random: &mut impl FnMut() -> f32) -> Vec<Box3> {
    let side = (count as f32 * 2.0).cbrt();
    let corners = (0..count).map(|_| [random(), random(), random()].map(|at| at * side));
    corners.map(|min| Box3::new(min, min.map(|at| at + 1.0))).collect()
}

pub fn aabb_of(bounds: &Box3) -> Aabb {
    Aabb::new(bounds.min.into(), bounds.max.into())
}

/// Colliders without bodies, which the broad phase asks which pairs count: all.
pub struct Colliders {
    set: ColliderSet,
    handles: Vec<ColliderHandle>,
    bodies: RigidBodySet,
    parameters: IntegrationParameters,
}

impl Colliders {
    pub fn new(count: usize) -> Self {
        let mut set = ColliderSet::new();
        let collider = || ColliderBuilder::ball(0.5).active_collision_types(ActiveCollisionTypes::all());
        let handles = (0..count).map(|_| set.insert(collider())).collect();
        Colliders { set, handles, bodies: RigidBodySet::new(), parameters: IntegrationParameters::default() }
    }

    /// Moves the first boxes of the broad phase, and returns the pairs of enlarged boxes that began and ended.
    pub fn update(&self, broad_phase: &mut BroadPhaseBvh, boxes: &[Box3]) -> Vec<BroadPhasePairEvent> {
        for (bounds, &handle) in boxes.iter().zip(&self.handles) {
            broad_phase.set_aabb(&self.parameters, handle, aabb_of(bounds));
        }
        let mut events = Vec::new();
        broad_phase.update(&self.parameters, &self.set, &self.bodies, &[], &[], &mut events);
        events
    }
}

/// The places of a pair of colliders, which are numbered as they were inserted.
pub fn places(pair: &ColliderPair) -> Pair {
    let [a, b] = [pair.collider1, pair.collider2].map(|handle| handle.into_raw_parts().0);
    Pair { first: a.min(b), second: a.max(b) }
}

pub fn overlap(boxes: &[Box3], pair: Pair) -> bool {
    boxes[pair.first as usize].overlaps(&boxes[pair.second as usize])
}
