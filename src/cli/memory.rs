//! How much memory a run may take: what `--max-memory` says, and what the system lets the process have.

use gelray::Error;

use super::bytes::human;
use super::failure::Failure;

/// A limit of memory, and who set it.
#[derive(Debug, Clone, Copy)]
pub struct Allowed {
    /// Bytes that may be taken beside those that are taken already.
    more: u64,
    /// Whether the limit is the system's.
    by_system: bool,
}

/// What a process takes before it does anything, where the system limits what it may map: to read a command line and a scene,
/// and for what is free between arrays.
const RESERVE: u64 = 16 << 20;

/// The stack of a thread, where the system limits what may be mapped.
const STACK: u64 = 1 << 20;

/// What a thread may map beside its stack, for arrays too small to be planned.
const THREAD: u64 = 1 << 20;

/// The stack that each of `threads` threads is to have, where the system limits what the process may map; an error where
/// they and the program have no room.
///
/// An allocation that fails ends the program without a word, so nothing is begun that may need more than there is.
pub fn stack(threads: usize) -> Result<Option<usize>, Failure> {
    let Some(left) = address_space_left() else { return Ok(None) };
    let needed = RESERVE.saturating_add((STACK + THREAD).saturating_mul(threads as u64));
    if needed <= left {
        return Ok(Some(STACK as usize));
    }
    let [needed, left] = [needed, left].map(human);
    Err(Failure::Said(format!(
        "the program and its {threads} threads need {needed} of memory and the system lets this process have {left} more; raise its limit (`ulimit -v`), or ask for fewer threads with --threads"
    )))
}

/// What may be taken beside `taken` bytes that were read already, of the `most` that flags allow; `None` where nobody sets a
/// limit.
pub fn allowed(most: Option<u64>, taken: u64) -> Option<Allowed> {
    let stated = most.map(|most| Allowed { more: most.saturating_sub(taken), by_system: false });
    let reserve = RESERVE + THREAD * rayon::current_num_threads() as u64;
    let system = address_space_left()
        .map(|left| Allowed { more: left.saturating_sub(reserve), by_system: true });
    stated.into_iter().chain(system).min_by_key(|allowed| allowed.more)
}

/// A failure if `needed` bytes are more than a run may take, beside what it has taken already; `most` as in [`allowed`].
pub fn check(needed: u64, most: Option<u64>) -> Result<(), Failure> {
    allowed(most, 0).map_or(Ok(()), |allowed| allowed.check(needed, 0))
}

impl Allowed {
    /// Bytes that may be taken beside those that are taken already.
    pub fn more(self) -> u64 {
        self.more
    }

    /// A failure if `needed` bytes more are more than there may be; `taken` were read already.
    pub fn check(self, needed: u64, taken: u64) -> Result<(), Failure> {
        if needed <= self.more {
            Ok(())
        } else if self.by_system {
            Err(self.refused(needed))
        } else {
            Err(Error::Memory { needed: needed.saturating_add(taken), allowed: self.more + taken }
                .into())
        }
    }

    /// The failure to load a scene: the system's limit in the words of this program.
    pub fn blame(self, error: Error) -> Failure {
        match error {
            Error::Memory { needed, .. } if self.by_system => self.refused(needed),
            error => error.into(),
        }
    }

    fn refused(self, needed: u64) -> Failure {
        let [needed, more] = [needed, self.more].map(human);
        Failure::Said(format!(
            "up to {needed} of memory are needed and the system lets this process have {more} more; raise its limit (`ulimit -v`), or choose a smaller `size`, volume or texture"
        ))
    }
}

/// Bytes that the process may still map, where the system limits them.
pub fn address_space_left() -> Option<u64> {
    let limits = std::fs::read_to_string("/proc/self/limits").ok()?;
    let limit = limits.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    let most: u64 = limit.split_whitespace().next()?.parse().ok()?;
    Some(most.saturating_sub(of_status("VmSize:")?))
}

/// A number of bytes that the system keeps of this process; `None` where it does not tell.
pub fn of_status(name: &str) -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix(name))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1024)
}
