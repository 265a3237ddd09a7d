use std::marker::PhantomData;
use std::mem::MaybeUninit;
use std::ptr::{self, NonNull};

use crate::boxes::raw_boxes;
use crate::error::{call, check_length, collect};
use crate::pairs::{or_null, raw_filters, raw_text};
use crate::queries::sealed;
use crate::tracker::kept;
use crate::{ffi, Bounds, Error, Filter, Queried, Query};

/// Names a box of a world for as long as it is there; no handle ever names a second one.
///
/// ```
/// # use broadside::{Box2, World};
/// let mut world = World::new()?;
/// let first = world.add(&[Box2::point([0.0, 0.0])])?[0];
/// world.remove(&[first])?;
/// assert!(!world.contains(first));
/// # Ok::<(), broadside::Error>(())
/// ```
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Handle {
    /// A small number that no other box of the world has now: an index into slices of yours.
    pub slot: u32,
    /// Tells boxes apart that have had the same slot.
    pub generation: u32,
}

/// Two boxes of a world, `first.slot < second.slot`.
///
/// ```
/// let pair = broadside::HandlePair::default();
/// assert_eq!(pair.first, pair.second);
/// ```
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct HandlePair {
    /// The first box.
    pub first: Handle,
    /// The second box.
    pub second: Handle,
}

// SAFETY: repr(C), of integers alone, without padding.
#[cfg(feature = "bytemuck")]
mod pod {
    use crate::{Handle, HandlePair, Pair};

    unsafe impl bytemuck::Zeroable for Handle {}
    unsafe impl bytemuck::Pod for Handle {}
    unsafe impl bytemuck::Zeroable for HandlePair {}
    unsafe impl bytemuck::Pod for HandlePair {}
    unsafe impl bytemuck::Zeroable for Pair {}
    unsafe impl bytemuck::Pod for Pair {}
}

/// The pairs that began and ended in an update of a [`World`], each list sorted by slots.
///
/// ```
/// # use broadside::{Box2, World};
/// let mut world = World::new()?;
/// world.add(&[Box2::point([0.0, 0.0]); 2])?;
/// assert_eq!(world.update()?.begun.len(), 1);
/// # Ok::<(), broadside::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Events<'a> {
    /// The pairs that hold now and did not before.
    pub begun: &'a [HandlePair],
    /// The pairs that held before and do not now.
    pub ended: &'a [HandlePair],
}

/// Options of a [`World`].
///
/// ```
/// # use broadside::{Box2, World, WorldOptions};
/// let options = WorldOptions { margin: 0.1, settings: "world:max_boxes=1000", ..Default::default() };
/// let world = World::<Box2>::with_options(&options)?;
/// # Ok::<(), broadside::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorldOptions<'a> {
    /// The algorithm and its settings, as in [`crate::FindOptions`].
    pub algorithm: &'a str,
    /// Enlarges boxes by this on every side, in the coordinates' unit, so that small moves cost next to nothing.
    pub margin: f64,
    /// Likewise, by this times their longest side; if both are given, the smaller counts.
    pub relative_margin: f64,
    /// Enlarges boxes for this many frames ahead, if velocities are given.
    pub predicted_frames: f64,
    /// Whether pairs are those of the enlarged boxes.
    pub reports_enlarged: bool,
    /// Whether the current pairs are kept for [`World::pairs`], at 16 bytes per pair: true by default.
    pub keep_pairs: bool,
    /// Whether invalid boxes pair with nothing, instead of being refused.
    pub quarantine: bool,
    /// The first handles' generation. Worlds that begin far apart refuse each other's handles.
    pub first_generation: u32,
    /// The library's other options by name, such as `"world:touching=no:max_boxes=1000"`; or nothing.
    pub settings: &'a str,
}

impl Default for WorldOptions<'_> {
    fn default() -> Self {
        WorldOptions {
            algorithm: "auto",
            margin: 0.0,
            relative_margin: 0.0,
            predicted_frames: 0.0,
            reports_enlarged: false,
            keep_pairs: true,
            quarantine: false,
            first_generation: 0,
            settings: "",
        }
    }
}

