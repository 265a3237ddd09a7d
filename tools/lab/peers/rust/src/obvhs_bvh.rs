//! obvhs: a binary hierarchy built by PLOC, and a query for each box.
//!
//! As in the crate's example of physics, the hierarchy is built anew, with the fastest settings, in memory that
//! is kept. 2D boxes are flat at z = 0.

use std::ops::ControlFlow;

use glam::Vec3A;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

use crate::peer::{Bounds, Pairs, Searcher};

#[derive(Default)]
pub struct BvhSearcher {
    builder: PlocBuilder,
    bvh: Bvh2,
    aabbs: Vec<Aabb>,
}

fn point<const D: usize>(corner: [f32; D]) -> Vec3A {
    Vec3A::new(corner[0], corner[1], if D == 3 { corner[D - 1] } else { 0.0 })
}

fn aabb_of<const D: usize>(bounds: &Bounds<D>) -> Aabb {
    Aabb::new(point(bounds.min), point(bounds.max))
}

impl BvhSearcher {
    fn build<const D: usize>(&mut self, boxes: &[Bounds<D>]) {
        self.aabbs.clear();
        self.aabbs.extend(boxes.iter().map(aabb_of));
        let ids = (0..boxes.len() as u32).collect();
        self.builder.build_with_bvh(
            &mut self.bvh,
            PlocSearchDistance::Minimum,
            &self.aabbs,
            ids,
            SortPrecision::U64,
            0,
        );
    }
}

impl<const D: usize> Searcher<D> for BvhSearcher {
    fn search(&mut self, boxes: &[Bounds<D>], _: f32, pairs: &mut Pairs) -> ControlFlow<()> {
        self.build(boxes);
        let mut flow = ControlFlow::Continue(());
        // In the order of the leaves, so that a query finds the nodes of the previous one in the cache.
        for leaf in self.bvh.nodes.iter().filter(|node| node.is_leaf()) {
            let a = self.bvh.primitive_indices[leaf.first_index as usize];
            self.bvh.aabb_traverse(self.aabbs[a as usize], |bvh, node| {
                let node = &bvh.nodes[node as usize];
                let b = bvh.primitive_indices[node.first_index as usize]; // a leaf has one box
                if a < b {
                    flow = pairs.add(a, b);
                }
                flow.is_continue()
            });
            flow?;
        }
        flow
    }

    /// A hierarchy of the larger set, and a query for each box of the smaller one.
    fn join(&mut self, boxes: &[Bounds<D>], left_count: usize, _: f32, pairs: &mut Pairs) -> ControlFlow<()> {
        let (left, right) = boxes.split_at(left_count);
        let is_left_larger = left.len() > right.len();
        let (large, small) = if is_left_larger { (left, right) } else { (right, left) };
        let (first_large, first_small) = if is_left_larger { (0, left_count) } else { (left_count, 0) };
        self.build(large);
        let mut flow = ControlFlow::Continue(());
        for (i, bounds) in small.iter().enumerate() {
            self.bvh.aabb_traverse(aabb_of(bounds), |bvh, node| {
                let leaf = bvh.primitive_indices[bvh.nodes[node as usize].first_index as usize];
                flow = pairs.add((first_small + i) as u32, first_large as u32 + leaf);
                flow.is_continue()
            });
            flow?;
        }
        flow
    }
}
