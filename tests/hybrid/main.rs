//! Facts about the hybrid ray tracer (paper §2 and §6): closed forms, what is lossless, what is thrifty, what is watertight.

mod adaptive;
mod ball;
mod beside;
mod bounds;
mod closed_forms;
mod colors;
mod convergence;
mod embedded;
mod extremes;
mod filters;
mod layers;
mod lossless;
mod meshes;
mod perspective;
mod random_scenes;
mod reference;
mod scales;
mod several;
mod stopping;
mod support;
mod thin;
mod thrift;
mod voxel_rays;
mod watertight;
