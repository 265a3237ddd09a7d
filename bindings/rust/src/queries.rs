use std::fmt::Debug;
use std::os::raw::{c_int, c_void};
use std::ptr;

use crate::boxes::address_of;
use crate::error::{call, collect};
use crate::{ffi, Bounds, Error, Filter, Handle};

/// A box that a ray or a moving box hits.
///
/// ```
/// let hit = broadside::Hit { id: 3_u32, t_enter: 0.5 };
/// assert_eq!(hit.id, 3);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit<Id> {
    /// The box: a place in the slice, or a world's handle.
    pub id: Id,
    /// The least `t` at which `from + t * direction` overlaps it.
    pub t_enter: f64,
}

/// A box, and how far it is.
///
/// ```
/// let neighbour = broadside::Neighbour { id: 3_u32, distance_squared: 25.0 };
/// assert_eq!(neighbour.distance_squared.sqrt(), 5.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbour<Id> {
    /// The box: a place in the slice, or a world's handle.
    pub id: Id,
    /// The square of its distance; 0 for boxes that overlap.
    pub distance_squared: f64,
}

/// What queries are asked of: an [`crate::Index`], whose boxes are named by `u32` places, or a [`crate::World`], whose
/// boxes are named by [`Handle`]s.
///
/// ```
/// use broadside::{Bounds, Queried, Query};
///
/// fn is_free<Q: Queried>(query: Query<'_, Q>, place: Q::Bounds) -> bool {
///     query.overlapping(place).unwrap().is_empty()
/// }
/// let index = broadside::Index::new(&[broadside::Box2::point([0.0, 0.0])])?;
/// assert!(is_free(index.query(), broadside::Box2::point([1.0, 1.0])));
/// # Ok::<(), broadside::Error>(())
/// ```
pub trait Queried: sealed::Sealed {
    /// The type of its boxes.
    type Bounds: Bounds;
    /// What names a box.
    type Id: sealed::Name;

    #[doc(hidden)]
    type Raw;
    #[doc(hidden)]
    const CALLS: sealed::Calls<Self::Raw, Self::Id>;
    #[doc(hidden)]
    fn raw(&self) -> *const Self::Raw;
    #[doc(hidden)]
    fn boxes(&self) -> usize;
}

pub(crate) mod sealed {
    use super::*;

    pub trait Sealed {}

    /// The functions of the C interface for one class.
    #[rustfmt::skip]
    pub struct Calls<Raw, Id> {
        pub overlapping: unsafe extern "C" fn(*const Raw, *const c_void, *const ffi::Query, *mut Id, usize, *mut usize, *mut ffi::Error) -> ffi::Status,
        pub hits: unsafe extern "C" fn(*const Raw, *const c_void, *const c_void, f64, *const ffi::Query, *mut ffi::Hit, usize, *mut usize, *mut ffi::Error) -> ffi::Status,
        pub first_hit: unsafe extern "C" fn(*const Raw, *const c_void, *const c_void, f64, *const ffi::Query, *mut ffi::Hit, *mut c_int, *mut ffi::Error) -> ffi::Status,
        pub nearest_to_box: unsafe extern "C" fn(*const Raw, *const c_void, f64, *const ffi::Query, *mut ffi::Neighbour, usize, *mut usize, *mut ffi::Error) -> ffi::Status,
    }

    pub trait Name: Copy + Debug + 'static {
        fn of(handle: Handle) -> Self;
        fn leave_out(this: &Self, query: &mut ffi::Query);
    }

    impl Name for Handle {
        fn of(handle: Handle) -> Self {
            handle
        }
        fn leave_out(this: &Self, query: &mut ffi::Query) {
            query.except = this;
        }
    }

    impl Name for u32 {
        fn of(handle: Handle) -> Self {
            handle.slot
        }
        fn leave_out(this: &Self, query: &mut ffi::Query) {
            query.except_place = this;
        }
    }
}

