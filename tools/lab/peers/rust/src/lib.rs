//! Collision libraries from crates.io behind one C interface: include/rust_peers.h describes its functions.
//!
//! No panic leaves it: a function whose crate panics fails, and `rust_peer_error` has the message.

#[cfg(feature = "engines")]
mod dynamic_tree;
mod geo_index_tree;
#[cfg(feature = "engines")]
mod kept_pairs;
#[cfg(feature = "engines")]
mod obvhs_bvh;
mod packed_index;
mod panicking;
#[cfg(feature = "engines")]
mod parry_bvh;
mod peer;
#[cfg(feature = "engines")]
mod physx_broad_phase;
mod queries;
#[cfg(feature = "engines")]
mod rapier_broad_phase;
mod rstar_tree;
#[cfg(feature = "engines")]
mod simulations;

use std::any::Any;
use std::cell::RefCell;
use std::ffi::{c_char, c_int, c_void, CStr, CString};
use std::ops::ControlFlow;
use std::panic::{catch_unwind, set_hook, AssertUnwindSafe};
use std::sync::Once;

#[cfg(feature = "engines")]
use physx_sys::PxBroadPhaseType;

use peer::{Bounds, Filter, Follower, Frame, Pairs, Searcher, Takes};
use queries::{AnyIndex, Geo, Packed2, Packed3, Rstar};

thread_local! {
    static PANIC_PLACE: RefCell<String> = const { RefCell::new(String::new()) };
    static ERROR: RefCell<CString> = RefCell::new(CString::default());
}

/// The part of a source's path that names the crate and the file in it.
fn place_in_crate(path: &str) -> &str {
    let in_registry = path.split_once("/registry/src/").and_then(|(_, rest)| rest.split_once('/'));
    in_registry.map_or(path, |(_, place)| place)
}

/// Keeps panics from standard error: their message is returned instead.
fn silence_panics() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        set_hook(Box::new(|panic| {
            let place = panic.location().map_or(String::new(), |location| {
                format!(" ({}, line {})", place_in_crate(location.file()), location.line())
            });
            PANIC_PLACE.set(place);
        }));
    });
}

fn message_of(payload: &(dyn Any + Send)) -> &str {
    if let Some(text) = payload.downcast_ref::<&str>() {
        text
    } else {
        payload.downcast_ref::<String>().map_or("without a message", |text| text)
    }
}

/// Runs `body`. If it panics, keeps the message and returns `None`.
fn guarded<T>(body: impl FnOnce() -> T) -> Option<T> {
    silence_panics();
    match catch_unwind(AssertUnwindSafe(body)) {
        Ok(result) => Some(result),
        Err(payload) => {
            let text = format!("a panic: {}{}", message_of(&*payload), PANIC_PLACE.take());
            ERROR.set(CString::new(text.replace('\0', " ")).unwrap_or_default());
            None
        }
    }
}

pub enum AnySearcher {
    Flat(Box<dyn Searcher<2>>),
    Solid(Box<dyn Searcher<3>>),
}

pub enum AnyFollower {
    Flat(Box<dyn Follower<2>>),
    Solid(Box<dyn Follower<3>>),
}

