use std::marker::PhantomData;
use std::mem::MaybeUninit;
use std::ptr::{self, NonNull};

use crate::boxes::raw_boxes;
use crate::error::call;
use crate::pairs::{or_null, raw_filters, RawOptions};
use crate::{ffi, Bounds, Error, Filter, Pair};

/// Options of a [`Tracker`], as in [`crate::FindOptions`].
///
/// ```
/// let options = broadside::TrackerOptions { algorithm: "grid", ..Default::default() };
/// let tracker = broadside::Tracker::<broadside::Box2>::with_options(&options)?;
/// # Ok::<(), broadside::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TrackerOptions<'a> {
    /// The algorithm and its settings.
    pub algorithm: &'a str,
    /// Whether boxes that only touch overlap: true by default.
    pub touching: bool,
    /// Whether invalid boxes pair with nothing, instead of being refused.
    pub quarantine: bool,
}

impl Default for TrackerOptions<'_> {
    fn default() -> Self {
        TrackerOptions { algorithm: "auto", touching: true, quarantine: false }
    }
}

/// What may differ in the next frame of a [`Tracker`] or an [`crate::Index`]. By default, all boxes, without filters.
///
/// ```
/// let frame = broadside::Frame { changed: Some(&[3, 7]), ..Default::default() };
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Frame<'a> {
    /// The places where boxes or filters may differ; `None` stands for all. A change that is not listed is not seen.
    pub changed: Option<&'a [u32]>,
    /// A filter for each box, or none.
    pub filters: &'a [Filter],
}

impl Frame<'_> {
    /// The list of changes as a pointer, null for all, and a length; and the filters.
    pub(crate) fn raw(&self, boxes: usize) -> Result<(*const u32, usize, Vec<ffi::Filter>), Error> {
        let filters = raw_filters("filters", self.filters, boxes)?;
        let (changed, count) = self.changed.map_or((ptr::null(), 0), |changed| (changed.as_ptr(), changed.len()));
        Ok((changed, count, filters))
    }
}

/// The pairs that began and ended in a frame of a [`Tracker`], each list sorted.
///
/// ```
/// use broadside::{Box2, Tracker};
///
/// let mut tracker = Tracker::new()?;
/// let events = tracker.update(&[Box2::point([0.0, 0.0]); 2])?;
/// assert_eq!((events.begun.len(), events.ended.len()), (1, 0));
/// # Ok::<(), broadside::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PairEvents<'a> {
    /// The pairs that overlap now and did not before.
    pub begun: &'a [Pair],
    /// The pairs that overlapped before and do not now.
    pub ended: &'a [Pair],
}

/// `count` elements that the library keeps; `first` may be null if there are none.
///
/// # Safety
/// The elements must stay as they are for the lifetime of the result.
pub(crate) unsafe fn kept<'a, T>(first: *const T, count: usize) -> &'a [T] {
    if count == 0 {
        return &[];
    }
    // SAFETY: the caller's promise.
    unsafe { std::slice::from_raw_parts(first, count) }
}

/// Follows a slice of boxes from frame to frame and tells which pairs begin and end.
///
/// ```
/// use broadside::{Bounds, Box2, Pair, Tracker};
///
/// let mut boxes = [Box2::new([0.0, 0.0], [1.0, 1.0]), Box2::new([3.0, 0.0], [4.0, 1.0])];
/// let mut tracker = Tracker::new()?;
/// assert!(tracker.update(&boxes)?.begun.is_empty());
///
/// boxes[0] = Box2::new([2.5, 0.0], [3.5, 1.0]);
/// assert_eq!(tracker.update(&boxes)?.begun, [Pair { first: 0, second: 1 }]);
///
/// boxes[1] = Box2::ABSENT;
/// assert_eq!(tracker.update(&boxes)?.ended.len(), 1);
/// # Ok::<(), broadside::Error>(())
/// ```
pub struct Tracker<B: Bounds> {
    raw: NonNull<ffi::Tracker>,
    boxes: PhantomData<B>,
}

owns!(Tracker, broadside_tracker_destroy);

impl<B: Bounds> Tracker<B> {
    /// A tracker by `auto`.
    ///
    /// ```
    /// let tracker = broadside::Tracker::<broadside::DoubleBox3>::new()?;
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn new() -> Result<Self, Error> {
        Self::with_options(&TrackerOptions::default())
    }

    /// A tracker with options.
    ///
    /// ```
    /// use broadside::{Box2, Tracker, TrackerOptions};
    ///
    /// let options = TrackerOptions { touching: false, ..Default::default() };
    /// let mut tracker = Tracker::with_options(&options)?;
    /// let row = [0.0, 1.0, 2.0].map(|x| Box2::new([x, 0.0], [x + 1.0, 1.0]));
    /// assert!(tracker.update(&row)?.begun.is_empty());
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn with_options(options: &TrackerOptions<'_>) -> Result<Self, Error> {
        let options = RawOptions::new(options.algorithm, options.touching, options.quarantine)?;
        let mut raw = ptr::null_mut();
        // SAFETY: the options live through the call.
        call(|error| unsafe {
            let version = ffi::BROADSIDE_C_API_VERSION;
            ffi::broadside_tracker_create(version, B::KIND, &options.raw, &mut raw, error)
        })?;
        // SAFETY: a call that succeeds has made one.
        Ok(Tracker { raw: unsafe { NonNull::new_unchecked(raw) }, boxes: PhantomData })
    }

    /// Takes the boxes of the next frame, all of which may have changed.
    ///
    /// ```
    /// let mut tracker = broadside::Tracker::new()?;
    /// assert!(tracker.update(&[broadside::Box3::point([0.0; 3])])?.begun.is_empty());
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn update(&mut self, boxes: &[B]) -> Result<PairEvents<'_>, Error> {
        self.update_with(boxes, &Frame::default())
    }

    /// Takes the boxes of the next frame, with filters or the places that may have changed.
    ///
    /// ```
    /// use broadside::{Box2, Filter, Frame, Tracker};
    ///
    /// let mut tracker = Tracker::new()?;
    /// let boxes = [Box2::point([0.0, 0.0]); 2];
    /// tracker.update(&boxes)?;
    /// let floor = Filter { is_static: true, ..Default::default() };
    /// let events = tracker.update_with(&boxes, &Frame { changed: Some(&[0, 1]), filters: &[floor; 2] })?;
    /// assert_eq!(events.ended.len(), 1);
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn update_with(&mut self, boxes: &[B], frame: &Frame<'_>) -> Result<PairEvents<'_>, Error> {
        let (changed, changed_count, filters) = frame.raw(boxes.len())?;
        let boxes = raw_boxes(boxes);
        let mut events = MaybeUninit::uninit();
        // SAFETY: all arrays live through the call; filters are none or one for each box; the library checks places.
        call(|error| unsafe {
            let (raw, filters) = (self.raw.as_ptr(), or_null(&filters));
            let events = events.as_mut_ptr();
            ffi::broadside_tracker_update(raw, &boxes, changed, changed_count, filters, events, error)
        })?;
        // SAFETY: written by the call; the arrays stay until the next update, which borrows the tracker anew.
        unsafe {
            let events: ffi::PairEvents = events.assume_init();
            Ok(PairEvents {
                begun: kept(events.begun, events.begun_count),
                ended: kept(events.ended, events.ended_count),
            })
        }
    }
}
