//! Ctrl-C: the first stops the work at the next piece of it, so that files stay whole; a second one exits at once.

use std::process::exit;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use gelray::Error;
use gelray::schedule::Watch;

use super::failure::{INTERRUPTED, tell};

/// A watch that Ctrl-C (or a request to terminate) stops.
#[derive(Debug, Default)]
pub struct Interrupt {
    /// What systems ask.
    pub watch: Arc<Watch>,
    working: Arc<AtomicBool>,
    appearing: Arc<Mutex<()>>,
}

impl Interrupt {
    /// Listens from now on.
    pub fn listen() -> Self {
        let interrupt = Self::default();
        let (watch, working) = (interrupt.watch.clone(), interrupt.working.clone());
        let appearing = interrupt.appearing.clone();
        // Where there is no handler to be had, Ctrl-C ends the program, as it does any.
        let _ = ctrlc::set_handler(move || {
            // While a scene is loaded nobody asks the watch, and no file is open for writing.
            if watch.check().is_err() || !working.load(Ordering::Relaxed) {
                let _whole = appearing.lock();
                exit(i32::from(INTERRUPTED));
            }
            watch.stop();
            tell(format_args!("stopping; press again to stop at once"));
        });
        interrupt
    }

    /// While this is held even a second request waits; an error if there was a first.
    pub fn hold(&self) -> Result<MutexGuard<'_, ()>, Error> {
        let held = self.appearing.lock().unwrap_or_else(PoisonError::into_inner);
        self.watch.check()?;
        Ok(held)
    }

    /// From now on the work asks the watch and is given the time to end by itself.
    pub fn work_begins(&self) {
        self.working.store(true, Ordering::Relaxed);
    }
}
