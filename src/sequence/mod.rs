//! Sequences of pictures: an observer who turns, values that change by keyframes, one world kept from picture to picture.
//!
//! A [`film::Film`] is a scene and how it moves: each of its pictures is, byte for byte, that of the scene with a few
//! values set, whichever was rendered before it and wherever a shard begins. [`pipeline`] encodes beside rendering,
//! [`numbered`] names and recognizes files of single pictures, [`manifest`] lists them.

pub mod digest;
pub mod film;
pub mod manifest;
pub mod numbered;
pub mod pipeline;
pub mod range;
pub mod tracks;
pub mod turn;
