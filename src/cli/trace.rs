//! `--trace`: the spans of systems and of bands of rays, for Chrome's and Perfetto's viewers.

use std::io::Write;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use gelray::Error;
use gelray::formats::whole::write_whole;
use tracing_chrome::{ChromeLayerBuilder, FlushGuard};
use tracing_subscriber::layer::SubscriberExt;
use tracing_subscriber::util::SubscriberInitExt;

/// Spans being gathered, in memory: the writer's thread must not meet a full disc.
pub struct Trace {
    guard: FlushGuard,
    gathered: Gathered,
}

impl Trace {
    /// Gathers spans of all levels from now on, of all threads.
    pub fn begin() -> Self {
        let gathered = Gathered::default();
        let builder = ChromeLayerBuilder::new().writer(gathered.clone());
        let (layer, guard) = builder.include_args(true).include_locations(false).build();
        // Nobody else in this program gathers spans.
        let _ = tracing_subscriber::registry().with(layer).try_init();
        Self { guard, gathered }
    }

    /// Writes what was gathered.
    pub fn end(self, path: &Path) -> Result<(), Error> {
        drop(self.guard);
        let bytes = self.gathered.0.lock().unwrap_or_else(PoisonError::into_inner);
        write_whole(path, |out| Ok(out.write_all(&bytes)?))
    }
}

/// Bytes that two threads share.
#[derive(Clone, Default)]
struct Gathered(Arc<Mutex<Vec<u8>>>);

impl Write for Gathered {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}