fn searcher_named(name: &str, dimension: c_int, threads: usize) -> AnySearcher {
    use AnySearcher::{Flat, Solid};
    match (name, dimension) {
        ("packed_spatial_index", 2) => Flat(Box::new(packed_index::Searcher2::new(threads))),
        ("packed_spatial_index", 3) => Solid(Box::new(packed_index::Searcher3::new(threads))),
        #[cfg(feature = "engines")]
        ("parry", 2) => Flat(Box::<parry_bvh::flat::BvhSearcher>::default()),
        #[cfg(feature = "engines")]
        ("parry", 3) => Solid(Box::<parry_bvh::solid::BvhSearcher>::default()),
        #[cfg(feature = "engines")]
        ("rapier", 2) => Flat(Box::<rapier_broad_phase::flat::BroadPhaseSearcher>::default()),
        #[cfg(feature = "engines")]
        ("rapier", 3) => Solid(Box::<rapier_broad_phase::solid::BroadPhaseSearcher>::default()),
        #[cfg(feature = "engines")]
        ("obvhs", 2) => Flat(Box::<obvhs_bvh::BvhSearcher>::default()),
        #[cfg(feature = "engines")]
        ("obvhs", 3) => Solid(Box::<obvhs_bvh::BvhSearcher>::default()),
        #[cfg(feature = "engines")]
        ("box2d3", 2) => Flat(Box::new(dynamic_tree::box2d::TreeSearcher::new(threads))),
        #[cfg(feature = "engines")]
        ("box3d", 3) => Solid(Box::new(dynamic_tree::box3d::TreeSearcher::new(threads))),
        #[cfg(feature = "engines")]
        ("physx_abp", 3) => Solid(Box::new(physx_broad_phase::PhaseSearcher::new(PxBroadPhaseType::Abp))),
        #[cfg(feature = "engines")]
        ("physx_sap", 3) => Solid(Box::new(physx_broad_phase::PhaseSearcher::new(PxBroadPhaseType::Sap))),
        ("geo_index", 2) => Flat(Box::<geo_index_tree::TreeSearcher>::default()),
        ("rstar", 2) => Flat(Box::<rstar_tree::TreeSearcher<2>>::default()),
        ("rstar", 3) => Solid(Box::<rstar_tree::TreeSearcher<3>>::default()),
        ("panicking", 2) => Flat(Box::new(panicking::PanickingSearcher)),
        _ => panic!("no searcher '{name}' in {dimension}D"),
    }
}

fn index_named(name: &str, dimension: c_int, boxes: *const f32, count: usize) -> AnyIndex {
    use AnyIndex::{Flat, Solid};
    // SAFETY: the caller of the C interface gave this many boxes.
    let flat = || unsafe { slice(boxes.cast::<Bounds<2>>(), count) };
    let solid = || unsafe { slice(boxes.cast::<Bounds<3>>(), count) };
    match (name, dimension) {
        ("packed_spatial_index", 2) => Flat(Box::new(Packed2::new(flat()))),
        ("packed_spatial_index", 3) => Solid(Box::new(Packed3::new(solid()))),
        ("geo_index", 2) => Flat(Box::new(Geo::new(flat()))),
        ("rstar", 2) => Flat(Box::new(Rstar::new(flat()))),
        ("rstar", 3) => Solid(Box::new(Rstar::new(solid()))),
        _ => panic!("no index '{name}' in {dimension}D"),
    }
}

#[cfg_attr(not(feature = "engines"), allow(unused_variables))]
fn follower_named(name: &str, dimension: c_int, threads: usize) -> AnyFollower {
    match (name, dimension) {
        #[cfg(feature = "engines")]
        ("parry", 2) => AnyFollower::Flat(Box::<parry_bvh::flat::BvhFollower>::default()),
        #[cfg(feature = "engines")]
        ("parry", 3) => AnyFollower::Solid(Box::<parry_bvh::solid::BvhFollower>::default()),
        #[cfg(feature = "engines")]
        ("rapier", 2) => AnyFollower::Flat(Box::<rapier_broad_phase::flat::BroadPhaseFollower>::default()),
        #[cfg(feature = "engines")]
        ("rapier", 3) => AnyFollower::Solid(Box::<rapier_broad_phase::solid::BroadPhaseFollower>::default()),
        #[cfg(feature = "engines")]
        ("box2d3", 2) => AnyFollower::Flat(Box::new(dynamic_tree::box2d::TreeFollower::new(threads))),
        #[cfg(feature = "engines")]
        ("box3d", 3) => AnyFollower::Solid(Box::new(dynamic_tree::box3d::TreeFollower::new(threads))),
        #[cfg(feature = "engines")]
        ("physx_abp", 3) => AnyFollower::Solid(Box::new(physx_broad_phase::PhaseFollower::new(PxBroadPhaseType::Abp))),
        #[cfg(feature = "engines")]
        ("physx_sap", 3) => AnyFollower::Solid(Box::new(physx_broad_phase::PhaseFollower::new(PxBroadPhaseType::Sap))),
        _ => panic!("no follower '{name}' in {dimension}D"),
    }
}

