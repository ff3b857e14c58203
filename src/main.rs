//! The `gelray` program.
fn main() {}
