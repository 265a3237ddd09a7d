use std::marker::PhantomData;
use std::ptr::{self, NonNull};

use crate::boxes::raw_boxes;
use crate::error::call;
use crate::pairs::or_null;
use crate::queries::sealed;
use crate::{ffi, Bounds, Error, Frame, Queried, Query};

/// An index over a slice of boxes, for queries alone. A box is named by its place.
///
/// ```
/// use broadside::{Box2, Index};
///
/// let index = Index::new(&[Box2::new([0.0, 0.0], [2.0, 2.0]), Box2::new([5.0, 5.0], [6.0, 6.0])])?;
/// assert_eq!(index.query().overlapping(Box2::point([1.0, 1.0]))?, [0]);
/// assert_eq!(index.query().nearest(Box2::point([4.0, 4.0]), 1)?[0].id, 1);
/// # Ok::<(), broadside::Error>(())
/// ```
pub struct Index<B: Bounds> {
    raw: NonNull<ffi::Index>,
    count: usize,
    boxes: PhantomData<B>,
}

owns!(Index, broadside_index_destroy);

impl<B: Bounds> Index<B> {
    /// An index of these boxes, which are copied.
    ///
    /// ```
    /// let index = broadside::Index::new(&[broadside::Box3::point([1.0, 2.0, 3.0])])?;
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn new(boxes: &[B]) -> Result<Self, Error> {
        let mut raw = ptr::null_mut();
        // SAFETY: a call that succeeds has made one.
        let mut index = unsafe {
            call(|error| ffi::broadside_index_create(ffi::BROADSIDE_C_API_VERSION, B::KIND, &mut raw, error))?;
            Index { raw: NonNull::new_unchecked(raw), count: 0, boxes: PhantomData }
        };
        index.update(boxes)?;
        Ok(index)
    }

    /// Replaces the boxes.
    ///
    /// ```
    /// # use broadside::{Box2, Index};
    /// let mut index = Index::<Box2>::new(&[])?;
    /// index.update(&[Box2::point([0.0, 0.0])])?;
    /// assert_eq!(index.query().overlapping(Box2::point([0.0, 0.0]))?.len(), 1);
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn update(&mut self, boxes: &[B]) -> Result<(), Error> {
        self.update_with(boxes, &Frame::default())
    }

    /// Replaces the boxes, with filters or the places that may have changed.
    ///
    /// ```
    /// # use broadside::{Box2, Frame, Index};
    /// let mut boxes = vec![Box2::point([0.0, 0.0]); 1000];
    /// let mut index = Index::new(&boxes)?;
    /// boxes[7] = Box2::point([1.0, 1.0]);
    /// index.update_with(&boxes, &Frame { changed: Some(&[7]), ..Default::default() })?;
    /// assert_eq!(index.query().overlapping(boxes[7])?, [7]);
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn update_with(&mut self, boxes: &[B], frame: &Frame<'_>) -> Result<(), Error> {
        let (changed, changed_count, filters) = frame.raw(boxes.len())?;
        let count = boxes.len();
        let boxes = raw_boxes(boxes);
        // SAFETY: all arrays live through the call; filters are none or one for each box; the library checks places.
        call(|error| unsafe {
            let (raw, filters) = (self.raw.as_ptr(), or_null(&filters));
            ffi::broadside_index_update(raw, &boxes, changed, changed_count, filters, error)
        })?;
        self.count = count;
        Ok(())
    }

    /// Asks about the boxes: see [`Query`].
    ///
    /// ```
    /// let index = broadside::Index::<broadside::Box2>::new(&[])?;
    /// assert!(index.query().nearest(broadside::Box2::point([0.0, 0.0]), 1)?.is_empty());
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn query(&self) -> Query<'_, Self> {
        Query::new(self)
    }
}

impl<B: Bounds> sealed::Sealed for Index<B> {}
impl<B: Bounds> Queried for Index<B> {
    type Bounds = B;
    type Id = u32;
    type Raw = ffi::Index;
    const CALLS: sealed::Calls<ffi::Index, u32> = sealed::Calls {
        overlapping: ffi::broadside_index_overlapping,
        hits: ffi::broadside_index_hits,
        first_hit: ffi::broadside_index_first_hit,
        nearest_to_box: ffi::broadside_index_nearest_to_box,
    };

    fn raw(&self) -> *const ffi::Index {
        self.raw.as_ptr()
    }

    fn boxes(&self) -> usize {
        self.count
    }
}