/// # Safety
/// `data` has `count` elements; it may be null if there are none.
unsafe fn slice<'a, T>(data: *const T, count: usize) -> &'a [T] {
    match count {
        0 => &[],
        _ => std::slice::from_raw_parts(data, count),
    }
}

/// # Safety
/// `name` is a C string.
unsafe fn text<'a>(name: *const c_char) -> &'a str {
    CStr::from_ptr(name).to_str().expect("a name in UTF-8")
}

#[no_mangle]
pub extern "C" fn rust_peer_error() -> *const c_char {
    ERROR.with_borrow(|error| error.as_ptr())
}

/// # Safety
/// See the header, as for the functions below.
#[no_mangle]
pub unsafe extern "C" fn rust_peer_version(crate_name: *const c_char) -> *const c_char {
    let version = guarded(|| {
        let start = format!("name = \"{}\"\nversion = \"", text(crate_name));
        let (_, rest) = include_str!("../Cargo.lock").split_once(&start)?;
        CString::new(rest.split_once('"')?.0).ok()
    });
    version.flatten().map_or(std::ptr::null(), |found| found.into_raw().cast_const())
}

#[no_mangle]
pub unsafe extern "C" fn rust_searcher_new(name: *const c_char, dimension: c_int, threads: usize) -> *mut AnySearcher {
    guarded(|| Box::into_raw(Box::new(searcher_named(text(name), dimension, threads)))).unwrap_or(std::ptr::null_mut())
}

#[no_mangle]
pub unsafe extern "C" fn rust_follower_new(name: *const c_char, dimension: c_int, threads: usize) -> *mut AnyFollower {
    guarded(|| Box::into_raw(Box::new(follower_named(text(name), dimension, threads)))).unwrap_or(std::ptr::null_mut())
}

#[no_mangle]
pub unsafe extern "C" fn rust_searcher_free(searcher: *mut AnySearcher) {
    guarded(|| drop(Box::from_raw(searcher)));
}

#[no_mangle]
pub unsafe extern "C" fn rust_follower_free(follower: *mut AnyFollower) {
    guarded(|| drop(Box::from_raw(follower)));
}

fn run<const D: usize>(
    searcher: &mut dyn Searcher<D>,
    boxes: &[Bounds<D>],
    left_count: usize,
    filters: &[Filter],
    length: f32,
    pairs: &mut Pairs,
) -> ControlFlow<()> {
    match left_count {
        0 if filters.is_empty() => searcher.search(boxes, length, pairs),
        0 => searcher.search_filtered(boxes, filters, length, pairs),
        _ => searcher.join(boxes, left_count, length, pairs),
    }
}

#[no_mangle]
pub unsafe extern "C" fn rust_searcher_search(
    searcher: *mut AnySearcher,
    boxes: *const f32,
    count: usize,
    left_count: usize,
    filters: *const Filter,
    length: f32,
    takes: Takes,
    context: *mut c_void,
) -> bool {
    let search = || {
        if count < 2 {
            return;
        }
        let mut pairs = Pairs::new(takes, context);
        let filters = slice(filters, if filters.is_null() { 0 } else { count });
        let found = match &mut *searcher {
            AnySearcher::Flat(flat) => {
                run(&mut **flat, slice(boxes.cast(), count), left_count, filters, length, &mut pairs)
            }
            AnySearcher::Solid(solid) => {
                run(&mut **solid, slice(boxes.cast(), count), left_count, filters, length, &mut pairs)
            }
        };
        if found.is_continue() {
            let _ = pairs.flush();
        }
    };
    guarded(search).is_some()
}