use sealed::Name;

/// Asks an [`crate::Index`] or a [`crate::World`] about its boxes. A point is a box of equal minima and maxima.
///
/// ```
/// use broadside::{Box2, Filter, Index};
///
/// let index = Index::new(&[0.0, 1.0, 2.0].map(|x| Box2::new([x, 0.0], [x + 1.0, 1.0])))?;
/// let at = Box2::point([1.0, 0.5]);
/// assert_eq!(index.query().overlapping(at)?.len(), 2);
/// assert_eq!(index.query().except(0).overlapping(at)?, [1]);
/// assert!(index.query().filter(Filter { mask: 0, ..Default::default() }).overlapping(at)?.is_empty());
/// # Ok::<(), broadside::Error>(())
/// ```
pub struct Query<'a, Q: Queried> {
    of: &'a Q,
    filter: Option<ffi::Filter>,
    except: Option<Q::Id>,
}

impl<Q: Queried> std::fmt::Debug for Query<'_, Q> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("Query").finish_non_exhaustive()
    }
}

impl<'a, Q: Queried> Query<'a, Q> {
    pub(crate) fn new(of: &'a Q) -> Self {
        Query { of, filter: None, except: None }
    }

    /// Only boxes whose filter accepts this one are found.
    ///
    /// ```
    /// # use broadside::{Box2, Filter, World};
    /// let world = World::<Box2>::new()?;
    /// let bullets = Filter { category: 2, ..Default::default() };
    /// assert!(world.query().filter(bullets).overlapping(Box2::point([0.0, 0.0]))?.is_empty());
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn filter(mut self, filter: Filter) -> Self {
        self.filter = Some((&filter).into());
        self
    }

    /// This box is left out, such as the one that a ray starts from.
    ///
    /// ```
    /// # use broadside::{Box2, Index};
    /// let index = Index::new(&[Box2::point([0.0, 0.0]); 2])?;
    /// assert_eq!(index.query().except(1).nearest(Box2::point([0.0, 0.0]), 2)?.len(), 1);
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn except(mut self, id: Q::Id) -> Self {
        self.except = Some(id);
        self
    }

    /// Valid as long as `self` stays where it is.
    fn raw(&self) -> ffi::Query {
        let mut query = ffi::Query { filter: ptr::null(), except: ptr::null(), except_place: ptr::null() };
        if let Some(filter) = &self.filter {
            query.filter = filter;
        }
        if let Some(id) = &self.except {
            Q::Id::leave_out(id, &mut query);
        }
        query
    }

    /// The boxes that overlap `bounds`, in an order that means nothing.
    ///
    /// ```
    /// # use broadside::{Box3, Index};
    /// let index = Index::new(&[Box3::point([0.0; 3]), Box3::point([9.0; 3])])?;
    /// assert_eq!(index.query().overlapping(Box3::new([5.0; 3], [9.0; 3]))?, [1]);
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn overlapping(&self, bounds: Q::Bounds) -> Result<Vec<Q::Id>, Error> {
        let query = self.raw();
        // SAFETY: all pointers live through the call, which writes at most `room` elements.
        collect(64, |ids, room, count, error| unsafe {
            (Q::CALLS.overlapping)(self.of.raw(), address_of(&bounds), &query, ids, room, count, error)
        })
    }

    /// All boxes that `from` hits if it moves along `direction`, up to the parameter `t_max`. A ray is a point in
    /// motion.
    ///
    /// ```
    /// # use broadside::{Box2, Index};
    /// let index = Index::new(&[1.0, 2.0, 3.0].map(|x| Box2::point([x, 0.0])))?;
    /// let hits = index.query().hits(Box2::point([0.0, 0.0]), [1.0, 0.0], 2.0)?;
    /// assert_eq!(hits.len(), 2);
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn hits(
        &self,
        from: Q::Bounds,
        direction: impl Into<<Q::Bounds as Bounds>::Point>,
        t_max: f64,
    ) -> Result<Vec<Hit<Q::Id>>, Error> {
        let (query, direction) = (self.raw(), direction.into());
        // SAFETY: as above.
        let hits = collect(64, |hits, room, count, error| unsafe {
            let (from, direction) = (address_of(&from), address_of(&direction));
            (Q::CALLS.hits)(self.of.raw(), from, direction, t_max, &query, hits, room, count, error)
        })?;
        Ok(hits.into_iter().map(hit_of).collect())
    }

