use std::any::Any;
use std::ffi::CString;
use std::mem::MaybeUninit;
use std::ops::ControlFlow;
use std::os::raw::{c_int, c_void};
use std::panic::{catch_unwind, resume_unwind, AssertUnwindSafe};
use std::ptr;

use crate::boxes::raw_boxes;
use crate::error::{call, check_length};
use crate::{ffi, Bounds, Error};

/// Two boxes by their places in the slice, `first < second`; between two sets, a place in the left one and a place in
/// the right one.
///
/// ```
/// let pair = broadside::Pair { first: 0, second: 1 };
/// assert!(pair < broadside::Pair { first: 0, second: 2 });
/// ```
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Pair {
    /// The first box.
    pub first: u32,
    /// The second box.
    pub second: u32,
}

/// The categories of a box and the categories it collides with.
///
/// Two boxes may pair if they are not both static and the mask of each has a bit of the other's category. If both have
/// the same group other than 0, it decides instead of the bits: they pair if it is positive, and never if it is
/// negative. `Filter::default()` lets a box pair with all others.
///
/// ```
/// use broadside::{Box2, Filter, FindOptions};
///
/// let boxes = [Box2::point([0.0, 0.0]); 3];
/// let floor = Filter { is_static: true, ..Filter::default() };
/// let filters = [floor, floor, Filter::default()];
/// let pairs = FindOptions { filters: &filters, ..Default::default() }.find_pairs(&boxes)?;
/// assert_eq!(pairs.len(), 2);
/// # Ok::<(), broadside::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Filter {
    /// Bits: what the box is.
    pub category: u64,
    /// Bits: the categories that it collides with.
    pub mask: u64,
    /// Decides for boxes of the same group, unless it is 0.
    pub group: i32,
    /// Two static boxes never pair.
    pub is_static: bool,
}

impl Default for Filter {
    fn default() -> Self {
        Filter { category: 1, mask: u64::MAX, group: 0, is_static: false }
    }
}

impl From<&Filter> for ffi::Filter {
    fn from(filter: &Filter) -> Self {
        let Filter { category, mask, group, is_static } = *filter;
        ffi::Filter { category, mask, group, is_static: is_static.into() }
    }
}

impl From<ffi::Filter> for Filter {
    fn from(filter: ffi::Filter) -> Self {
        let ffi::Filter { category, mask, group, is_static } = filter;
        Filter { category, mask, group, is_static: is_static != 0 }
    }
}

/// No filters, or one for each of `boxes`.
pub(crate) fn raw_filters(name: &str, filters: &[Filter], boxes: usize) -> Result<Vec<ffi::Filter>, Error> {
    if !filters.is_empty() {
        check_length(name, filters.len(), boxes)?;
    }
    Ok(filters.iter().map(ffi::Filter::from).collect())
}

/// The elements, or null if there are none.
pub(crate) fn or_null<T>(elements: &[T]) -> *const T {
    if elements.is_empty() {
        ptr::null()
    } else {
        elements.as_ptr()
    }
}

/// A text for the library.
pub(crate) fn raw_text(name: &str, text: &str) -> Result<CString, Error> {
    CString::new(text).map_err(|_| Error::InvalidSpec(format!("{name} is {text:?}; expected a text without a 0")))
}

/// Which boxes pair: see [`find_pairs_within`]. Distances and radii are finite and at least 0.
///
/// ```
/// use broadside::{Box2, FindOptions, Reach};
///
/// let boxes = [0.0, 3.0, 9.0].map(|x| Box2::point([x, 0.0]));
/// let options = FindOptions { reach: Reach::Radii(&[1.0, 2.0, 3.0]), ..Default::default() };
/// assert_eq!(options.count_pairs(&boxes, None)?, 1); // the first two
/// # Ok::<(), broadside::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reach<'a> {
    /// Boxes that overlap: the default.
    Overlapping,
    /// Boxes whose Euclidean distance is at most this.
    Distance(f64),
    /// Boxes whose distance is at most the sum of their radii: one radius for each box.
    Radii(&'a [f64]),
    /// The same between two sets: the radii of the left one and of the right one.
    RadiiBetween(&'a [f64], &'a [f64]),
}