#[no_mangle]
pub unsafe extern "C" fn rust_searcher_tear_down(searcher: *mut AnySearcher) -> bool {
    let tear_down = || match &mut *searcher {
        AnySearcher::Flat(flat) => flat.tear_down(),
        AnySearcher::Solid(solid) => solid.tear_down(),
    };
    guarded(tear_down).is_some()
}

#[no_mangle]
pub unsafe extern "C" fn rust_follower_build(
    follower: *mut AnyFollower,
    boxes: *const f32,
    count: usize,
    length: f32,
) -> bool {
    let build = || match &mut *follower {
        AnyFollower::Flat(flat) => flat.build(slice(boxes.cast::<Bounds<2>>(), count), length),
        AnyFollower::Solid(solid) => solid.build(slice(boxes.cast::<Bounds<3>>(), count), length),
    };
    guarded(build).is_some()
}

#[no_mangle]
pub unsafe extern "C" fn rust_follower_update(
    follower: *mut AnyFollower,
    boxes: *const f32,
    count: usize,
    changed: *const u32,
    changed_count: usize,
    flags: *const u8,
    takes: Takes,
    context: *mut c_void,
) -> bool {
    let update = || {
        let mut pairs = Pairs::new(takes, context);
        let changed = slice(changed, changed_count);
        let flags = slice(flags, count);
        let found = match &mut *follower {
            AnyFollower::Flat(flat) => {
                let boxes = slice(boxes.cast::<Bounds<2>>(), count);
                flat.update(&Frame { boxes, changed, flags }, &mut pairs)
            }
            AnyFollower::Solid(solid) => {
                let boxes = slice(boxes.cast::<Bounds<3>>(), count);
                solid.update(&Frame { boxes, changed, flags }, &mut pairs)
            }
        };
        if found.is_continue() {
            let _ = pairs.flush();
        }
    };
    guarded(update).is_some()
}

#[no_mangle]
pub unsafe extern "C" fn rust_index_new(
    name: *const c_char,
    dimension: c_int,
    boxes: *const f32,
    count: usize,
) -> *mut AnyIndex {
    guarded(|| Box::into_raw(Box::new(index_named(text(name), dimension, boxes, count))))
        .unwrap_or(std::ptr::null_mut())
}

#[no_mangle]
pub unsafe extern "C" fn rust_index_free(index: *mut AnyIndex) {
    guarded(|| drop(Box::from_raw(index)));
}

#[no_mangle]
pub unsafe extern "C" fn rust_index_ask(
    index: *mut AnyIndex,
    kind: queries::Kind,
    queries: *const f32,
    count: usize,
    takes: Takes,
    context: *mut c_void,
) -> bool {
    let ask = || {
        let mut found = Pairs::new(takes, context);
        let _ = match &mut *index {
            AnyIndex::Flat(flat) => queries::ask(&mut **flat, kind, queries, count, &mut found),
            AnyIndex::Solid(solid) => queries::ask(&mut **solid, kind, queries, count, &mut found),
        };
    };
    guarded(ask).is_some()
}

#[no_mangle]
pub unsafe extern "C" fn rust_index_nearest(
    index: *mut AnyIndex,
    points: *const f32,
    count: usize,
    max_results: usize,
    takes: Takes,
    context: *mut c_void,
) -> bool {
    let ask = || {
        let mut found = Pairs::new(takes, context);
        let _ = match &mut *index {
            AnyIndex::Flat(flat) => queries::nearest(&mut **flat, slice(points.cast(), count), max_results, &mut found),
            AnyIndex::Solid(solid) => {
                queries::nearest(&mut **solid, slice(points.cast(), count), max_results, &mut found)
            }
        };
    };
    guarded(ask).is_some()
}
