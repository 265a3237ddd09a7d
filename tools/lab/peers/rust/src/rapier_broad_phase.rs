//! rapier's `BroadPhaseBvh`: `set_aabb` of each box that changed, then `update`, whose events say which pairs of
//! enlarged boxes began and ended.

macro_rules! rapier_broad_phase {
    ($module:ident, $rapier:ident, $dimension:literal) => {
        pub mod $module {
            use std::ops::ControlFlow;

            use $rapier::dynamics::{IntegrationParameters, RigidBodySet};
            use $rapier::geometry::{
                Aabb, ActiveCollisionTypes, BroadPhaseBvh, BroadPhasePairEvent, ColliderBuilder, ColliderHandle,
                ColliderPair, ColliderSet, Group, InteractionGroups, InteractionTestMode,
            };

            use crate::kept_pairs::KeptPairs;
            use crate::peer::{Bounds, Filter, Follower, Frame, Pairs, Searcher};

            /// The broad phase, and a collider for each id, without a body.
            #[derive(Default)]
            struct Colliders {
                broad_phase: BroadPhaseBvh,
                colliders: ColliderSet,
                handles: Vec<ColliderHandle>,
                bodies: RigidBodySet,
                parameters: IntegrationParameters,
                removed: Vec<ColliderHandle>,
                events: Vec<BroadPhasePairEvent>,
            }

            fn ids(pair: &ColliderPair) -> (u32, u32) {
                let [a, b] = [pair.collider1, pair.collider2].map(|handle| handle.into_raw_parts().0);
                (a.min(b), a.max(b))
            }

            /// The groups of a collider, which accept at least the pairs that its filter accepts.
            fn groups_of(filter: &Filter) -> InteractionGroups {
                if filter.group > 0 {
                    return InteractionGroups::all(); // a common positive group overrides masks
                }
                // A group is one of 32 bits.
                let group_of = |bits: u64| u32::try_from(bits).map_or(Group::ALL, Group::from_bits_retain);
                let mode = InteractionTestMode::And;
                InteractionGroups::new(group_of(filter.category), group_of(filter.mask), mode)
            }

            impl Colliders {
                fn clear(&mut self, length: f32) {
                    self.broad_phase = BroadPhaseBvh::new();
                    self.parameters.length_unit = length;
                }

                /// Makes room for `count` ids: colliders are numbered in the order in which they are inserted.
                fn grow(&mut self, count: usize) {
                    while self.handles.len() < count {
                        let all = ActiveCollisionTypes::all();
                        let collider = ColliderBuilder::ball(0.5).active_collision_types(all);
                        self.handles.push(self.colliders.insert(collider));
                    }
                }

                /// Sets the filters, of all boxes or of none.
                fn set_filters(&mut self, filters: &[Filter]) {
                    for (id, &handle) in self.handles.iter().enumerate() {
                        let groups = filters.get(id).map_or(InteractionGroups::all(), groups_of);
                        if self.colliders[handle].collision_groups() != groups {
                            self.colliders[handle].set_collision_groups(groups);
                        }
                    }
                }

                fn set(&mut self, id: usize, bounds: &Bounds<$dimension>) {
                    let aabb = Aabb::new(bounds.min.into(), bounds.max.into());
                    self.broad_phase.set_aabb(&self.parameters, self.handles[id], aabb);
                }

                fn set_all(&mut self, boxes: &[Bounds<$dimension>]) {
                    self.grow(boxes.len());
                    for (id, bounds) in boxes.iter().enumerate().filter(|(_, bounds)| bounds.is_present()) {
                        self.set(id, bounds);
                    }
                    self.update();
                }

                fn update(&mut self) {
                    self.events.clear();
                    self.broad_phase.update(
                        &self.parameters,
                        &self.colliders,
                        &self.bodies,
                        &[],
                        &self.removed,
                        &mut self.events,
                    );
                    self.removed.clear();
                }
            }

            #[derive(Default)]
            pub struct BroadPhaseSearcher(Colliders);

            impl Searcher<$dimension> for BroadPhaseSearcher {
                fn search(&mut self, boxes: &[Bounds<$dimension>], length: f32, pairs: &mut Pairs) -> ControlFlow<()> {
                    self.search_filtered(boxes, &[], length, pairs)
                }

                fn search_filtered(
                    &mut self,
                    boxes: &[Bounds<$dimension>],
                    filters: &[Filter],
                    length: f32,
                    pairs: &mut Pairs,
                ) -> ControlFlow<()> {
                    self.0.clear(length);
                    self.0.grow(boxes.len());
                    self.0.set_filters(filters);
                    self.0.set_all(boxes);
                    for event in &self.0.events {
                        if let BroadPhasePairEvent::AddPair(pair) = event {
                            let (a, b) = ids(pair);
                            if boxes[a as usize].overlaps(&boxes[b as usize]) {
                                pairs.add(a, b)?;
                            }
                        }
                    }
                    ControlFlow::Continue(())
                }

                fn tear_down(&mut self) {
                    self.0.clear(1.0);
                }
            }

            /// Keeps the pairs that the events began, as rapier's narrow phase does.
            #[derive(Default)]
            pub struct BroadPhaseFollower {
                colliders: Colliders,
                pairs: KeptPairs,
            }

            impl BroadPhaseFollower {
                fn take_events(&mut self) {
                    for event in &self.colliders.events {
                        match event {
                            BroadPhasePairEvent::AddPair(pair) => self.pairs.begin(ids(pair)),
                            BroadPhasePairEvent::DeletePair(pair) => self.pairs.end(ids(pair)),
                        }
                    }
                }
            }

            impl Follower<$dimension> for BroadPhaseFollower {
                fn build(&mut self, boxes: &[Bounds<$dimension>], length: f32) {
                    self.pairs.clear();
                    self.colliders.clear(length);
                    self.colliders.set_all(boxes);
                    self.take_events();
                }

                fn update(&mut self, frame: &Frame<$dimension>, pairs: &mut Pairs) -> ControlFlow<()> {
                    self.colliders.grow(frame.boxes.len());
                    for &id in frame.changed {
                        let bounds = &frame.boxes[id as usize];
                        if bounds.is_present() {
                            self.colliders.set(id as usize, bounds);
                        } else {
                            self.colliders.removed.push(self.colliders.handles[id as usize]);
                        }
                    }
                    let removes = !self.colliders.removed.is_empty();
                    self.colliders.update();

                    for &pair in self.pairs.iter().filter(|&&pair| frame.has_changed(pair)) {
                        pairs.add(pair.0, pair.1)?;
                    }
                    if removes {
                        // There are no events of these.
                        let is_there = |id: u32| frame.boxes[id as usize].is_present();
                        self.pairs.retain(|(a, b)| is_there(a) && is_there(b));
                    }
                    self.take_events();
                    for event in &self.colliders.events {
                        if let BroadPhasePairEvent::AddPair(pair) = event {
                            let (a, b) = ids(pair);
                            pairs.add(a, b)?;
                        }
                    }
                    ControlFlow::Continue(())
                }
            }
        }
    };
}

rapier_broad_phase!(flat, rapier2d, 2);
rapier_broad_phase!(solid, rapier3d, 3);
