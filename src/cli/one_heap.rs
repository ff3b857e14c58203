//! One heap for all threads, where the system limits what the process may map.

use std::ffi::OsString;

use super::memory::address_space_left;

/// Begins the program anew with one heap for all threads, where the system limits what it may map.
///
/// glibc has each thread take 64 MiB of what may be mapped for a heap of its own, at its first small array, whenever that
/// is: what was weighed before is then no longer left, and an array that fails ends the program without a word. It is told
/// otherwise by its environment alone, which it reads before the program begins. Large arrays are given back to the
/// system as soon as they are done with, so that what is left is left for all.
///
/// Comes back where nothing is to be done, and where the program cannot be begun anew: the work goes on then as it is.
pub fn share(arguments: &[OsString]) {
    if address_space_left().is_some() && cfg!(all(target_os = "linux", target_env = "gnu")) {
        again(arguments);
    }
}

#[cfg(unix)]
fn again(arguments: &[OsString]) {
    use std::os::unix::process::CommandExt;

    let heaps = ("MALLOC_ARENA_MAX", "1");
    let large = ("MALLOC_MMAP_THRESHOLD_", "131072");
    let Some((name, rest)) = arguments.split_first() else { return };
    if std::env::var_os(heaps.0).is_some_and(|stated| stated == heaps.1) {
        return;
    }
    let mut program = std::process::Command::new("/proc/self/exe");
    // It comes back only with an error.
    let _ = program.arg0(name).args(rest).envs([heaps, large]).exec();
}

#[cfg(not(unix))]
fn again(_: &[OsString]) {}
