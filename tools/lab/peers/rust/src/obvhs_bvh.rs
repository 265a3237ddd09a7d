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

impl<const D: usize> Searcher<D> for BvhSearcher {
    fn search(&mut self, boxes: &[Bounds<D>], _: f32, pairs: &mut Pairs) -> ControlFlow<()> {
        self.aabbs.clear();
        self.aabbs.extend(boxes.iter().map(|bounds| Aabb::new(point(bounds.min), point(bounds.max))));
        let ids = (0..boxes.len() as u32).collect();
        self.builder.build_with_bvh(
            &mut self.bvh,
            PlocSearchDistance::Minimum,
            &self.aabbs,
            ids,
            SortPrecision::U64,
            0,
        );
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
}
