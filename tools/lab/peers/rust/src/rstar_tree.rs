//! rstar: an R*-tree, bulk loaded and joined with itself or with another.

use std::ops::ControlFlow;

use rstar::{PointDistance, RTree, RTreeObject, AABB};

use crate::peer::{Bounds, Pairs, Searcher};

pub struct Leaf<const D: usize> {
    pub id: u32,
    envelope: AABB<[f32; D]>,
}

impl<const D: usize> RTreeObject for Leaf<D> {
    type Envelope = AABB<[f32; D]>;

    fn envelope(&self) -> Self::Envelope {
        self.envelope
    }
}

impl<const D: usize> PointDistance for Leaf<D> {
    fn distance_2(&self, point: &[f32; D]) -> f32 {
        self.envelope.distance_2(point)
    }
}

pub type Tree<const D: usize> = RTree<Leaf<D>>;

/// A tree of the boxes, whose ids count from `first`.
pub fn tree_of<const D: usize>(boxes: &[Bounds<D>], first: usize) -> Tree<D> {
    let leaf = |(id, bounds): (usize, &Bounds<D>)| Leaf {
        id: (first + id) as u32,
        envelope: AABB::from_corners(bounds.min, bounds.max),
    };
    RTree::bulk_load(boxes.iter().enumerate().map(leaf).collect())
}

#[derive(Default)]
pub struct TreeSearcher<const D: usize>(Vec<Tree<D>>); // of the last search

impl<const D: usize> Searcher<D> for TreeSearcher<D> {
    fn search(&mut self, boxes: &[Bounds<D>], _: f32, pairs: &mut Pairs) -> ControlFlow<()> {
        self.0 = vec![tree_of(boxes, 0)];
        // The join reports a pair both ways round, and each box with itself.
        for (a, b) in self.0[0].intersection_candidates_with_other_tree(&self.0[0]) {
            if a.id < b.id {
                pairs.add(a.id, b.id)?;
            }
        }
        ControlFlow::Continue(())
    }

    fn join(&mut self, boxes: &[Bounds<D>], left_count: usize, _: f32, pairs: &mut Pairs) -> ControlFlow<()> {
        let (left, right) = boxes.split_at(left_count);
        self.0 = vec![tree_of(left, 0), tree_of(right, left_count)];
        for (a, b) in self.0[0].intersection_candidates_with_other_tree(&self.0[1]) {
            pairs.add(a.id, b.id)?;
        }
        ControlFlow::Continue(())
    }

    fn tear_down(&mut self) {
        self.0.clear();
    }
}
