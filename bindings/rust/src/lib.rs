//! Broadside finds every pair of overlapping axis-aligned boxes, in 2D and 3D, in `f32` and `f64`, in one call or frame
//! after frame, and answers queries. It is a C++ library, which `build.rs` builds: `docs/rust.md` says what that takes.
//!
//! ```
//! use broadside::{find_pairs, Box2};
//!
//! let boxes = [[0.0, 0.0, 2.0, 2.0], [1.0, 1.0, 3.0, 3.0], [5.0, 5.0, 6.0, 6.0]].map(Box2::from);
//! for pair in find_pairs(&boxes)? {
//!     println!("{} and {}", pair.first, pair.second); // 0 and 1
//! }
//! # Ok::<(), broadside::Error>(())
//! ```
//!
//! | for | there is |
//! |---|---|
//! | all pairs, of one set or two, or within a distance | [`find_pairs`], [`find_pairs_between`], [`find_pairs_within`]; [`FindOptions`] |
//! | many small worlds in one call | [`find_pairs_batch`] |
//! | a slice of boxes in motion | [`Tracker`] |
//! | boxes that come, move and go, as in a game | [`World`] |
//! | queries | [`Index`] over a slice, or [`World::query`] |
//!
//! Boxes are closed: boxes that touch overlap. Results are exact in the type of the coordinates, and the same in the
//! same order for any number of threads. A call that fails has changed nothing. No call panics because of its
//! arguments.
//!
//! The feature `bytemuck` makes boxes, pairs and handles `Pod`.
#![deny(missing_docs, unsafe_op_in_unsafe_fn)]

/// What the types that own an object of the library have in common.
macro_rules! owns {
    ($owner:ident, $destroy:ident) => {
        // SAFETY: the object belongs to no thread. Several threads may call what takes it as const, which `&self` does.
        unsafe impl<B: Bounds> Send for $owner<B> {}
        unsafe impl<B: Bounds> Sync for $owner<B> {}

        impl<B: Bounds> std::fmt::Debug for $owner<B> {
            fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                formatter.debug_struct(stringify!($owner)).finish_non_exhaustive()
            }
        }

        impl<B: Bounds> Drop for $owner<B> {
            fn drop(&mut self) {
                // SAFETY: the owner made it, and it is destroyed once.
                unsafe { ffi::$destroy(self.raw.as_ptr()) }
            }
        }
    };
}

mod boxes;
mod error;
#[allow(dead_code)] // structs have all their fields
mod ffi;
mod index;
mod pairs;
mod queries;
mod tracker;
mod world;

pub use boxes::{Aabb, Bounds, Box2, Box3, DoubleBox2, DoubleBox3};
pub use error::Error;
pub use index::Index;
pub use pairs::{
    find_pairs, find_pairs_batch, find_pairs_between, find_pairs_within, BatchPairs, Filter, FindOptions, Pair, Reach,
};
pub use queries::{Hit, Neighbour, Queried, Query};
pub use tracker::{Frame, PairEvents, Tracker, TrackerOptions};
pub use world::{Events, Handle, HandlePair, World, WorldOptions};

/// The library's version.
///
/// ```
/// assert_eq!(broadside::version(), env!("CARGO_PKG_VERSION"));
/// ```
pub fn version() -> &'static str {
    // SAFETY: a constant of the library, of ASCII characters.
    let version = unsafe { std::ffi::CStr::from_ptr(ffi::broadside_version()) };
    version.to_str().unwrap_or("unknown")
}

// The guide's examples are tests as well.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/rust.md")]
struct Guide;
