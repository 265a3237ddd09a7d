//! The part of `bindings/c/broadside.h` that this crate calls, by hand; `tests/declarations.rs` compares the two texts.
//! A name is that of the header without `broadside_`.
use std::os::raw::{c_char, c_int, c_void};

pub use crate::{Handle, HandlePair, Pair};

pub const BROADSIDE_C_API_VERSION: c_int = 2;

pub type Status = i32;
pub const BROADSIDE_OK: Status = 0;
pub const BROADSIDE_INVALID_INPUT: Status = 1;
pub const BROADSIDE_INVALID_FRAME: Status = 2;
pub const BROADSIDE_INVALID_QUERY: Status = 3;
pub const BROADSIDE_INVALID_SPEC: Status = 4;
pub const BROADSIDE_INVALID_HANDLE: Status = 5;
pub const BROADSIDE_INVALID_SNAPSHOT: Status = 6;
pub const BROADSIDE_INVALID_ARGUMENT: Status = 7;
pub const BROADSIDE_TOO_SMALL: Status = 8;
pub const BROADSIDE_STOPPED: Status = 9;
pub const BROADSIDE_OUT_OF_MEMORY: Status = 10;

pub type Kind = i32;
pub const BROADSIDE_FLOAT_2D: Kind = 0;
pub const BROADSIDE_FLOAT_3D: Kind = 1;
pub const BROADSIDE_DOUBLE_2D: Kind = 2;
pub const BROADSIDE_DOUBLE_3D: Kind = 3;

macro_rules! opaque {
    ($($name:ident)*) => {
        $(#[repr(C)]
        pub struct $name([u8; 0]);)*
    };
}
opaque!(Executor Tracker World Index);

#[repr(C)]
pub struct Error {
    pub status: Status,
    pub index: u64,
    pub message: [c_char; 1000],
}

#[repr(C)]
pub struct Boxes {
    pub kind: Kind,
    pub first: *const c_void,
    pub count: usize,
    pub stride: usize,
}

#[repr(C)]
pub struct Filter {
    pub category: u64,
    pub mask: u64,
    pub group: i32,
    pub is_static: i32,
}

#[repr(C)]
pub struct FindOptions {
    pub size: usize,
    pub algorithm: *const c_char,
    pub filters: *const Filter,
    pub right_filters: *const Filter,
    pub ignored: *const Pair,
    pub ignored_count: usize,
    pub executor: *const Executor,
    pub quarantines: c_int,
    pub leaves_out_touching: c_int,
    pub distance: f64,
    pub radii: *const f64,
    pub right_radii: *const f64,
    pub periods: *const f64,
    pub to: *const Boxes,
    pub right_to: *const Boxes,
}

#[repr(C)]
pub struct PairEvents {
    pub begun: *const Pair,
    pub begun_count: usize,
    pub ended: *const Pair,
    pub ended_count: usize,
}

#[repr(C)]
pub struct WorldOptions {
    pub size: usize,
    pub algorithm: *const c_char,
    pub margin: f64,
    pub relative_margin: f64,
    pub predicted_frames: f64,
    pub reports_enlarged: c_int,
    pub forgets_pairs: c_int,
    pub quarantines: c_int,
    pub first_generation: u32,
    pub executor: *const Executor,
    pub settings: *const c_char,
}

#[repr(C)]
pub struct Events {
    pub begun: *const HandlePair,
    pub begun_count: usize,
    pub ended: *const HandlePair,
    pub ended_count: usize,
}

#[repr(C)]
pub struct Query {
    pub filter: *const Filter,
    pub except: *const Handle,
    pub except_place: *const u32,
}

#[repr(C)]
pub struct Hit {
    pub handle: Handle,
    pub t_enter: f64,
}

#[repr(C)]
pub struct Neighbour {
    pub handle: Handle,
    pub distance_squared: f64,
}

pub type PairsCallback = unsafe extern "C" fn(user: *mut c_void, pairs: *const Pair, count: usize) -> c_int;

