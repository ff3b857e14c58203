//! 3D scan-conversion (paper §3): what a voxelized polygon lets through, where it is, what it costs, how it is matted.

#[path = "scan_convert/extremes.rs"]
mod extremes;
#[path = "scan_convert/matting.rs"]
mod matting;
#[path = "scan_convert/opacity.rs"]
mod opacity;
#[path = "scan_convert/place.rs"]
mod place;
#[path = "scan_convert/scene.rs"]
mod scene;
