//! What a crate implements to take part: `Searcher` and `Follower`.

use std::ffi::c_void;
use std::num::NonZero;
use std::ops::ControlFlow;
use std::thread::available_parallelism;

use rayon::{ThreadPool, ThreadPoolBuilder};

/// A box: Broadside's `Box<D>` in memory.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Bounds<const D: usize> {
    pub min: [f32; D],
    pub max: [f32; D],
}

impl<const D: usize> Bounds<D> {
    /// Absent boxes have NaN, or a minimum above the maximum.
    pub fn is_present(&self) -> bool {
        (0..D).all(|axis| self.min[axis] <= self.max[axis])
    }

    pub fn contains(&self, other: &Self) -> bool {
        (0..D).all(|axis| self.min[axis] <= other.min[axis] && other.max[axis] <= self.max[axis])
    }

    pub fn overlaps(&self, other: &Self) -> bool {
        (0..D).all(|axis| self.min[axis] <= other.max[axis] && other.min[axis] <= self.max[axis])
    }
}

/// Broadside's `Filter` in memory.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Filter {
    pub category: u64,
    pub mask: u64,
    pub group: i32,
    pub is_static: bool,
}

pub type Takes = unsafe extern "C" fn(*mut c_void, *const u32, usize) -> bool;

const CHUNK: usize = 512; // as many as PairSink takes at once

/// Passes pairs on in chunks.
pub struct Pairs {
    takes: Takes,
    context: *mut c_void,
    ids: [[u32; 2]; CHUNK],
    used: usize,
}

impl Pairs {
    pub fn new(takes: Takes, context: *mut c_void) -> Self {
        Self { takes, context, ids: [[0; 2]; CHUNK], used: 0 }
    }

    /// Adds a pair of different ids; breaks if no more pairs are wanted.
    #[inline]
    pub fn add(&mut self, a: u32, b: u32) -> ControlFlow<()> {
        if a < b {
            self.give(a, b)
        } else {
            self.give(b, a)
        }
    }

    /// Adds two numbers in this order; breaks likewise.
    #[inline]
    pub fn give(&mut self, a: u32, b: u32) -> ControlFlow<()> {
        if self.used == CHUNK {
            self.flush()?;
        }
        self.ids[self.used] = [a, b];
        self.used += 1;
        ControlFlow::Continue(())
    }

    pub fn flush(&mut self) -> ControlFlow<()> {
        let count = std::mem::take(&mut self.used);
        // SAFETY: the caller of the C interface gave a function that takes this context.
        match unsafe { (self.takes)(self.context, self.ids.as_ptr().cast(), count) } {
            true => ControlFlow::Continue(()),
            false => ControlFlow::Break(()),
        }
    }
}

/// The threads for a library that can use several, at most as many as the machine has: `None` for one thread, which is
/// the calling one; 0 for all.
pub fn pool_of(threads: usize) -> Option<ThreadPool> {
    let all = available_parallelism().map_or(1, NonZero::get);
    let count = if threads == 0 { all } else { threads.min(all) };
    (threads != 1).then(|| ThreadPoolBuilder::new().num_threads(count).build().expect("threads"))
}

/// Finds pairs from scratch.
pub trait Searcher<const D: usize> {
    /// Adds each overlapping pair once. All boxes are present, and there are at least two. `length` is that of a
    /// typical box, if the description in C++ says that it is needed.
    fn search(&mut self, boxes: &[Bounds<D>], length: f32, pairs: &mut Pairs) -> ControlFlow<()>;

    /// Adds each overlapping pair of the first `left_count` boxes and the others once, and may add pairs within these
    /// sets. Neither is empty. By default, a library without a join of two sets finds all pairs.
    fn join(&mut self, boxes: &[Bounds<D>], _left_count: usize, length: f32, pairs: &mut Pairs) -> ControlFlow<()> {
        self.search(boxes, length, pairs)
    }

    /// Like `search`. A library that filters may leave out pairs that the boxes' filters reject; the caller drops them
    /// in any case.
    fn search_filtered(
        &mut self,
        boxes: &[Bounds<D>],
        _filters: &[Filter],
        length: f32,
        pairs: &mut Pairs,
    ) -> ControlFlow<()> {
        self.search(boxes, length, pairs)
    }

    /// Destroys the structure that the last search left.
    fn tear_down(&mut self) {}
}

/// Follows boxes in a structure that stays.
pub trait Follower<const D: usize> {
    /// Starts again with the present boxes. `length` is that of a typical box.
    fn build(&mut self, boxes: &[Bounds<D>], length: f32);

    /// Applies the changes. Adds at least each pair with a changed box that overlapped before or overlaps now.
    fn update(&mut self, frame: &Frame<D>, pairs: &mut Pairs) -> ControlFlow<()>;
}

/// The boxes of a frame. `flags` is 1 at the ids in `changed`. There are at least as many boxes as before.
pub struct Frame<'a, const D: usize> {
    pub boxes: &'a [Bounds<D>],
    pub changed: &'a [u32],
    pub flags: &'a [u8],
}

impl<const D: usize> Frame<'_, D> {
    pub fn has_changed(&self, (a, b): (u32, u32)) -> bool {
        self.flags[a as usize] | self.flags[b as usize] != 0
    }
}