/// Boxes that come, move and go under handles, and the pairs that begin and end.
///
/// ```
/// use broadside::{Box2, World};
///
/// let mut world = World::new()?;
/// let [ball, crate_] = [0.0, 3.0].map(|x| Box2::new([x, 0.0], [x + 1.0, 1.0]));
/// let handles = world.add(&[ball, crate_])?;
/// assert!(world.update()?.begun.is_empty());
///
/// world.move_to(&handles[..1], &[Box2::new([2.5, 0.0], [3.5, 1.0])])?;
/// world.update()?;
/// for pair in world.events().begun {
///     assert!(world.box_of(pair.first)?.overlaps(&world.box_of(pair.second)?));
/// }
/// assert_eq!(world.query().nearest(Box2::point([9.0, 0.0]), 1)?[0].id, handles[1]);
/// # Ok::<(), broadside::Error>(())
/// ```
pub struct World<B: Bounds> {
    raw: NonNull<ffi::World>,
    events: ffi::Events,
    boxes: PhantomData<B>,
}

owns!(World, broadside_world_destroy);

const NO_EVENTS: ffi::Events = ffi::Events { begun: ptr::null(), begun_count: 0, ended: ptr::null(), ended_count: 0 };

impl<B: Bounds> World<B> {
    /// An empty world with the default options.
    ///
    /// ```
    /// assert!(broadside::World::<broadside::DoubleBox2>::new()?.is_empty());
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn new() -> Result<Self, Error> {
        Self::with_options(&WorldOptions::default())
    }

    /// An empty world.
    ///
    /// ```
    /// # use broadside::{Box2, World, WorldOptions};
    /// let grid = WorldOptions { algorithm: "grid", ..Default::default() };
    /// assert!(World::<Box2>::with_options(&grid).is_ok());
    /// ```
    pub fn with_options(options: &WorldOptions<'_>) -> Result<Self, Error> {
        let algorithm = raw_text("algorithm", options.algorithm)?;
        let settings = raw_text("settings", options.settings)?;
        let mut raw_options = MaybeUninit::uninit();
        let mut raw = ptr::null_mut();
        // SAFETY: the first call writes all options, whose texts live through the second.
        call(|error| unsafe {
            ffi::broadside_world_options_init(raw_options.as_mut_ptr());
            let mut all: ffi::WorldOptions = raw_options.assume_init();
            all.algorithm = algorithm.as_ptr();
            all.margin = options.margin;
            all.relative_margin = options.relative_margin;
            all.predicted_frames = options.predicted_frames;
            all.reports_enlarged = options.reports_enlarged.into();
            all.forgets_pairs = (!options.keep_pairs).into();
            all.quarantines = options.quarantine.into();
            all.first_generation = options.first_generation;
            if !options.settings.is_empty() {
                all.settings = settings.as_ptr();
            }
            ffi::broadside_world_create(ffi::BROADSIDE_C_API_VERSION, B::KIND, &all, &mut raw, error)
        })?;
        // SAFETY: a call that succeeds has made one.
        let raw = unsafe { NonNull::new_unchecked(raw) };
        Ok(World { raw, events: NO_EVENTS, boxes: PhantomData })
    }

    /// Adds boxes, and returns a handle for each. Adds all boxes or none. Their pairs begin at the next update.
    ///
    /// ```
    /// # use broadside::{Box2, World};
    /// let mut world = World::new()?;
    /// let handles = world.add(&[Box2::point([0.0, 0.0]); 3])?;
    /// assert_eq!((handles.len(), world.len()), (3, 3));
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn add(&mut self, boxes: &[B]) -> Result<Vec<Handle>, Error> {
        self.add_with(boxes, &[], &[])
    }

    /// Adds boxes with a filter and a number of yours for each; either slice may be empty.
    ///
    /// ```
    /// # use broadside::{Box2, Filter, World};
    /// let mut world = World::new()?;
    /// let floor = Filter { is_static: true, ..Default::default() };
    /// let handles = world.add_with(&[Box2::point([0.0, 0.0])], &[floor], &[17])?;
    /// assert_eq!(world.user_data(handles[0])?, 17);
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn add_with(&mut self, boxes: &[B], filters: &[Filter], user_data: &[u64]) -> Result<Vec<Handle>, Error> {
        let mut handles = vec![Handle::default(); boxes.len()];
        let filters = raw_filters("filters", filters, boxes.len())?;
        if !user_data.is_empty() {
            check_length("numbers in user_data", user_data.len(), boxes.len())?;
        }
        let boxes = raw_boxes(boxes);
        // SAFETY: all arrays live through the call and have one element for each box, or are null.
        call(|error| unsafe {
            let (filters, user_data) = (or_null(&filters), or_null(user_data));
            ffi::broadside_world_add(self.raw.as_ptr(), &boxes, filters, user_data, handles.as_mut_ptr(), error)
        })?;
        Ok(handles)
    }

