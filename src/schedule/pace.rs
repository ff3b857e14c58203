//! Equal intervals, for what is told while systems run; no result depends on them.

use std::sync::Mutex;
use std::time::{Duration, Instant};

/// What happens at most once in an interval.
#[derive(Debug)]
pub struct Pace {
    every: Duration,
    last: Mutex<Option<Instant>>,
}

impl Pace {
    /// Once in `every`; it is time for the first at once.
    #[must_use]
    pub fn new(every: Duration) -> Self {
        Self { every, last: Mutex::new(None) }
    }

    /// Whether the interval since the last is over.
    #[must_use]
    pub fn is_due(&self) -> bool {
        let last = self.last.lock().map_or(None, |last| *last);
        last.is_none_or(|last| last.elapsed() >= self.every)
    }

    /// It has happened now.
    pub fn happened(&self) {
        if let Ok(mut last) = self.last.lock() {
            *last = Some(Instant::now());
        }
    }
}
