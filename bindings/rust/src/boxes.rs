use std::fmt::Debug;
use std::os::raw::c_void;

use crate::ffi;

/// An axis-aligned box: a closed interval on each axis. Boxes that touch overlap, and minima may equal maxima.
///
/// Extents may be infinite. In memory it is its minima and then its maxima.
///
/// ```
/// use broadside::{Box2, DoubleBox3};
///
/// let unit = Box2::new([0.0, 0.0], [1.0, 1.0]);
/// assert_eq!(unit, Box2::from([0.0, 0.0, 1.0, 1.0]));
/// assert_eq!(DoubleBox3::point([1.0, 2.0, 3.0]).max, [1.0, 2.0, 3.0]);
/// ```
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb<const D: usize, Real = f32> {
    /// The least coordinate on each axis.
    pub min: [Real; D],
    /// The greatest coordinate on each axis.
    pub max: [Real; D],
}

/// A box in 2D, of `f32`.
pub type Box2 = Aabb<2>;
/// A box in 3D, of `f32`.
pub type Box3 = Aabb<3>;
/// A box in 2D, of `f64`.
pub type DoubleBox2 = Aabb<2, f64>;
/// A box in 3D, of `f64`.
pub type DoubleBox3 = Aabb<3, f64>;

impl<const D: usize, Real: Copy> Aabb<D, Real> {
    /// The box between these corners. Nothing is checked here: calls that take boxes refuse invalid ones.
    ///
    /// ```
    /// const FLOOR: broadside::Box2 = broadside::Box2::new([0.0, -1.0], [100.0, 0.0]);
    /// assert_eq!(FLOOR.max, [100.0, 0.0]);
    /// ```
    pub const fn new(min: [Real; D], max: [Real; D]) -> Self {
        Aabb { min, max }
    }

    /// The box of one point, with equal minima and maxima.
    ///
    /// ```
    /// use broadside::Box2;
    /// assert!(Box2::point([1.0, 1.0]).overlaps(&Box2::new([0.0, 0.0], [1.0, 1.0])));
    /// ```
    pub const fn point(at: [Real; D]) -> Self {
        Aabb { min: at, max: at }
    }

    /// Whether the boxes overlap or touch.
    ///
    /// ```
    /// use broadside::Box2;
    /// let unit = Box2::new([0.0, 0.0], [1.0, 1.0]);
    /// assert!(!unit.overlaps(&Box2::point([1.5, 0.5])));
    /// ```
    pub fn overlaps(&self, other: &Self) -> bool
    where
        Real: PartialOrd,
    {
        (0..D).all(|axis| self.min[axis] <= other.max[axis] && other.min[axis] <= self.max[axis])
    }
}

/// A type of boxes that the library takes: [`Box2`], [`Box3`], [`DoubleBox2`] and [`DoubleBox3`].
///
/// ```
/// use broadside::{Bounds, Box2};
///
/// fn pairs_and_room<B: Bounds>(mut boxes: Vec<B>) -> usize {
///     boxes.push(B::ABSENT);
///     broadside::find_pairs(&boxes).unwrap().len()
/// }
/// assert_eq!(pairs_and_room(vec![Box2::point([0.0, 0.0]); 3]), 3);
/// ```
pub trait Bounds: sealed::Kind + Copy + Debug + PartialEq + Send + Sync + 'static {
    /// A point, a direction or a velocity: a coordinate for each axis.
    type Point: Copy;

    /// No box: it overlaps nothing, so that places in arrays can stay empty.
    const ABSENT: Self;
}

pub(crate) mod sealed {
    pub trait Kind {
        const KIND: crate::ffi::Kind;
        const DIMENSIONS: usize;
    }
}

macro_rules! bounds {
    ($dimensions:literal, $real:ident, $kind:ident) => {
        impl sealed::Kind for Aabb<$dimensions, $real> {
            const KIND: ffi::Kind = ffi::$kind;
            const DIMENSIONS: usize = $dimensions;
        }

        impl Bounds for Aabb<$dimensions, $real> {
            type Point = [$real; $dimensions];
            const ABSENT: Self = Aabb { min: [$real::INFINITY; $dimensions], max: [$real::NEG_INFINITY; $dimensions] };
        }

        impl From<[$real; 2 * $dimensions]> for Aabb<$dimensions, $real> {
            /// The minima, then the maxima.
            fn from(bounds: [$real; 2 * $dimensions]) -> Self {
                let mut converted = Self::ABSENT;
                converted.min.copy_from_slice(&bounds[..$dimensions]);
                converted.max.copy_from_slice(&bounds[$dimensions..]);
                converted
            }
        }

        impl<Vector: Into<[$real; $dimensions]>> From<(Vector, Vector)> for Aabb<$dimensions, $real> {
            /// The minima and the maxima, as arrays or as vectors of glam, nalgebra or mint.
            fn from((min, max): (Vector, Vector)) -> Self {
                Aabb { min: min.into(), max: max.into() }
            }
        }

        // SAFETY: repr(C), of floats alone, without padding.
        #[cfg(feature = "bytemuck")]
        unsafe impl bytemuck::Zeroable for Aabb<$dimensions, $real> {}
        #[cfg(feature = "bytemuck")]
        unsafe impl bytemuck::Pod for Aabb<$dimensions, $real> {}
    };
}
bounds!(2, f32, BROADSIDE_FLOAT_2D);
bounds!(3, f32, BROADSIDE_FLOAT_3D);
bounds!(2, f64, BROADSIDE_DOUBLE_2D);
bounds!(3, f64, BROADSIDE_DOUBLE_3D);

/// The boxes as the C interface takes them. The result is valid as long as the slice.
pub(crate) fn raw_boxes<B: Bounds>(boxes: &[B]) -> ffi::Boxes {
    ffi::Boxes { kind: B::KIND, first: boxes.as_ptr().cast(), count: boxes.len(), stride: 0 }
}

/// The address of coordinates.
pub(crate) fn address_of<T>(value: &T) -> *const c_void {
    (value as *const T).cast()
}