    /// Replaces the boxes of handles, one for each: all of them or, if one is invalid, none. If a handle is given twice,
    /// its last box counts.
    ///
    /// ```
    /// # use broadside::{Box2, World};
    /// let mut world = World::new()?;
    /// let ball = world.add(&[Box2::point([0.0, 0.0])])?;
    /// world.move_to(&ball, &[Box2::point([1.0, 0.0])])?;
    /// assert_eq!(world.box_of(ball[0])?.min, [1.0, 0.0]);
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn move_to(&mut self, handles: &[Handle], boxes: &[B]) -> Result<(), Error> {
        self.move_with_velocities(handles, boxes, &[])
    }

    /// The same, with each box's expected motion per frame, for [`WorldOptions::predicted_frames`].
    ///
    /// ```
    /// # use broadside::{Box2, World, WorldOptions};
    /// let mut world = World::with_options(&WorldOptions { predicted_frames: 4.0, ..Default::default() })?;
    /// let ball = world.add(&[Box2::point([0.0, 0.0])])?;
    /// world.move_with_velocities(&ball, &[Box2::point([1.0, 0.0])], &[[1.0, 0.0]])?;
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn move_with_velocities(
        &mut self,
        handles: &[Handle],
        boxes: &[B],
        velocities: &[B::Point],
    ) -> Result<(), Error> {
        check_length("handles", handles.len(), boxes.len())?;
        if !velocities.is_empty() {
            check_length("velocities", velocities.len(), boxes.len())?;
        }
        let boxes = raw_boxes(boxes);
        // SAFETY: all arrays live through the call and have one element for each box, or are null.
        self.change(|world, error| unsafe {
            let velocities = or_null(velocities).cast();
            ffi::broadside_world_move(world, handles.as_ptr(), &boxes, velocities, error)
        })
    }

    /// Takes boxes out: all of them or, if a handle is invalid, none. Their pairs end at the next update. They, their
    /// filters and user data can be read until the update after that.
    ///
    /// ```
    /// # use broadside::{Box2, World};
    /// let mut world = World::new()?;
    /// let handles = world.add(&[Box2::point([0.0, 0.0]); 2])?;
    /// world.update()?;
    /// world.remove(&handles[..1])?;
    /// assert_eq!(world.update()?.ended.len(), 1);
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn remove(&mut self, handles: &[Handle]) -> Result<(), Error> {
        // SAFETY: the array lives through the call.
        self.change(|world, error| unsafe {
            ffi::broadside_world_remove(world, handles.as_ptr(), handles.len(), error)
        })
    }

