//! A peer that always panics, for the test that it is reported.

use std::ops::ControlFlow;

use crate::peer::{Bounds, Pairs, Searcher};

pub struct PanickingSearcher;

impl Searcher<2> for PanickingSearcher {
    fn search(&mut self, boxes: &[Bounds<2>], _: f32, _: &mut Pairs) -> ControlFlow<()> {
        panic!("on purpose, with {} boxes", boxes.len());
    }
}