/// How pairs are found.
///
/// ```
/// use broadside::{Box3, FindOptions};
///
/// let boxes = [Box3::new([0.0; 3], [1.0; 3]), Box3::new([1.0; 3], [2.0; 3])];
/// let options = FindOptions { algorithm: "grid:threads=2", touching: false, ..Default::default() };
/// assert!(options.find_pairs(&boxes)?.is_empty());
/// # Ok::<(), broadside::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FindOptions<'a> {
    /// The algorithm and its settings, such as `"grid:cell=2.5"` or `"auto:threads=4"`; `"auto"` chooses.
    pub algorithm: &'a str,
    /// A filter for each box, of the left set if there are two; or none.
    pub filters: &'a [Filter],
    /// For two sets: a filter for each box of the right one, or none.
    pub right_filters: &'a [Filter],
    /// Pairs that never count; for one set alone.
    pub ignored: &'a [Pair],
    /// Whether boxes that only touch overlap: true by default.
    pub touching: bool,
    /// Whether invalid boxes pair with nothing, instead of being refused.
    pub quarantine: bool,
    /// Whether boxes pair if they overlap or within a distance.
    pub reach: Reach<'a>,
    /// Space repeats: the length of each axis, infinity for one that does not repeat. Boxes also pair around the edge.
    pub periods: &'a [f64],
}

impl Default for FindOptions<'_> {
    fn default() -> Self {
        FindOptions {
            algorithm: "auto",
            filters: &[],
            right_filters: &[],
            ignored: &[],
            touching: true,
            quarantine: false,
            reach: Reach::Overlapping,
            periods: &[],
        }
    }
}

/// Options as the C interface takes them, and what they point to.
pub(crate) struct RawOptions {
    pub raw: ffi::FindOptions,
    _algorithm: CString,
    _filters: [Vec<ffi::Filter>; 2],
}

impl RawOptions {
    /// Those that all calls have.
    pub fn new(algorithm: &str, touching: bool, quarantine: bool) -> Result<Self, Error> {
        let algorithm = raw_text("algorithm", algorithm)?;
        let mut raw = MaybeUninit::uninit();
        // SAFETY: the call writes all of it.
        let mut raw: ffi::FindOptions = unsafe {
            ffi::broadside_find_options_init(raw.as_mut_ptr());
            raw.assume_init()
        };
        raw.algorithm = algorithm.as_ptr();
        raw.leaves_out_touching = (!touching).into();
        raw.quarantines = quarantine.into();
        Ok(RawOptions { raw, _algorithm: algorithm, _filters: [Vec::new(), Vec::new()] })
    }
}

