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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::stopwatch::Stopwatch;

    #[test]
    fn a_span_that_nobody_sums_costs_next_to_nothing() {
        let count = 1_000_000;
        let watch = Stopwatch::start();
        for number in 0..count {
            let _inside = tracing::trace_span!("band", number).entered();
        }
        let each = watch.elapsed().as_secs_f64() / f64::from(count);
        println!("{:.1} ns a span", each * 1e9);
        // A frame opens some hundred spans and takes ten milliseconds: 1 % would be a thousand nanoseconds for each.
        assert!(each < 500e-9, "{each}");
    }

    #[test]
    fn spans_of_systems_are_summed_by_their_names() {
        let (done, rows) = spanned(|| {
            let field = tracing::field::Empty;
            let span = tracing::info_span!("system", name = "cast", made = field, reused = field);
            let _inside = span.enter();
            span.record("made", 1_u64);
            7
        });
        assert_eq!((done, rows.len(), rows[0].name.as_str()), (7, 1, "cast"));
        assert!(seconds_of(&rows, &["cast"]) > 0.0 && seconds_of(&rows, &["relight"]) == 0.0);
    }
}