#[rustfmt::skip] // as in the header, a line each
extern "C" {
    pub fn broadside_version() -> *const c_char;
    pub fn broadside_find_options_init(options: *mut FindOptions);
    pub fn broadside_count_pairs(boxes: *const Boxes, right: *const Boxes, options: *const FindOptions, count: *mut u64, error: *mut Error) -> Status;
    pub fn broadside_for_each_pairs(boxes: *const Boxes, right: *const Boxes, options: *const FindOptions, callback: PairsCallback, user: *mut c_void, error: *mut Error) -> Status;
    pub fn broadside_find_pairs_batch(boxes: *const Boxes, offsets: *const usize, worlds: usize, options: *const FindOptions, pairs: *mut Pair, room: usize, pair_offsets: *mut usize, error: *mut Error) -> Status;
    pub fn broadside_components(boxes: *const Boxes, options: *const FindOptions, labels: *mut u32, error: *mut Error) -> Status;

    pub fn broadside_tracker_create(api_version: c_int, kind: Kind, options: *const FindOptions, tracker: *mut *mut Tracker, error: *mut Error) -> Status;
    pub fn broadside_tracker_destroy(tracker: *mut Tracker);
    pub fn broadside_tracker_update(tracker: *mut Tracker, boxes: *const Boxes, changed: *const u32, changed_count: usize, filters: *const Filter, events: *mut PairEvents, error: *mut Error) -> Status;

    pub fn broadside_world_options_init(options: *mut WorldOptions);
    pub fn broadside_world_create(api_version: c_int, kind: Kind, options: *const WorldOptions, world: *mut *mut World, error: *mut Error) -> Status;
    pub fn broadside_world_destroy(world: *mut World);
    pub fn broadside_world_add(world: *mut World, boxes: *const Boxes, filters: *const Filter, user_data: *const u64, handles: *mut Handle, error: *mut Error) -> Status;
    pub fn broadside_world_move(world: *mut World, handles: *const Handle, boxes: *const Boxes, velocities: *const c_void, error: *mut Error) -> Status;
    pub fn broadside_world_remove(world: *mut World, handles: *const Handle, count: usize, error: *mut Error) -> Status;
    pub fn broadside_world_update(world: *mut World, events: *mut Events, error: *mut Error) -> Status;
    pub fn broadside_world_pairs(world: *mut World, pairs: *mut *const HandlePair, count: *mut usize, error: *mut Error) -> Status;
    pub fn broadside_world_size(world: *const World) -> usize;
    pub fn broadside_world_contains(world: *const World, handle: Handle) -> c_int;
    pub fn broadside_world_box(world: *const World, handle: Handle, r#box: *mut c_void, error: *mut Error) -> Status;
    pub fn broadside_world_filter(world: *const World, handle: Handle, filter: *mut Filter, error: *mut Error) -> Status;
    pub fn broadside_world_user_data(world: *const World, handle: Handle, user_data: *mut u64, error: *mut Error) -> Status;
    pub fn broadside_world_set_filter(world: *mut World, handle: Handle, filter: *const Filter, error: *mut Error) -> Status;
    pub fn broadside_world_set_user_data(world: *mut World, handle: Handle, user_data: u64, error: *mut Error) -> Status;
    pub fn broadside_world_ignore(world: *mut World, a: Handle, b: Handle, ignores: c_int, error: *mut Error) -> Status;
    pub fn broadside_world_snapshot(world: *const World, bytes: *mut c_void, room: usize, size: *mut usize, error: *mut Error) -> Status;
    pub fn broadside_world_restore(world: *mut World, bytes: *const c_void, size: usize, error: *mut Error) -> Status;
    pub fn broadside_world_overlapping(world: *const World, r#box: *const c_void, query: *const Query, handles: *mut Handle, room: usize, count: *mut usize, error: *mut Error) -> Status;
    pub fn broadside_world_hits(world: *const World, r#box: *const c_void, direction: *const c_void, t_max: f64, query: *const Query, hits: *mut Hit, room: usize, count: *mut usize, error: *mut Error) -> Status;
    pub fn broadside_world_first_hit(world: *const World, r#box: *const c_void, direction: *const c_void, t_max: f64, query: *const Query, hit: *mut Hit, found: *mut c_int, error: *mut Error) -> Status;
    pub fn broadside_world_nearest_to_box(world: *const World, r#box: *const c_void, max_distance: f64, query: *const Query, neighbours: *mut Neighbour, room: usize, count: *mut usize, error: *mut Error) -> Status;

    pub fn broadside_index_create(api_version: c_int, kind: Kind, index: *mut *mut Index, error: *mut Error) -> Status;
    pub fn broadside_index_destroy(index: *mut Index);
    pub fn broadside_index_update(index: *mut Index, boxes: *const Boxes, changed: *const u32, changed_count: usize, filters: *const Filter, error: *mut Error) -> Status;
    pub fn broadside_index_overlapping(index: *const Index, r#box: *const c_void, query: *const Query, places: *mut u32, room: usize, count: *mut usize, error: *mut Error) -> Status;
    pub fn broadside_index_hits(index: *const Index, r#box: *const c_void, direction: *const c_void, t_max: f64, query: *const Query, hits: *mut Hit, room: usize, count: *mut usize, error: *mut Error) -> Status;
    pub fn broadside_index_first_hit(index: *const Index, r#box: *const c_void, direction: *const c_void, t_max: f64, query: *const Query, hit: *mut Hit, found: *mut c_int, error: *mut Error) -> Status;
    pub fn broadside_index_nearest_to_box(index: *const Index, r#box: *const c_void, max_distance: f64, query: *const Query, neighbours: *mut Neighbour, room: usize, count: *mut usize, error: *mut Error) -> Status;
}