impl FindOptions<'_> {
    /// Refuses what is not as long as the library will read. The result is valid as long as these options.
    fn raw<B: Bounds>(&self, left: &[B], right: Option<&[B]>) -> Result<RawOptions, Error> {
        let mut all = RawOptions::new(self.algorithm, self.touching, self.quarantine)?;
        let right_count = right.map_or(0, <[B]>::len);
        let filters = [
            raw_filters("filters", self.filters, left.len())?,
            raw_filters("right filters", self.right_filters, right_count)?,
        ];
        all.raw.filters = or_null(&filters[0]);
        all.raw.right_filters = or_null(&filters[1]);
        all._filters = filters;
        all.raw.ignored = self.ignored.as_ptr();
        all.raw.ignored_count = self.ignored.len();
        if !self.touching && !matches!(self.reach, Reach::Overlapping) {
            let text = "touching is false with a distance or radii; expected true";
            return Err(Error::InvalidArgument(text.into()));
        }
        match self.reach {
            Reach::Overlapping => {}
            Reach::Distance(distance) => all.raw.distance = distance,
            Reach::Radii(radii) => {
                check_length("radii", radii.len(), left.len())?;
                all.raw.radii = radii.as_ptr();
            }
            Reach::RadiiBetween(radii, right_radii) => {
                check_length("radii", radii.len(), left.len())?;
                check_length("right radii", right_radii.len(), right_count)?;
                all.raw.radii = radii.as_ptr();
                all.raw.right_radii = right_radii.as_ptr();
            }
        }
        if !self.periods.is_empty() {
            if self.periods.len() != B::DIMENSIONS {
                let (found, expected) = (self.periods.len(), B::DIMENSIONS);
                return Err(Error::InvalidFrame(format!(
                    "there are {found} periods; expected {expected}, one for each axis"
                )));
            }
            all.raw.periods = self.periods.as_ptr();
        }
        Ok(all)
    }

    /// Every pair of overlapping boxes, once. The order depends only on the algorithm and the boxes.
    ///
    /// ```
    /// use broadside::{Box2, FindOptions, Pair};
    ///
    /// let boxes = [Box2::point([0.0, 0.0]); 3];
    /// let ignored = [Pair { first: 0, second: 1 }, Pair { first: 0, second: 2 }];
    /// let pairs = FindOptions { ignored: &ignored, ..Default::default() }.find_pairs(&boxes)?;
    /// assert_eq!(pairs, [Pair { first: 1, second: 2 }]);
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn find_pairs<B: Bounds>(&self, boxes: &[B]) -> Result<Vec<Pair>, Error> {
        self.collect(boxes, None)
    }

    /// Every pair of a box of `left` and an overlapping one of `right`.
    ///
    /// ```
    /// use broadside::{Box2, FindOptions};
    ///
    /// let (left, right) = ([Box2::point([359.0, 0.0])], [Box2::point([0.0, 0.0])]);
    /// let periods = [360.0, f64::INFINITY];
    /// let reach = broadside::Reach::Distance(1.0);
    /// let options = FindOptions { reach, periods: &periods, ..Default::default() };
    /// assert_eq!(options.find_pairs_between(&left, &right)?.len(), 1);
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn find_pairs_between<B: Bounds>(&self, left: &[B], right: &[B]) -> Result<Vec<Pair>, Error> {
        self.collect(left, Some(right))
    }

    fn collect<B: Bounds>(&self, left: &[B], right: Option<&[B]>) -> Result<Vec<Pair>, Error> {
        let mut pairs = Vec::with_capacity(2 * left.len());
        self.for_each_pairs(left, right, |chunk| {
            pairs.extend_from_slice(chunk);
            ControlFlow::Continue(())
        })?;
        Ok(pairs)
    }

    /// Calls `take` with the pairs, chunk by chunk, so that they are never all in memory. `right` is the second of two
    /// sets. `ControlFlow::Break` stops the search, which is no error. If `take` panics, the search ends first.
    ///
    /// ```
    /// use broadside::{Box2, FindOptions};
    /// use std::ops::ControlFlow;
    ///
    /// let mut found = None;
    /// FindOptions::default().for_each_pairs(&[Box2::point([0.0, 0.0]); 5], None, |pairs| {
    ///     found = pairs.iter().copied().find(|pair| pair.second == 4);
    ///     if found.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    /// })?;
    /// assert!(found.is_some());
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn for_each_pairs<B: Bounds, Take>(&self, left: &[B], right: Option<&[B]>, take: Take) -> Result<(), Error>
    where
        Take: FnMut(&[Pair]) -> ControlFlow<()>,
    {
        struct Receiver<Take> {
            take: Take,
            panic: Option<Box<dyn Any + Send>>,
        }

        unsafe extern "C" fn receive<Take>(user: *mut c_void, pairs: *const Pair, count: usize) -> c_int
        where
            Take: FnMut(&[Pair]) -> ControlFlow<()>,
        {
            // SAFETY: `user` is the receiver below, and there are `count` pairs, more than none.
            let (receiver, pairs) =
                unsafe { (&mut *user.cast::<Receiver<Take>>(), std::slice::from_raw_parts(pairs, count)) };
            let take = &mut receiver.take;
            match catch_unwind(AssertUnwindSafe(|| take(pairs))) {
                Ok(flow) => flow.is_break().into(),
                Err(panic) => {
                    receiver.panic = Some(panic);
                    1
                }
            }
        }

        let options = self.raw(left, right)?;
        let (left, right) = (raw_boxes(left), right.map(raw_boxes));
        let right = right.as_ref().map_or(ptr::null(), |right| right as *const ffi::Boxes);
        let mut receiver = Receiver { take, panic: None };
        // SAFETY: all arrays live through the call and are as long as it reads; the callback does not unwind.
        let result = call(|error| unsafe {
            let user: *mut Receiver<Take> = &mut receiver;
            ffi::broadside_for_each_pairs(&left, right, &options.raw, receive::<Take>, user.cast(), error)
        });
        if let Some(panic) = receiver.panic {
            resume_unwind(panic);
        }
        match result {
            Err(failure) if failure.status != ffi::BROADSIDE_STOPPED => Err(failure.into()),
            _ => Ok(()),
        }
    }

    /// The number of pairs, of one set or between two, without keeping them.
    ///
    /// ```
    /// let count = broadside::FindOptions::default().count_pairs(&[broadside::Box2::point([0.0, 0.0]); 100], None)?;
    /// assert_eq!(count, 100 * 99 / 2);
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn count_pairs<B: Bounds>(&self, left: &[B], right: Option<&[B]>) -> Result<u64, Error> {
        let options = self.raw(left, right)?;
        let (left, right) = (raw_boxes(left), right.map(raw_boxes));
        let right = right.as_ref().map_or(ptr::null(), |right| right as *const ffi::Boxes);
        let mut count = 0;
        // SAFETY: all arrays live through the call and are as long as it reads.
        call(|error| unsafe { ffi::broadside_count_pairs(&left, right, &options.raw, &mut count, error) })?;
        Ok(count)
    }

    /// For each box the least place of a box in its connected component, such as a cluster of touching things. No pairs
    /// are kept.
    ///
    /// ```
    /// use broadside::{Box2, FindOptions};
    ///
    /// let boxes = [0.0, 5.0, 1.0, 2.0].map(|x| Box2::new([x, 0.0], [x + 1.0, 1.0]));
    /// assert_eq!(FindOptions::default().components(&boxes)?, [0, 1, 0, 0]);
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn components<B: Bounds>(&self, boxes: &[B]) -> Result<Vec<u32>, Error> {
        let options = self.raw(boxes, None)?;
        let mut labels = vec![0; boxes.len()];
        let boxes = raw_boxes(boxes);
        // SAFETY: as above; there is a label for each box.
        call(|error| unsafe { ffi::broadside_components(&boxes, &options.raw, labels.as_mut_ptr(), error) })?;
        Ok(labels)
    }

    /// As [`find_pairs_batch`], with these options: filters are one for each of all boxes, and ignored pairs are left
    /// out in every world. With several threads (`"auto:threads=0"` takes all), the threads share the worlds.
    ///
    /// ```
    /// use broadside::{Box2, FindOptions};
    ///
    /// let boxes = [Box2::point([0.0, 0.0]); 4];
    /// let options = FindOptions { algorithm: "auto:threads=0", ..Default::default() };
    /// assert_eq!(options.find_pairs_batch(&boxes, &[0, 2, 4])?.pairs.len(), 2);
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn find_pairs_batch<B: Bounds>(&self, boxes: &[B], offsets: &[usize]) -> Result<BatchPairs, Error> {
        let options = self.raw(boxes, None)?;
        if offsets.is_empty() {
            return Err(Error::InvalidFrame("there are 0 offsets; expected one more than worlds".into()));
        }
        let mut pair_offsets = vec![0; offsets.len()];
        let room = 4 * boxes.len(); // more pairs than this are found twice
        let mut pairs = Vec::with_capacity(room);
        let boxes = raw_boxes(boxes);
        loop {
            // SAFETY: as above; both arrays of offsets have one more than there are worlds.
            let found = call(|error| unsafe {
                let (offsets, worlds) = (offsets.as_ptr(), offsets.len() - 1);
                let (pairs, room) = (pairs.as_mut_ptr(), pairs.capacity());
                let pair_offsets = pair_offsets.as_mut_ptr();
                ffi::broadside_find_pairs_batch(&boxes, offsets, worlds, &options.raw, pairs, room, pair_offsets, error)
            });
            let count = pair_offsets[offsets.len() - 1];
            match found {
                Ok(()) => {
                    // SAFETY: the call has written that many.
                    unsafe { pairs.set_len(count) };
                    return Ok(BatchPairs { pairs, offsets: pair_offsets });
                }
                Err(failure) if failure.status == ffi::BROADSIDE_TOO_SMALL => pairs.reserve_exact(count),
                Err(failure) => return Err(failure.into()),
            }
        }
    }
}

