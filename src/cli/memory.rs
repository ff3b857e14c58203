//! How much memory a run may take: what `--max-memory` says, and what the system lets the process have.

use gelray::Error;

use super::bytes::human;
use super::failure::Failure;
use super::flags::Flags;

/// A limit of memory, and who set it.
#[derive(Debug, Clone, Copy)]
pub struct Allowed {
    /// Bytes that may be taken beside those that are taken already.
    more: u64,
    /// Whether the limit is the system's.
    by_system: bool,
}

/// What may be taken beside `taken` bytes that were read already; `None` where nobody sets a limit.
pub fn allowed(flags: &Flags, taken: u64) -> Option<Allowed> {
    let stated =
        flags.max_memory.map(|most| Allowed { more: most.saturating_sub(taken), by_system: false });
    let system = address_space_left().map(|more| Allowed { more, by_system: true });
    stated.into_iter().chain(system).min_by_key(|allowed| allowed.more)
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
            "up to {needed} of memory are needed and the system lets this process have {more} more; raise its limit (`ulimit -v`), or choose a smaller `size` or volume"
        ))
    }
}

/// Bytes that the process may still map, where the system limits them.
fn address_space_left() -> Option<u64> {
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
