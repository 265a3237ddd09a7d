//! The crate's tests, in one program, so that they link once.
mod calls;
mod declarations;
mod equivalence;
