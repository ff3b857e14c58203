//! Views: the camera and the walk of its rays, the samples on them, how they are composited, and the picture.

pub mod composite;
pub mod picture;
pub mod samples;
pub mod walk;
