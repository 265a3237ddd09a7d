// Finds overlapping boxes from Rust: hand-written declarations of the functions of broadside.h, and a safe wrapper.
use std::ffi::CStr;
use std::os::raw::{c_char, c_int, c_void}; // in std::ffi since Rust 1.64
use std::ptr;

// As in broadside.h.
const BROADSIDE_OK: i32 = 0;
const BROADSIDE_TOO_SMALL: i32 = 8;
const BROADSIDE_FLOAT_2D: i32 = 0;
const BROADSIDE_C_API_VERSION: c_int = 2;

#[repr(C)]
struct Boxes {
    kind: i32,
    first: *const c_void,
    count: usize,
    stride: usize,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Pair {
    first: u32,
    second: u32,
}

#[repr(C)]
struct Error {
    status: i32,
    index: u64,
    message: [c_char; 1000],
}

#[link(name = "broadside")]
extern "C" {
    fn broadside_c_api_version() -> c_int;
    fn broadside_find_pairs(
        boxes: *const Boxes,
        right: *const Boxes,
        options: *const c_void,
        pairs: *mut Pair,
        room: usize,
        count: *mut u64,
        error: *mut Error,
    ) -> i32;
}

/// A box: its minima, then its maxima.
type Box2 = [f32; 4];

/// Every pair of overlapping or touching boxes, or an error message about the boxes.
fn find_pairs(boxes: &[Box2]) -> Result<Vec<Pair>, String> {
    let all = Boxes { kind: BROADSIDE_FLOAT_2D, first: boxes.as_ptr().cast(), count: boxes.len(), stride: 0 };
    let mut pairs = vec![Pair::default(); boxes.len()];
    let mut error = Error { status: BROADSIDE_OK, index: 0, message: [0; 1000] };
    loop {
        let mut count = 0;
        // The library reads `count` boxes, writes at most `room` pairs, and keeps no pointer.
        let status = unsafe {
            broadside_find_pairs(&all, ptr::null(), ptr::null(), pairs.as_mut_ptr(), pairs.len(), &mut count, &mut error)
        };
        match status {
            BROADSIDE_OK => {
                pairs.truncate(count as usize);
                return Ok(pairs);
            }
            BROADSIDE_TOO_SMALL => pairs.resize(count as usize, Pair::default()),
            _ => {
                let message = unsafe { CStr::from_ptr(error.message.as_ptr()) };
                return Err(message.to_string_lossy().into_owned());
            }
        }
    }
}

fn main() {
    assert_eq!(unsafe { broadside_c_api_version() }, BROADSIDE_C_API_VERSION, "a library of another version");
    let boxes = [[0.0, 0.0, 2.0, 2.0], [1.0, 1.0, 3.0, 3.0], [3.0, 0.0, 4.0, 1.0], [8.0, 8.0, 9.0, 9.0]];
    for pair in find_pairs(&boxes).unwrap() {
        println!("{} and {}", pair.first, pair.second);
    }
    println!("{}", find_pairs(&[[0.0, 0.0, f32::NAN, 1.0]]).unwrap_err());
}
