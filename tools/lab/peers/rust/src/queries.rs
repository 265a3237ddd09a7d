//! Queries of spatial indexes: boxes that overlap a box, that a ray hits, or that are nearest to a point.

use std::ops::ControlFlow;

use geo_index::rtree::{RTree, RTreeIndex};
use packed_spatial_index::{
    Box2D, Box3D, Index2DBuilder, Index3DBuilder, NeighborWorkspace, Point2D, Point3D, Ray2D, Ray3D, SearchWorkspace,
    SimdIndex2D, SimdIndex3D,
};
use rstar::AABB;

use crate::geo_index_tree;
use crate::peer::{Bounds, Pairs};
use crate::rstar_tree;

/// A ray: Broadside's `Ray<D>` in memory.
#[repr(C)]
pub struct Ray<const D: usize> {
    pub origin: [f32; D],
    pub direction: [f32; D],
    pub t_max: f32,
}

/// Answers queries. `query` is the number of the query, given with each box that it finds.
pub trait Index<const D: usize> {
    fn overlapping(&mut self, query: u32, bounds: &Bounds<D>, found: &mut Pairs) -> ControlFlow<()>;

    fn hits(&mut self, _query: u32, _ray: &Ray<D>, _first: bool, _found: &mut Pairs) -> ControlFlow<()> {
        panic!("no queries of rays")
    }

    /// Gives the `count` nearest boxes.
    fn nearest(&mut self, query: u32, point: &[f32; D], count: usize, found: &mut Pairs) -> ControlFlow<()>;
}

macro_rules! packed_index {
    ($name:ident, $index:ident, $builder:ident, $box:ident, $ray:ident, $point:ident, $dimension:literal, $($axis:literal),+) => {
        pub struct $name {
            index: $index,
            search: SearchWorkspace,
            nearest: NeighborWorkspace,
        }

        impl $name {
            pub fn new(boxes: &[Bounds<$dimension>]) -> Self {
                let mut builder = $builder::new(boxes.len());
                for Bounds { min, max } in boxes {
                    builder.add($box::new($(min[$axis].into(),)+ $(max[$axis].into()),+));
                }
                let index = builder.finish_simd().expect("an index of valid boxes");
                Self { index, search: SearchWorkspace::new(), nearest: NeighborWorkspace::new() }
            }
        }

        impl Index<$dimension> for $name {
            fn overlapping(&mut self, query: u32, bounds: &Bounds<$dimension>, found: &mut Pairs) -> ControlFlow<()> {
                let Bounds { min, max } = bounds;
                let query_box = $box::new($(min[$axis].into(),)+ $(max[$axis].into()),+);
                for &id in self.index.search_with(query_box, &mut self.search) {
                    found.give(query, id as u32)?;
                }
                ControlFlow::Continue(())
            }

            fn hits(&mut self, query: u32, ray: &Ray<$dimension>, first: bool, found: &mut Pairs) -> ControlFlow<()> {
                let origin = $point::new($(ray.origin[$axis].into()),+);
                let cast = $ray::new(origin, $(ray.direction[$axis].into(),)+ ray.t_max.into());
                if first {
                    return match self.index.raycast_closest_with(cast, &mut self.nearest) {
                        Some((id, _)) => found.give(query, id as u32),
                        None => ControlFlow::Continue(()),
                    };
                }
                for &id in self.index.raycast_with(cast, &mut self.search) {
                    found.give(query, id as u32)?;
                }
                ControlFlow::Continue(())
            }

            fn nearest(
                &mut self,
                query: u32,
                point: &[f32; $dimension],
                count: usize,
                found: &mut Pairs,
            ) -> ControlFlow<()> {
                let point = $point::new($(point[$axis].into()),+);
                for &id in self.index.neighbors_with(point, count, f64::INFINITY, &mut self.nearest) {
                    found.give(query, id as u32)?;
                }
                ControlFlow::Continue(())
            }
        }
    };
}

packed_index!(Packed2, SimdIndex2D, Index2DBuilder, Box2D, Ray2D, Point2D, 2, 0, 1);
packed_index!(Packed3, SimdIndex3D, Index3DBuilder, Box3D, Ray3D, Point3D, 3, 0, 1, 2);

pub struct Geo(RTree<f32>);

impl Geo {
    pub fn new(boxes: &[Bounds<2>]) -> Self {
        Self(geo_index_tree::tree_of(boxes))
    }
}

impl Index<2> for Geo {
    fn overlapping(&mut self, query: u32, Bounds { min, max }: &Bounds<2>, found: &mut Pairs) -> ControlFlow<()> {
        for id in self.0.search(min[0], min[1], max[0], max[1]) {
            found.give(query, id)?;
        }
        ControlFlow::Continue(())
    }

    fn nearest(&mut self, query: u32, point: &[f32; 2], count: usize, found: &mut Pairs) -> ControlFlow<()> {
        for id in self.0.neighbors(point[0], point[1], Some(count), None) {
            found.give(query, id)?;
        }
        ControlFlow::Continue(())
    }
}

pub struct Rstar<const D: usize>(rstar_tree::Tree<D>);

impl<const D: usize> Rstar<D> {
    pub fn new(boxes: &[Bounds<D>]) -> Self {
        Self(rstar_tree::tree_of(boxes, 0))
    }
}

impl<const D: usize> Index<D> for Rstar<D> {
    fn overlapping(&mut self, query: u32, bounds: &Bounds<D>, found: &mut Pairs) -> ControlFlow<()> {
        let envelope = AABB::from_corners(bounds.min, bounds.max);
        self.0.locate_in_envelope_intersecting_int(envelope, |leaf| found.give(query, leaf.id))
    }

    fn nearest(&mut self, query: u32, point: &[f32; D], count: usize, found: &mut Pairs) -> ControlFlow<()> {
        if count == 1 {
            // It returns early for one, where the iterator keeps a queue.
            return self
                .0
                .nearest_neighbor(*point)
                .map_or(ControlFlow::Continue(()), |leaf| found.give(query, leaf.id));
        }
        self.0.nearest_neighbor_iter(*point).take(count).try_for_each(|leaf| found.give(query, leaf.id))
    }
}

pub enum AnyIndex {
    Flat(Box<dyn Index<2>>),
    Solid(Box<dyn Index<3>>),
}

/// What `ask` finds. Queries are boxes or rays, given as numbers.
#[derive(Clone, Copy)]
#[repr(C)]
pub enum Kind {
    Boxes,
    FirstHits,
    AllHits,
}

/// # Safety
/// `queries` has `count` boxes or rays, depending on `kind`.
pub unsafe fn ask<const D: usize>(
    index: &mut dyn Index<D>,
    kind: Kind,
    queries: *const f32,
    count: usize,
    found: &mut Pairs,
) -> ControlFlow<()> {
    for i in 0..count {
        match kind {
            Kind::Boxes => index.overlapping(i as u32, &*queries.cast::<Bounds<D>>().add(i), found)?,
            _ => index.hits(i as u32, &*queries.cast::<Ray<D>>().add(i), matches!(kind, Kind::FirstHits), found)?,
        }
    }
    found.flush()
}

/// Gives the `max_results` boxes nearest to each point.
pub fn nearest<const D: usize>(
    index: &mut dyn Index<D>,
    points: &[[f32; D]],
    max_results: usize,
    found: &mut Pairs,
) -> ControlFlow<()> {
    for (i, point) in points.iter().enumerate() {
        index.nearest(i as u32, point, max_results, found)?;
    }
    found.flush()
}
