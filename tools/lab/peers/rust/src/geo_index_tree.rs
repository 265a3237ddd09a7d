//! geo-index: an R-tree packed along a Hilbert curve, after flatbush, joined with itself or with another.

use std::ops::ControlFlow;

use geo_index::rtree::sort::HilbertSort;
use geo_index::rtree::{RTree, RTreeBuilder, RTreeIndex};

use crate::peer::{Bounds, Pairs, Searcher};

pub fn tree_of(boxes: &[Bounds<2>]) -> RTree<f32> {
    let mut builder = RTreeBuilder::<f32>::new(boxes.len() as u32);
    for Bounds { min, max } in boxes {
        builder.add(min[0], min[1], max[0], max[1]);
    }
    builder.finish::<HilbertSort>()
}

#[derive(Default)]
pub struct TreeSearcher(Vec<RTree<f32>>); // of the last search

impl Searcher<2> for TreeSearcher {
    fn search(&mut self, boxes: &[Bounds<2>], _: f32, pairs: &mut Pairs) -> ControlFlow<()> {
        self.0 = vec![tree_of(boxes)];
        // The join reports a pair both ways round, and each box with itself.
        for (a, b) in self.0[0].intersection_candidates_with_other_tree(&self.0[0]) {
            if a < b {
                pairs.add(a, b)?;
            }
        }
        ControlFlow::Continue(())
    }

    fn join(&mut self, boxes: &[Bounds<2>], left_count: usize, _: f32, pairs: &mut Pairs) -> ControlFlow<()> {
        let (left, right) = boxes.split_at(left_count);
        self.0 = vec![tree_of(left), tree_of(right)];
        for (a, b) in self.0[0].intersection_candidates_with_other_tree(&self.0[1]) {
            pairs.add(a, left_count as u32 + b)?;
        }
        ControlFlow::Continue(())
    }

    fn tear_down(&mut self) {
        self.0.clear();
    }
}
