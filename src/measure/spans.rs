//! What an act took, by the spans that were open while it ran.

use tracing_subscriber::layer::SubscriberExt;

use super::cost_table::{CostTable, Row};

/// Does it, and sums its spans: those of the thread that it is called on. Spans on threads that compute beside it are not
/// even opened, so that telling them costs nothing.
pub fn spanned<R>(act: impl FnOnce() -> R) -> (R, Vec<Row>) {
    let table = CostTable::default();
    let subscriber = tracing_subscriber::registry().with(table.layer());
    let done = tracing::subscriber::with_default(subscriber, act);
    (done, table.rows())
}

/// Seconds of the systems of some names among the sums of spans.
#[must_use]
pub fn seconds_of(rows: &[Row], systems: &[&str]) -> f64 {
    let named = |row: &&Row| row.made.is_some() && systems.contains(&row.name.as_str());
    rows.iter().filter(named).map(|row| row.seconds).sum()
}