    /// The box that it hits first.
    ///
    /// ```
    /// # use broadside::{Box2, Index};
    /// let index = Index::new(&[Box2::new([4.0, -1.0], [5.0, 1.0])])?;
    /// let hit = index.query().first_hit(Box2::point([0.0, 0.0]), [2.0, 0.0], f64::INFINITY)?;
    /// assert_eq!(hit.map(|hit| hit.t_enter), Some(2.0));
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn first_hit(
        &self,
        from: Q::Bounds,
        direction: impl Into<<Q::Bounds as Bounds>::Point>,
        t_max: f64,
    ) -> Result<Option<Hit<Q::Id>>, Error> {
        let (query, direction) = (self.raw(), direction.into());
        let mut hit = ffi::Hit { handle: Handle::default(), t_enter: 0.0 };
        let mut found = 0;
        // SAFETY: as above.
        call(|error| unsafe {
            let (from, direction) = (address_of(&from), address_of(&direction));
            (Q::CALLS.first_hit)(self.of.raw(), from, direction, t_max, &query, &mut hit, &mut found, error)
        })?;
        Ok(if found == 0 { None } else { Some(hit_of(hit)) })
    }

    /// The `k` boxes nearest to `from`, or all if there are fewer: by distance, then by place or slot.
    ///
    /// ```
    /// # use broadside::{DoubleBox2, Index};
    /// let index = Index::new(&[DoubleBox2::point([0.0, 0.0]), DoubleBox2::point([3.0, 4.0])])?;
    /// let nearest = index.query().nearest(DoubleBox2::point([3.0, 3.0]), 1)?;
    /// assert_eq!((nearest[0].id, nearest[0].distance_squared), (1, 1.0));
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn nearest(&self, from: Q::Bounds, k: usize) -> Result<Vec<Neighbour<Q::Id>>, Error> {
        self.nearest_within(from, k, f64::INFINITY)
    }

    /// The same, of the boxes that are not farther than `max_distance`.
    ///
    /// ```
    /// # use broadside::{Box2, Index};
    /// let index = Index::new(&[Box2::point([3.0, 4.0])])?;
    /// assert_eq!(index.query().nearest_within(Box2::point([0.0, 0.0]), 9, 5.0)?.len(), 1);
    /// assert!(index.query().nearest_within(Box2::point([0.0, 0.0]), 9, 4.9)?.is_empty());
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn nearest_within(&self, from: Q::Bounds, k: usize, max_distance: f64) -> Result<Vec<Neighbour<Q::Id>>, Error> {
        let query = self.raw();
        let k = k.min(self.of.boxes()); // room for more would be allocated in vain
                                        // SAFETY: as above.
        let neighbours = collect(k, |neighbours: *mut ffi::Neighbour, _, count, error| unsafe {
            (Q::CALLS.nearest_to_box)(
                self.of.raw(),
                address_of(&from),
                max_distance,
                &query,
                neighbours,
                k,
                count,
                error,
            )
        })?;
        let converted = neighbours
            .into_iter()
            .map(|one| Neighbour { id: Q::Id::of(one.handle), distance_squared: one.distance_squared });
        Ok(converted.collect())
    }
}

fn hit_of<Id: Name>(hit: ffi::Hit) -> Hit<Id> {
    Hit { id: Id::of(hit.handle), t_enter: hit.t_enter }
}
