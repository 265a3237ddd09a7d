//! Rapier. A step finds pairs for the current boxes of the bodies, enlarged by half of the prediction distance, and
//! then moves bodies. The narrow phase has a contact pair for each pair that the broad phase holds. The broad phase
//! keeps a box enlarged by its skin until the body's box leaves it; `follow` does the same.

macro_rules! rapier {
    ($module:ident, $rapier:ident, $dimension:literal, [$($axis:literal),*], $turn:expr) => {
        pub mod $module {
            use std::ffi::c_int;

            use $rapier::math::{Pose, Vector};
            use $rapier::parry::bounding_volume::BoundingVolume;
            use $rapier::prelude::{Aabb, ColliderBuilder, ColliderHandle, PhysicsWorld, RigidBodyBuilder, RigidBodyHandle};

            use crate::peer::{Bounds, Pairs};
            use crate::simulations::{Body, Kind, Simulation};

            const SKIN: f32 = 0.04; // BroadPhaseBvh::CHANGE_DETECTION_FACTOR, times a length unit of 1

            #[derive(Default)]
            pub struct Rapier {
                world: PhysicsWorld,
                handles: Vec<(RigidBodyHandle, ColliderHandle)>,
                enlarged: Vec<Option<Aabb>>, // of each slot, in the last step ...
                next: Vec<Option<Aabb>>,     // ... and after it
            }

            fn vector(of: [f32; 3]) -> Vector {
                Vector::new($(of[$axis]),*)
            }

            impl Rapier {
                fn aabb(&self, slot: u32) -> Aabb {
                    // If a body was placed elsewhere, the collider itself follows only in the next step.
                    let (body, collider) = self.handles[slot as usize];
                    let prediction = self.world.integration_parameters.prediction_distance();
                    let shape = self.world.colliders[collider].shape();
                    shape.compute_aabb(self.world.bodies[body].position()).loosened(prediction / 2.0)
                }

                /// Makes new enlarged boxes for bodies that have left theirs. The first box of a body is not enlarged.
                fn follow(&mut self) {
                    for slot in 0..self.handles.len() {
                        if !self.world.bodies.contains(self.handles[slot].0) {
                            continue;
                        }
                        let aabb = self.aabb(slot as u32);
                        self.next[slot] = match self.next[slot] {
                            Some(enlarged) if enlarged.contains(&aabb) => Some(enlarged),
                            Some(_) => Some(aabb.loosened(SKIN)),
                            None => Some(aabb),
                        };
                    }
                }
            }

            fn bounds_of(aabb: &Aabb) -> Bounds<3> {
                let mut bounds = Bounds { min: [0.0; 3], max: [0.0; 3] };
                $(
                    bounds.min[$axis] = aabb.mins[$axis];
                    bounds.max[$axis] = aabb.maxs[$axis];
                )*
                bounds
            }

            impl Simulation for Rapier {
                fn dimension(&self) -> c_int {
                    $dimension
                }

                fn margin(&self) -> f32 {
                    2.0 * SKIN
                }

                fn set_gravity(&mut self, gravity: [f32; 3]) {
                    self.world.gravity = vector(gravity);
                }

                fn add(&mut self, slot: u32, body: &Body) {
                    let builder = match body.kind {
                        Kind::Fixed => RigidBodyBuilder::fixed(),
                        Kind::Kinematic => RigidBodyBuilder::kinematic_velocity_based(),
                        Kind::Dynamic => RigidBodyBuilder::dynamic(),
                    };
                    let shape = match body.is_ball {
                        true => ColliderBuilder::ball(body.half[0]),
                        false => ColliderBuilder::cuboid($(body.half[$axis]),*),
                    };
                    let handles = self.world.insert(
                        builder
                            .translation(vector(body.position))
                            .rotation($turn(body.angle))
                            .angvel($turn(body.spin)),
                        shape.user_data(slot.into()),
                    );
                    let slots = self.handles.len().max(slot as usize + 1);
                    self.handles.resize(slots, (RigidBodyHandle::invalid(), ColliderHandle::invalid()));
                    self.handles[slot as usize] = handles;
                    self.next.resize(slots, None);
                    self.next[slot as usize] = None;
                }

                fn remove(&mut self, slot: u32) {
                    self.world.remove_body(self.handles[slot as usize].0);
                }

                fn place(&mut self, slot: u32, position: [f32; 3], velocity: [f32; 3]) {
                    let body = &mut self.world.bodies[self.handles[slot as usize].0];
                    body.set_position(Pose::from_translation(vector(position)), true);
                    body.set_linvel(vector(velocity), true);
                    body.set_angvel($turn(0.0), true);
                }

                fn bounds(&self, slot: u32) -> Bounds<3> {
                    bounds_of(&self.aabb(slot))
                }

                fn enlarged(&self, slot: u32) -> Option<Bounds<3>> {
                    self.enlarged[slot as usize].as_ref().map(bounds_of)
                }

                fn step(&mut self, pairs: &mut Pairs) {
                    self.follow();
                    self.enlarged.clone_from(&self.next);
                    self.world.step();
                    self.follow();
                    for pair in self.world.contact_pairs() {
                        let slot = |collider: ColliderHandle| self.world.colliders[collider].user_data as u32;
                        let _ = pairs.add(slot(pair.collider1), slot(pair.collider2));
                    }
                }
            }
        }
    };
}

rapier!(flat, rapier2d, 2, [0, 1], |angle| angle);
rapier!(solid, rapier3d, 3, [0, 1, 2], |angle| Vector::new(0.0, 0.0, angle));
