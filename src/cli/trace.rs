//! `--trace`: the spans of systems and of bands of rays, for Chrome's and Perfetto's viewers.

use std::io::Write;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use gelray::Error;
use gelray::formats::whole::{Whole, written_beside};
use tracing::Subscriber;
use tracing::field::{Field, Visit};
use tracing::span::{Attributes, Id};
use tracing_chrome::{ChromeLayerBuilder, EventOrSpan, FlushGuard};
use tracing_subscriber::Layer;
use tracing_subscriber::layer::{Context, SubscriberExt};
use tracing_subscriber::registry::LookupSpan;
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
        let builder = ChromeLayerBuilder::new().writer(gathered.clone()).name_fn(Box::new(name));
        let (layer, guard) = builder.include_args(true).include_locations(false).build();
        // Nobody else in this program gathers spans.
        let _ = tracing_subscriber::registry().with(Stages).with(layer).try_init();
        Self { guard, gathered }
    }

    /// A file of what was gathered, not yet seen.
    pub fn end(self, path: &Path) -> Result<Whole, Error> {
        drop(self.guard);
        let bytes = self.gathered.0.lock().unwrap_or_else(PoisonError::into_inner);
        written_beside(path, |out| Ok(out.write_all(&bytes)?))
    }
}

/// A span of a system is called by its stage.
fn name<S: Subscriber + for<'a> LookupSpan<'a> + Send + Sync>(
    of: &EventOrSpan<'_, '_, S>,
) -> String {
    match of {
        EventOrSpan::Event(event) => event.metadata().name().to_owned(),
        EventOrSpan::Span(span) => match span.extensions().get::<Stage>() {
            Some(Stage(Some(stage))) => stage.clone(),
            _ => span.name().to_owned(),
        },
    }
}

/// Keeps with a span of a system the stage that it is of: the viewers would call all of them `system`.
struct Stages;

/// The stage that a span's field `name` says.
#[derive(Default)]
struct Stage(Option<String>);

impl<S: Subscriber + for<'a> LookupSpan<'a>> Layer<S> for Stages {
    fn on_new_span(&self, attributes: &Attributes<'_>, id: &Id, context: Context<'_, S>) {
        let mut stage = Stage::default();
        attributes.record(&mut stage);
        if let Some(span) = context.span(id).filter(|span| span.name() == "system") {
            span.extensions_mut().insert(stage);
        }
    }
}

impl Visit for Stage {
    fn record_str(&mut self, field: &Field, value: &str) {
        if field.name() == "name" {
            self.0 = Some(value.to_owned());
        }
    }

    fn record_debug(&mut self, _: &Field, _: &dyn std::fmt::Debug) {}
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
