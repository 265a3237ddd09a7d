//! geo-index: an R-tree packed along a Hilbert curve, after flatbush, and a query for each box.

use std::ops::ControlFlow;

use geo_index::rtree::sort::HilbertSort;
use geo_index::rtree::{RTree, RTreeBuilder, RTreeIndex};

use crate::peer::{Bounds, Pairs, Searcher};

#[derive(Default)]
pub struct TreeSearcher(Option<RTree<f32>>);

impl Searcher<2> for TreeSearcher {
    fn search(&mut self, boxes: &[Bounds<2>], _: f32, pairs: &mut Pairs) -> ControlFlow<()> {
        let mut builder = RTreeBuilder::<f32>::new(boxes.len() as u32);
        for Bounds { min, max } in boxes {
            builder.add(min[0], min[1], max[0], max[1]);
        }
        let tree = self.0.insert(builder.finish::<HilbertSort>());
        // The join reports a pair both ways round, and each box with itself.
        for (a, b) in tree.intersection_candidates_with_other_tree(tree) {
            if a < b {
                pairs.add(a, b)?;
            }
        }
        ControlFlow::Continue(())
    }

    fn tear_down(&mut self) {
        self.0 = None;
    }
}