/// Every pair of overlapping boxes, once, by `auto`. [`FindOptions`] has other algorithms, filters and more.
///
/// ```
/// use broadside::{find_pairs, Box2, Pair};
///
/// let boxes = [[0.0, 0.0, 2.0, 2.0], [1.0, 1.0, 3.0, 3.0], [5.0, 5.0, 6.0, 6.0]].map(Box2::from);
/// assert_eq!(find_pairs(&boxes)?, [Pair { first: 0, second: 1 }]);
/// # Ok::<(), broadside::Error>(())
/// ```
pub fn find_pairs<B: Bounds>(boxes: &[B]) -> Result<Vec<Pair>, Error> {
    FindOptions::default().find_pairs(boxes)
}

/// Every pair of a box of `left` and an overlapping one of `right`, by `auto`.
///
/// ```
/// use broadside::{find_pairs_between, Box2, Pair};
///
/// let zones = [Box2::new([0.0, 0.0], [10.0, 10.0]), Box2::new([10.0, 0.0], [20.0, 10.0])];
/// let guests = [Box2::point([12.0, 3.0])];
/// assert_eq!(find_pairs_between(&zones, &guests)?, [Pair { first: 1, second: 0 }]);
/// # Ok::<(), broadside::Error>(())
/// ```
pub fn find_pairs_between<B: Bounds>(left: &[B], right: &[B]) -> Result<Vec<Pair>, Error> {
    FindOptions::default().find_pairs_between(left, right)
}

