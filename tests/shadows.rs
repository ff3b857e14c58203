//! Shadows (paper §4) on small synthetic volumes: closed forms, equalities, bounds and tables (`--nocapture`).

#[path = "shadows/directions.rs"]
mod directions;
#[path = "shadows/edges.rs"]
mod edges;
#[path = "shadows/extremes.rs"]
mod extremes;
#[path = "shadows/physics.rs"]
mod physics;
#[path = "shadows/setup.rs"]
mod setup;
#[path = "shadows/slides.rs"]
mod slides;
#[path = "shadows/thrift.rs"]
mod thrift;