    /// Brings the pairs up to date. Costs what has changed. The events stay readable by [`World::events`].
    ///
    /// ```
    /// # use broadside::{Box2, World};
    /// let mut world = World::new()?;
    /// world.add(&[Box2::point([0.0, 0.0]); 2])?;
    /// assert_eq!(world.update()?.begun.len(), 1);
    /// assert!(world.update()?.begun.is_empty());
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn update(&mut self) -> Result<Events<'_>, Error> {
        self.events = NO_EVENTS; // a call that fails may have changed the arrays
        let mut events = NO_EVENTS;
        // SAFETY: `events` lives through the call.
        call(|error| unsafe { ffi::broadside_world_update(self.raw.as_ptr(), &mut events, error) })?;
        self.events = events;
        Ok(self.events())
    }

    /// The events of the last update. Unlike the result of [`World::update`], it lets you read the world meanwhile.
    ///
    /// ```
    /// # use broadside::{Box2, World};
    /// let mut world = World::new()?;
    /// world.add_with(&[Box2::point([0.0, 0.0]); 2], &[], &[7, 8])?;
    /// world.update()?;
    /// for pair in world.events().begun {
    ///     assert_eq!(world.user_data(pair.first)?, 7);
    /// }
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn events(&self) -> Events<'_> {
        let events = &self.events;
        // SAFETY: the arrays stay until the next update or restore(), which take the world as mutable.
        unsafe {
            Events { begun: kept(events.begun, events.begun_count), ended: kept(events.ended, events.ended_count) }
        }
    }

    /// The pairs that held at the last update, sorted by slots.
    ///
    /// ```
    /// # use broadside::{Box2, World};
    /// let mut world = World::new()?;
    /// world.add(&[Box2::point([0.0, 0.0]); 3])?;
    /// world.update()?;
    /// assert_eq!(world.pairs()?.len(), 3);
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn pairs(&mut self) -> Result<&[HandlePair], Error> {
        let (mut pairs, mut count) = (ptr::null(), 0);
        // SAFETY: the array stays until the next call that takes the world as mutable.
        unsafe {
            call(|error| ffi::broadside_world_pairs(self.raw.as_ptr(), &mut pairs, &mut count, error))?;
            Ok(kept(pairs, count))
        }
    }

    /// The number of boxes.
    ///
    /// ```
    /// assert_eq!(broadside::World::<broadside::Box3>::new()?.len(), 0);
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn len(&self) -> usize {
        // SAFETY: the world is there.
        unsafe { ffi::broadside_world_size(self.raw.as_ptr()) }
    }

    /// Whether there are no boxes.
    ///
    /// ```
    /// assert!(broadside::World::<broadside::Box3>::new()?.is_empty());
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether the handle names a box that is there.
    ///
    /// ```
    /// let world = broadside::World::<broadside::Box3>::new()?;
    /// assert!(!world.contains(broadside::Handle::default()));
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn contains(&self, handle: Handle) -> bool {
        // SAFETY: the library checks handles.
        unsafe { ffi::broadside_world_contains(self.raw.as_ptr(), handle) != 0 }
    }

    /// Reads one value of a box.
    fn read<T>(
        &self,
        read: impl FnOnce(*const ffi::World, *mut T, *mut ffi::Error) -> ffi::Status,
    ) -> Result<T, Error> {
        let mut value = MaybeUninit::uninit();
        call(|error| read(self.raw.as_ptr(), value.as_mut_ptr(), error))?;
        // SAFETY: a call that succeeds has written it.
        Ok(unsafe { value.assume_init() })
    }

    /// The box of a handle.
    ///
    /// ```
    /// # use broadside::{Box2, World};
    /// let mut world = World::new()?;
    /// let handles = world.add(&[Box2::point([1.0, 2.0])])?;
    /// assert_eq!(world.box_of(handles[0])?, Box2::point([1.0, 2.0]));
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn box_of(&self, handle: Handle) -> Result<B, Error> {
        // SAFETY: there is room for a box of the world's kind.
        self.read(|world, value: *mut B, error| unsafe { ffi::broadside_world_box(world, handle, value.cast(), error) })
    }

    /// The filter of a box.
    ///
    /// ```
    /// # use broadside::{Box2, Filter, World};
    /// let mut world = World::new()?;
    /// let handles = world.add(&[Box2::point([0.0, 0.0])])?;
    /// assert_eq!(world.filter(handles[0])?, Filter::default());
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn filter(&self, handle: Handle) -> Result<Filter, Error> {
        // SAFETY: there is room for a filter.
        let filter: ffi::Filter =
            self.read(|world, value, error| unsafe { ffi::broadside_world_filter(world, handle, value, error) })?;
        Ok(filter.into())
    }

    /// The number of yours that a box has; 0 if it was given none.
    ///
    /// ```
    /// # use broadside::{Box2, World};
    /// let mut world = World::new()?;
    /// let handles = world.add(&[Box2::point([0.0, 0.0])])?;
    /// assert_eq!(world.user_data(handles[0])?, 0);
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn user_data(&self, handle: Handle) -> Result<u64, Error> {
        // SAFETY: there is room for a number.
        self.read(|world, value, error| unsafe { ffi::broadside_world_user_data(world, handle, value, error) })
    }

    /// Makes a call that changes the world.
    fn change(&mut self, change: impl FnOnce(*mut ffi::World, *mut ffi::Error) -> ffi::Status) -> Result<(), Error> {
        call(|error| change(self.raw.as_ptr(), error)).map_err(Error::from)
    }

    /// Replaces the filter of a box.
    ///
    /// ```
    /// # use broadside::{Box2, Filter, World};
    /// let mut world = World::new()?;
    /// let handles = world.add(&[Box2::point([0.0, 0.0]); 2])?;
    /// world.set_filter(handles[0], Filter { mask: 0, ..Default::default() })?;
    /// assert!(world.update()?.begun.is_empty());
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn set_filter(&mut self, handle: Handle, filter: Filter) -> Result<(), Error> {
        let filter = ffi::Filter::from(&filter);
        // SAFETY: the filter lives through the call.
        self.change(|world, error| unsafe { ffi::broadside_world_set_filter(world, handle, &filter, error) })
    }

    /// Replaces the number of yours that a box has.
    ///
    /// ```
    /// # use broadside::{Box2, World};
    /// let mut world = World::new()?;
    /// let handles = world.add(&[Box2::point([0.0, 0.0])])?;
    /// world.set_user_data(handles[0], 17)?;
    /// assert_eq!(world.user_data(handles[0])?, 17);
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn set_user_data(&mut self, handle: Handle, user_data: u64) -> Result<(), Error> {
        // SAFETY: the library checks handles.
        self.change(|world, error| unsafe { ffi::broadside_world_set_user_data(world, handle, user_data, error) })
    }

    /// Makes two boxes never count as a pair, such as bodies that a joint connects.
    ///
    /// ```
    /// # use broadside::{Box2, World};
    /// let mut world = World::new()?;
    /// let handles = world.add(&[Box2::point([0.0, 0.0]); 2])?;
    /// world.ignore(handles[0], handles[1])?;
    /// assert!(world.update()?.begun.is_empty());
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn ignore(&mut self, a: Handle, b: Handle) -> Result<(), Error> {
        // SAFETY: the library checks handles.
        self.change(|world, error| unsafe { ffi::broadside_world_ignore(world, a, b, 1, error) })
    }

    /// Makes them count again.
    ///
    /// ```
    /// # use broadside::{Box2, World};
    /// let mut world = World::new()?;
    /// let handles = world.add(&[Box2::point([0.0, 0.0]); 2])?;
    /// world.ignore(handles[0], handles[1])?;
    /// world.unignore(handles[0], handles[1])?;
    /// assert_eq!(world.update()?.begun.len(), 1);
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn unignore(&mut self, a: Handle, b: Handle) -> Result<(), Error> {
        // SAFETY: the library checks handles.
        self.change(|world, error| unsafe { ffi::broadside_world_ignore(world, a, b, 0, error) })
    }

    /// The world as bytes, which are the same on every machine.
    ///
    /// ```
    /// # use broadside::{Box2, World};
    /// let mut world = World::new()?;
    /// let handles = world.add(&[Box2::point([0.0, 0.0])])?;
    /// let then = world.snapshot()?;
    /// world.remove(&handles)?;
    /// world.restore(&then)?; // rollback
    /// assert!(world.contains(handles[0]));
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn snapshot(&self) -> Result<Vec<u8>, Error> {
        // SAFETY: the call writes at most `room` bytes.
        collect(0, |bytes: *mut u8, room, size, error| unsafe {
            ffi::broadside_world_snapshot(self.raw.as_ptr(), bytes.cast(), room, size, error)
        })
    }

    /// Makes the world what it was when the snapshot was taken, of this world or of another one. There are no events
    /// until the next update.
    ///
    /// ```
    /// # use broadside::{Box2, Error, World};
    /// let mut world = World::<Box2>::new()?;
    /// assert!(matches!(world.restore(b"no snapshot"), Err(Error::InvalidSnapshot(_))));
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn restore(&mut self, snapshot: &[u8]) -> Result<(), Error> {
        // SAFETY: the bytes live through the call, which checks them.
        self.change(|world, error| unsafe {
            ffi::broadside_world_restore(world, snapshot.as_ptr().cast(), snapshot.len(), error)
        })?;
        self.events = NO_EVENTS;
        Ok(())
    }

    /// Asks about the boxes as they are now, also between updates: see [`Query`].
    ///
    /// ```
    /// # use broadside::{Box2, World};
    /// let mut world = World::new()?;
    /// let handles = world.add(&[Box2::point([0.0, 0.0])])?;
    /// assert_eq!(world.query().overlapping(Box2::point([0.0, 0.0]))?, handles);
    /// # Ok::<(), broadside::Error>(())
    /// ```
    pub fn query(&self) -> Query<'_, Self> {
        Query::new(self)
    }
}

impl<B: Bounds> sealed::Sealed for World<B> {}
impl<B: Bounds> Queried for World<B> {
    type Bounds = B;
    type Id = Handle;
    type Raw = ffi::World;
    const CALLS: sealed::Calls<ffi::World, Handle> = sealed::Calls {
        overlapping: ffi::broadside_world_overlapping,
        hits: ffi::broadside_world_hits,
        first_hit: ffi::broadside_world_first_hit,
        nearest_to_box: ffi::broadside_world_nearest_to_box,
    };

    fn raw(&self) -> *const ffi::World {
        self.raw.as_ptr()
    }

    fn boxes(&self) -> usize {
        self.len()
    }
}
