//! packed_spatial_index: an R-tree packed along a Hilbert curve, joined with itself. It stores doubles.

use std::ops::ControlFlow;

use packed_spatial_index::{Box2D, Box3D, Index2D, Index2DBuilder, Index3D, Index3DBuilder};

use crate::peer::{Bounds, Pairs, Searcher};

#[derive(Default)]
pub struct Searcher2(Option<Index2D>);

impl Searcher<2> for Searcher2 {
    fn search(&mut self, boxes: &[Bounds<2>], _: f32, pairs: &mut Pairs) -> ControlFlow<()> {
        let mut builder = Index2DBuilder::new(boxes.len());
        for Bounds { min, max } in boxes {
            builder.add(Box2D::new(min[0].into(), min[1].into(), max[0].into(), max[1].into()));
        }
        let index = self.0.insert(builder.finish().expect("an index of valid boxes"));
        index.pairs_each(|a, b| pairs.add(a as u32, b as u32))
    }

    fn tear_down(&mut self) {
        self.0 = None;
    }
}

#[derive(Default)]
pub struct Searcher3(Option<Index3D>);

impl Searcher<3> for Searcher3 {
    fn search(&mut self, boxes: &[Bounds<3>], _: f32, pairs: &mut Pairs) -> ControlFlow<()> {
        let mut builder = Index3DBuilder::new(boxes.len());
        for Bounds { min, max } in boxes {
            let [min_x, min_y, min_z] = min.map(f64::from);
            let [max_x, max_y, max_z] = max.map(f64::from);
            builder.add(Box3D::new(min_x, min_y, min_z, max_x, max_y, max_z));
        }
        let index = self.0.insert(builder.finish().expect("an index of valid boxes"));
        index.pairs_each(|a, b| pairs.add(a as u32, b as u32))
    }

    fn tear_down(&mut self) {
        self.0 = None;
    }
}
