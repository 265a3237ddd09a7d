//! rstar: an R*-tree, bulk loaded and joined with itself.

use std::ops::ControlFlow;

use rstar::{RTree, RTreeObject, AABB};

use crate::peer::{Bounds, Pairs, Searcher};

struct Leaf<const D: usize> {
    id: u32,
    envelope: AABB<[f32; D]>,
}

impl<const D: usize> RTreeObject for Leaf<D> {
    type Envelope = AABB<[f32; D]>;

    fn envelope(&self) -> Self::Envelope {
        self.envelope
    }
}

pub struct TreeSearcher<const D: usize>(Option<RTree<Leaf<D>>>);

impl<const D: usize> Default for TreeSearcher<D> {
    fn default() -> Self {
        Self(None)
    }
}

impl<const D: usize> Searcher<D> for TreeSearcher<D> {
    fn search(&mut self, boxes: &[Bounds<D>], _: f32, pairs: &mut Pairs) -> ControlFlow<()> {
        let leaf = |(id, bounds): (usize, &Bounds<D>)| Leaf {
            id: id as u32,
            envelope: AABB::from_corners(bounds.min, bounds.max),
        };
        let tree = self.0.insert(RTree::bulk_load(boxes.iter().enumerate().map(leaf).collect()));
        // The join reports a pair both ways round, and each box with itself.
        for (a, b) in tree.intersection_candidates_with_other_tree(tree) {
            if a.id < b.id {
                pairs.add(a.id, b.id)?;
            }
        }
        ControlFlow::Continue(())
    }

    fn tear_down(&mut self) {
        self.0 = None;
    }
}
