use std::ffi::CStr;
use std::fmt;
use std::mem::MaybeUninit;

use crate::ffi;

/// Why a call failed. It has changed nothing.
///
/// `Display` gives the library's message: the thing, the value found and the value expected.
///
/// ```
/// use broadside::{find_pairs, Box2, Error};
///
/// let boxes = [Box2::new([0.0, 0.0], [1.0, 1.0]), Box2::new([3.0, 0.0], [2.0, 1.0])];
/// match find_pairs(&boxes) {
///     Err(Error::InvalidInput { index, .. }) => assert_eq!(index, 1),
///     other => panic!("{other:?}"),
/// }
/// let error = find_pairs(&boxes).unwrap_err();
/// assert!(error.to_string().starts_with("box 1 has min (3, 0) and max (2, 1)"));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error {
    /// A box with a NaN or with min > max: the first such box.
    InvalidInput {
        /// Its place in the slice.
        index: usize,
        /// The message.
        message: String,
    },
    /// Arrays that do not fit together.
    InvalidFrame(String),
    /// A query with a NaN, or with an infinity where none is allowed.
    InvalidQuery(String),
    /// An unknown algorithm, or a setting out of its range.
    InvalidSpec(String),
    /// A handle that names no box of this world.
    InvalidHandle(String),
    /// Bytes that are not a snapshot of a world like this.
    InvalidSnapshot(String),
    /// Another invalid argument.
    InvalidArgument(String),
    /// The library could not allocate memory.
    OutOfMemory(String),
    /// Anything else.
    Failed(String),
}

impl Error {
    /// The message, which `Display` gives as well.
    ///
    /// ```
    /// let options = broadside::FindOptions { algorithm: "gird", ..Default::default() };
    /// let error = options.find_pairs(&[broadside::Box2::point([0.0, 0.0])]).unwrap_err();
    /// assert!(error.message().contains("gird"));
    /// ```
    pub fn message(&self) -> &str {
        match self {
            Error::InvalidInput { message, .. }
            | Error::InvalidFrame(message)
            | Error::InvalidQuery(message)
            | Error::InvalidSpec(message)
            | Error::InvalidHandle(message)
            | Error::InvalidSnapshot(message)
            | Error::InvalidArgument(message)
            | Error::OutOfMemory(message)
            | Error::Failed(message) => message,
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.message())
    }
}

impl std::error::Error for Error {}

/// A status other than OK, and what the library wrote about it.
pub(crate) struct Failure {
    pub status: ffi::Status,
    index: usize,
    message: String,
}

/// Makes a call, which gets a place for its error.
pub(crate) fn call(call: impl FnOnce(*mut ffi::Error) -> ffi::Status) -> Result<(), Failure> {
    let mut error = MaybeUninit::uninit();
    let status = call(error.as_mut_ptr());
    if status == ffi::BROADSIDE_OK {
        return Ok(());
    }
    let error: *const ffi::Error = error.as_ptr();
    // SAFETY: a call that fails has written its error: the index, and a message that ends with a 0.
    let (index, message) = unsafe { ((*error).index, CStr::from_ptr(std::ptr::addr_of!((*error).message).cast())) };
    Err(Failure { status, index: index as usize, message: message.to_string_lossy().into_owned() })
}

impl From<Failure> for Error {
    fn from(failure: Failure) -> Self {
        let Failure { status, index, message } = failure;
        match status {
            ffi::BROADSIDE_INVALID_INPUT => Error::InvalidInput { index, message },
            ffi::BROADSIDE_INVALID_FRAME => Error::InvalidFrame(message),
            ffi::BROADSIDE_INVALID_QUERY => Error::InvalidQuery(message),
            ffi::BROADSIDE_INVALID_SPEC => Error::InvalidSpec(message),
            ffi::BROADSIDE_INVALID_HANDLE => Error::InvalidHandle(message),
            ffi::BROADSIDE_INVALID_SNAPSHOT => Error::InvalidSnapshot(message),
            ffi::BROADSIDE_INVALID_ARGUMENT => Error::InvalidArgument(message),
            ffi::BROADSIDE_OUT_OF_MEMORY => Error::OutOfMemory(message),
            _ => Error::Failed(message),
        }
    }
}

/// Refuses an array that has not one element for each of `expected` things: the library would read beyond its end.
pub(crate) fn check_length(name: &str, found: usize, expected: usize) -> Result<(), Error> {
    if found == expected {
        return Ok(());
    }
    Err(Error::InvalidFrame(format!("there are {found} {name}; expected {expected}, one for each box")))
}

/// Calls `fill(buffer, room, count, error)`, a second time if there is more than `room` at first.
pub(crate) fn collect<T>(
    room: usize,
    fill: impl Fn(*mut T, usize, *mut usize, *mut ffi::Error) -> ffi::Status,
) -> Result<Vec<T>, Error> {
    let mut found = Vec::with_capacity(room);
    loop {
        let mut count = 0;
        match call(|error| fill(found.as_mut_ptr(), found.capacity(), &mut count, error)) {
            Ok(()) => {
                // SAFETY: the call has written `count` elements, which had room.
                unsafe { found.set_len(count) };
                return Ok(found);
            }
            Err(failure) if failure.status == ffi::BROADSIDE_TOO_SMALL => found.reserve_exact(count),
            Err(failure) => return Err(failure.into()),
        }
    }
}