/// Every pair of boxes within a Euclidean distance, exactly, such as atoms within a cutoff.
///
/// ```
/// use broadside::{find_pairs_within, Box2, Reach};
///
/// let atoms = [[0.0, 0.0], [3.0, 4.0], [9.0, 4.0]].map(Box2::point);
/// assert_eq!(find_pairs_within(&atoms, Reach::Distance(5.0))?.len(), 1);
/// assert_eq!(find_pairs_within(&atoms, Reach::Radii(&[1.0, 4.0, 2.0]))?.len(), 2);
/// # Ok::<(), broadside::Error>(())
/// ```
pub fn find_pairs_within<B: Bounds>(boxes: &[B], reach: Reach<'_>) -> Result<Vec<Pair>, Error> {
    FindOptions { reach, ..FindOptions::default() }.find_pairs(boxes)
}

/// The pairs of many small worlds in one call: world `i` has the boxes `offsets[i]..offsets[i + 1]`.
///
/// ```
/// use broadside::{find_pairs_batch, Box2, Pair};
///
/// let boxes = [Box2::point([0.0, 0.0]); 5];
/// let found = find_pairs_batch(&boxes, &[0, 2, 3, 5])?;
/// assert_eq!(found.of(2), [Pair { first: 0, second: 1 }]); // places from the world's first box
/// assert_eq!(found.iter().map(<[Pair]>::len).collect::<Vec<_>>(), [1, 0, 1]);
/// # Ok::<(), broadside::Error>(())
/// ```
pub fn find_pairs_batch<B: Bounds>(boxes: &[B], offsets: &[usize]) -> Result<BatchPairs, Error> {
    FindOptions::default().find_pairs_batch(boxes, offsets)
}

/// The pairs of many worlds: see [`find_pairs_batch`].
///
/// ```
/// let found = broadside::find_pairs_batch(&[broadside::Box2::point([0.0, 0.0]); 4], &[0, 2, 4])?;
/// assert_eq!((found.pairs.len(), found.offsets.as_slice()), (2, &[0, 1, 2][..]));
/// # Ok::<(), broadside::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BatchPairs {
    /// The pairs, world by world.
    pub pairs: Vec<Pair>,
    /// Where each world's pairs begin and, last, how many there are.
    pub offsets: Vec<usize>,
}

impl BatchPairs {
    /// The pairs of a world. Panics if there is no such world.
    ///
    /// ```
    /// let found = broadside::find_pairs_batch::<broadside::Box2>(&[], &[0, 0])?;
    /// assert!(found.of(0).is_empty());
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn of(&self, world: usize) -> &[Pair] {
        &self.pairs[self.offsets[world]..self.offsets[world + 1]]
    }

    /// The pairs of each world.
    ///
    /// ```
    /// let found = broadside::find_pairs_batch(&[broadside::Box2::point([0.0, 0.0])], &[0, 0, 1])?;
    /// assert_eq!(found.iter().count(), 2);
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn iter(&self) -> impl Iterator<Item = &[Pair]> + '_ {
        self.offsets.windows(2).map(move |ends| &self.pairs[ends[0]..ends[1]])
    }
}
