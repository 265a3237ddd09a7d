//! packed_spatial_index: an R-tree packed along a Hilbert curve, joined with itself or with another. It stores doubles.

use std::ops::ControlFlow;

use packed_spatial_index::{Box2D, Box3D, Index2D, Index2DBuilder, Index3D, Index3DBuilder};

use rayon::ThreadPool;

use crate::peer::{pool_of, Bounds, Pairs, Searcher};

fn index_2d(boxes: &[Bounds<2>], pool: Option<&ThreadPool>) -> Index2D {
    let mut builder = Index2DBuilder::new(boxes.len()).parallel(pool.is_some());
    for Bounds { min, max } in boxes {
        builder.add(Box2D::new(min[0].into(), min[1].into(), max[0].into(), max[1].into()));
    }
    let index = match pool {
        None => builder.finish(),
        Some(pool) => pool.install(|| builder.finish()),
    };
    index.expect("an index of valid boxes")
}

fn index_3d(boxes: &[Bounds<3>], pool: Option<&ThreadPool>) -> Index3D {
    let mut builder = Index3DBuilder::new(boxes.len()).parallel(pool.is_some());
    for Bounds { min, max } in boxes {
        let [min_x, min_y, min_z] = min.map(f64::from);
        let [max_x, max_y, max_z] = max.map(f64::from);
        builder.add(Box3D::new(min_x, min_y, min_z, max_x, max_y, max_z));
    }
    let index = match pool {
        None => builder.finish(),
        Some(pool) => pool.install(|| builder.finish()),
    };
    index.expect("an index of valid boxes")
}

macro_rules! packed_index {
    ($searcher:ident, $index:ident, $build:ident, $dimension:literal) => {
        pub struct $searcher {
            pool: Option<ThreadPool>,
            indexes: Vec<$index>, // of the last search
        }

        impl $searcher {
            pub fn new(threads: usize) -> Self {
                Self { pool: pool_of(threads), indexes: Vec::new() }
            }

            fn index(&self, boxes: &[Bounds<$dimension>]) -> $index {
                $build(boxes, self.pool.as_ref())
            }
        }

        impl Searcher<$dimension> for $searcher {
            fn search(&mut self, boxes: &[Bounds<$dimension>], _: f32, pairs: &mut Pairs) -> ControlFlow<()> {
                self.indexes = vec![self.index(boxes)];
                self.indexes[0].pairs_each(|a, b| pairs.add(a as u32, b as u32))
            }

            fn join(
                &mut self,
                boxes: &[Bounds<$dimension>],
                left_count: usize,
                _: f32,
                pairs: &mut Pairs,
            ) -> ControlFlow<()> {
                let (left, right) = boxes.split_at(left_count);
                self.indexes = vec![self.index(left), self.index(right)];
                self.indexes[0].join_each(&self.indexes[1], |a, b| pairs.add(a as u32, (left_count + b) as u32))
            }

            fn tear_down(&mut self) {
                self.indexes.clear();
            }
        }
    };
}

packed_index!(Searcher2, Index2D, index_2d, 2);
packed_index!(Searcher3, Index3D, index_3d, 3);
