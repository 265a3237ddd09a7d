//! parry's `Bvh`: one hierarchy, joined with itself. In motion it is driven as rapier's broad phase drives it,
//! with its margins, and the pairs of enlarged boxes are kept.

/// The share of boxes, as a divisor, below which rapier moves leaves one by one.
const FEW: usize = 16;

/// Rapier's margin, as a share of a typical box.
const MARGIN: f32 = 0.04;

macro_rules! parry_bvh {
    ($module:ident, $parry:ident, $dimension:literal) => {
        pub mod $module {
            use std::ops::ControlFlow;

            use $parry::bounding_volume::{Aabb, BoundingVolume};
            use $parry::partitioning::{Bvh, BvhBuildStrategy, BvhLeafUpdateStatus, BvhWorkspace};

            use super::{FEW, MARGIN};
            use crate::peer::{Bounds, Follower, Frame, Pairs, Searcher};

            fn aabb_of(bounds: &Bounds<$dimension>) -> Aabb {
                Aabb::new(bounds.min.into(), bounds.max.into())
            }

            #[derive(Default)]
            pub struct BvhSearcher {
                bvh: Bvh,
                other: Bvh, // the right set's, if there are two
                workspace: BvhWorkspace,
                aabbs: Vec<Aabb>,
            }

            impl BvhSearcher {
                fn tree_of(&mut self, boxes: &[Bounds<$dimension>]) -> Bvh {
                    self.aabbs.clear();
                    self.aabbs.extend(boxes.iter().map(aabb_of));
                    Bvh::from_leaves(BvhBuildStrategy::Binned, &self.aabbs)
                }
            }

            impl Searcher<$dimension> for BvhSearcher {
                fn search(&mut self, boxes: &[Bounds<$dimension>], _: f32, pairs: &mut Pairs) -> ControlFlow<()> {
                    self.bvh = self.tree_of(boxes);
                    let mut flow = ControlFlow::Continue(());
                    self.bvh.traverse_bvtt_single_tree::<false>(&mut self.workspace, &mut |a, b| {
                        if flow.is_continue() {
                            flow = pairs.add(a, b);
                        }
                    });
                    flow
                }

                fn join(
                    &mut self,
                    boxes: &[Bounds<$dimension>],
                    left_count: usize,
                    _: f32,
                    pairs: &mut Pairs,
                ) -> ControlFlow<()> {
                    let (left, right) = boxes.split_at(left_count);
                    self.bvh = self.tree_of(left);
                    self.other = self.tree_of(right);
                    let meet = |a: u32, b: u32| aabb_of(&left[a as usize]).intersects(&aabb_of(&right[b as usize]));
                    // parry does not compare the root of a tree of one leaf.
                    let one_leaf = left.len() == 1 || right.len() == 1;
                    for (a, b) in self.bvh.leaf_pairs(&self.other, |a, b| a.intersects(b)) {
                        if one_leaf && !meet(a, b) {
                            continue;
                        }
                        pairs.add(a, left_count as u32 + b)?;
                    }
                    ControlFlow::Continue(())
                }

                fn tear_down(&mut self) {
                    self.bvh = Bvh::new();
                    self.other = Bvh::new();
                }
            }

            #[derive(Default)]
            pub struct BvhFollower {
                bvh: Bvh,
                workspace: BvhWorkspace,
                margin: f32,
                pairs: Vec<(u32, u32)>, // of enlarged boxes
                moved: Vec<bool>,       // by id: whether the leaf was moved in this frame
                moved_before: Vec<u32>,
                moved_now: Vec<u32>,
            }

            impl Follower<$dimension> for BvhFollower {
                fn build(&mut self, boxes: &[Bounds<$dimension>], length: f32) {
                    self.margin = MARGIN * length;
                    let enlarged = |(id, bounds): (usize, &Bounds<$dimension>)| {
                        let mut aabb = aabb_of(bounds);
                        aabb.mins -= $parry::math::Vector::splat(self.margin);
                        aabb.maxs += $parry::math::Vector::splat(self.margin);
                        (id, aabb)
                    };
                    let present = boxes.iter().enumerate().filter(|(_, bounds)| bounds.is_present());
                    self.bvh = if present.clone().nth(2).is_some() {
                        Bvh::from_iter(BvhBuildStrategy::Binned, present.map(enlarged))
                    } else {
                        // Of one or two leaves, from_iter() takes the ids for 0 and 1.
                        let mut bvh = Bvh::new();
                        present.map(enlarged).for_each(|(id, aabb)| bvh.insert(aabb, id as u32));
                        bvh
                    };
                    // The first makes leaves that were added changed ones, the second unchanged ones.
                    self.bvh.refit(&mut self.workspace);
                    self.bvh.refit(&mut self.workspace);
                    self.moved_before.clear();
                    self.pairs.clear();
                    let pairs = &mut self.pairs;
                    let mut add = |a, b| pairs.push((a, b));
                    self.bvh.traverse_bvtt_single_tree::<false>(&mut self.workspace, &mut add);
                }

                fn update(&mut self, frame: &Frame<$dimension>, pairs: &mut Pairs) -> ControlFlow<()> {
                    self.moved.clear();
                    self.moved.resize(frame.boxes.len(), false);
                    self.moved_now.clear();
                    let leaves = self.bvh.leaf_count() as usize;
                    let few = frame.changed.len() * FEW < leaves;
                    let mut removed = false;
                    for &id in frame.changed {
                        let bounds = &frame.boxes[id as usize];
                        if bounds.is_present() {
                            let aabb = aabb_of(bounds);
                            let status = if few {
                                self.bvh.reinsert_or_update_with_change_detection(aabb, id, self.margin)
                            } else {
                                self.bvh.insert_or_update_partially(aabb, id, self.margin)
                            };
                            if status == BvhLeafUpdateStatus::Unchanged {
                                continue;
                            }
                            self.moved_now.push(id);
                        } else {
                            self.bvh.remove(id);
                            removed = true;
                        }
                        self.moved[id as usize] = true;
                    }
                    let impacted = self.moved_now.len() + self.moved_before.len();
                    if removed || impacted * FEW >= leaves {
                        if !few {
                            self.bvh.optimize_incremental(&mut self.workspace);
                        }
                        self.bvh.refit(&mut self.workspace);
                    } else {
                        self.bvh.refit_partial(&self.moved_before, &self.moved_now);
                    }
                    std::mem::swap(&mut self.moved_before, &mut self.moved_now);

                    let mut flow = ControlFlow::Continue(());
                    let moved = &self.moved;
                    self.pairs.retain(|&(a, b)| {
                        if flow.is_continue() && frame.has_changed((a, b)) {
                            flow = pairs.add(a, b);
                        }
                        !(moved[a as usize] || moved[b as usize])
                    });
                    let kept = &mut self.pairs;
                    self.bvh.traverse_bvtt_single_tree::<true>(&mut self.workspace, &mut |a, b| {
                        kept.push((a, b));
                        if flow.is_continue() {
                            flow = pairs.add(a, b);
                        }
                    });
                    flow
                }
            }
        }
    };
}

parry_bvh!(flat, parry2d, 2);
parry_bvh!(solid, parry3d, 3);
