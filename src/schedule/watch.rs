//! What the outside may see and say while systems run: how far they are, and to stop.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use crate::error::Error;

/// Progress of the running system, and a request to stop. Shared between threads; never part of a result.
#[derive(Debug, Default)]
pub struct Watch {
    stopped: AtomicBool,
    done: AtomicU64,
    total: AtomicU64,
    stage: Mutex<&'static str>,
}

impl Watch {
    /// Asks the systems to stop as soon as they can.
    pub fn stop(&self) {
        self.stopped.store(true, Ordering::Relaxed);
    }

    /// Takes a request to stop back, so that the work can be begun again.
    pub fn go_on(&self) {
        self.stopped.store(false, Ordering::Relaxed);
    }

    /// An error if somebody asked to stop.
    pub fn check(&self) -> Result<(), Error> {
        if self.stopped.load(Ordering::Relaxed) { Err(Error::Interrupted) } else { Ok(()) }
    }

    /// Announces so many pieces of work more.
    pub fn expect(&self, pieces: u64) {
        self.total.fetch_add(pieces, Ordering::Relaxed);
    }

    /// Counts one piece of work as done.
    pub fn advance(&self) {
        self.done.fetch_add(1, Ordering::Relaxed);
    }

    /// The running system, and how many of its expected pieces of work are done.
    #[must_use]
    pub fn progress(&self) -> (&'static str, u64, u64) {
        let stage = self.stage.lock().map_or("", |stage| *stage);
        (stage, self.done.load(Ordering::Relaxed), self.total.load(Ordering::Relaxed))
    }

    pub(super) fn begin(&self, stage: &'static str) {
        if let Ok(mut running) = self.stage.lock() {
            *running = stage;
        }
        self.done.store(0, Ordering::Relaxed);
        self.total.store(0, Ordering::Relaxed);
    }
}
