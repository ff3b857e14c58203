//! The cost table of the paper's §7: what each stage took, summed by a layer over the spans that the schedule opens.

use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use tracing::Subscriber;
use tracing::field::{Field, Visit};
use tracing::span::{Attributes, Id, Record};
use tracing_subscriber::Layer;
use tracing_subscriber::layer::Context;
use tracing_subscriber::registry::LookupSpan;

use super::busy::busy_seconds;
use super::cost::{FRAME, paper_costs};

/// What all spans of one name under one parent took.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Row {
    /// The span's name; of a `system` span the name of the system.
    pub name: String,
    /// Spans that it lies in.
    pub depth: usize,
    /// Spans that have ended.
    pub count: u64,
    /// How many products a system made in them; `None` for spans that are no system's.
    pub made: Option<u64>,
    /// Seconds from beginning to end, summed. Spans that are open side by side, on threads, count each in full.
    pub seconds: f64,
    /// Seconds that processors were busy with all threads of the program meanwhile; 0 where the system does not tell.
    pub busy: f64,
}

/// Sums the seconds and counts of spans by name, `system` spans by the name of their system. Clones share the sums.
#[derive(Debug, Clone, Default)]
pub struct CostTable(Arc<Mutex<Vec<Sum>>>);

#[derive(Debug)]
struct Sum {
    parent: Option<usize>,
    name: String,
    is_system: bool,
    count: u64,
    made: u64,
    open: Duration,
    busy: f64,
}

impl CostTable {
    /// The layer that fills the table, to be put over a registry.
    ///
    /// A table of every thread's spans needs the subscriber to be the program's, not a thread's.
    #[must_use]
    pub fn layer<S>(&self) -> impl Layer<S> + Send + Sync + use<S>
    where
        S: Subscriber + for<'a> LookupSpan<'a>,
    {
        Summing(self.clone())
    }

    /// The sums so far, each followed by those of the spans within it; siblings in the order that they first began.
    #[must_use]
    pub fn rows(&self) -> Vec<Row> {
        let mut rows = Vec::new();
        self.with(|sums| push_children(sums, None, 0, &mut rows));
        rows
    }

    fn with<R>(&self, act: impl FnOnce(&mut Vec<Sum>) -> R) -> R {
        // Every change leaves the sums sound, so those of a thread that panicked are as good as any.
        act(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// The place of the sum of spans of a name within a parent, created if it is the first.
    fn place(&self, parent: Option<usize>, name: String, is_system: bool) -> usize {
        self.with(|sums| {
            let known = sums.iter().position(|sum| sum.parent == parent && sum.name == name);
            known.unwrap_or_else(|| {
                let (count, made, open, busy) = (0, 0, Duration::ZERO, 0.0);
                sums.push(Sum { parent, name, is_system, count, made, open, busy });
                sums.len() - 1
            })
        })
    }
}

fn push_children(sums: &[Sum], parent: Option<usize>, depth: usize, rows: &mut Vec<Row>) {
    for (at, sum) in sums.iter().enumerate().filter(|(_, sum)| sum.parent == parent) {
        rows.push(Row {
            name: sum.name.clone(),
            depth,
            count: sum.count,
            made: sum.is_system.then_some(sum.made),
            seconds: sum.open.as_secs_f64(),
            busy: sum.busy,
        });
        push_children(sums, Some(at), depth + 1, rows);
    }
}

struct Summing(CostTable);

/// Processor time until now; the difference of two is 0 where the system does not tell.
fn busy() -> f64 {
    busy_seconds().unwrap_or(0.0)
}

/// What a span carries while it is open.
struct Open {
    begun: Instant,
    busy: f64,
    sum: usize,
    made: u64,
}

impl<S: Subscriber + for<'a> LookupSpan<'a>> Layer<S> for Summing {
    fn on_new_span(&self, attributes: &Attributes<'_>, id: &Id, context: Context<'_, S>) {
        let Some(span) = context.span(id) else { return };
        let parent = span.parent().and_then(|p| p.extensions().get::<Open>().map(|open| open.sum));
        let mut fields = Fields::default();
        attributes.record(&mut fields);
        let is_system = span.name() == "system";
        let name = fields.name.filter(|_| is_system).unwrap_or_else(|| span.name().to_owned());
        let sum = self.0.place(parent, name, is_system);
        span.extensions_mut().insert(Open { begun: Instant::now(), busy: busy(), sum, made: 0 });
    }

    fn on_record(&self, id: &Id, values: &Record<'_>, context: Context<'_, S>) {
        let Some(span) = context.span(id) else { return };
        let mut fields = Fields::default();
        values.record(&mut fields);
        if let Some(open) = span.extensions_mut().get_mut::<Open>() {
            open.made = fields.made.unwrap_or(open.made);
        }
    }

    fn on_close(&self, id: Id, context: Context<'_, S>) {
        let Some(span) = context.span(&id) else { return };
        let Some(Open { begun, busy: before, sum, made }) = span.extensions_mut().remove::<Open>()
        else {
            return;
        };
        // A thread that ended takes its time along. What asking takes is the span's own, so that no time is nobody's.
        let busy = (busy() - before).max(0.0);
        let elapsed = begun.elapsed();
        self.0.with(|sums| {
            let sum = &mut sums[sum];
            sum.count += 1;
            sum.made += made;
            sum.open += elapsed;
            sum.busy += busy;
        });
    }
}

/// The fields of a `system` span.
#[derive(Default)]
struct Fields {
    name: Option<String>,
    made: Option<u64>,
}

impl Visit for Fields {
    fn record_str(&mut self, field: &Field, value: &str) {
        if field.name() == "name" {
            self.name = Some(value.to_owned());
        }
    }

    fn record_u64(&mut self, field: &Field, value: u64) {
        if field.name() == "made" {
            self.made = Some(value);
        }
    }

    fn record_debug(&mut self, _: &Field, _: &dyn fmt::Debug) {}
}

impl fmt::Display for CostTable {
    /// One line a row, aligned: name, spans, products made, seconds, the paper's seconds; last, the frame.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rows = self.rows();
        let name = |row: &Row| format!("{:indent$}{}", "", row.name, indent = 2 * row.depth);
        let width = rows.iter().map(|row| name(row).chars().count()).max().unwrap_or(0).max(8);
        writeln!(
            f,
            "{:width$}  {:>6}  {:>5}  {:>10}  paper §7",
            "stage", "runs", "made", "seconds"
        )?;
        for row in &rows {
            let made = row.made.map_or_else(String::new, |made| made.to_string());
            let (name, paper) = (name(row), told(&row.name));
            let line = format!(
                "{name:width$}  {:>6}  {made:>5}  {:>10.4}  {paper}",
                row.count, row.seconds
            );
            writeln!(f, "{}", line.trim_end())?;
        }
        let is_frame = |row: &&Row| row.made.is_some() && FRAME.contains(&row.name.as_str());
        let frame: f64 = rows.iter().filter(is_frame).map(|row| row.seconds).sum();
        write!(f, "{:width$}  {:>6}  {:>5}  {frame:>10.4}  {}", "frame", "", "", told("frame"))
    }
}

/// The paper's seconds of a stage, in words; empty where it states none.
fn told(stage: &str) -> String {
    let told = paper_costs(stage).map(|cost| format!("{} s {}", cost.seconds, cost.what));
    told.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use std::thread::sleep;

    use tracing::{info_span, subscriber};
    use tracing_subscriber::layer::SubscriberExt;

    use super::*;

    fn system(name: &str, made: u64, within: impl FnOnce()) {
        let field = tracing::field::Empty;
        let span = info_span!("system", name = name, made = field, reused = field).entered();
        within();
        span.record("made", made);
    }

    /// Two frames: the second makes a picture of the gel that there is.
    fn table_of_two_frames() -> CostTable {
        let table = CostTable::default();
        let subscriber = tracing_subscriber::registry().with(table.layer());
        subscriber::with_default(subscriber, || {
            for made in [1, 0] {
                let _frame = info_span!("frame", number = made).entered();
                system("classify", made, || sleep(Duration::from_millis(2)));
                system("cast", 1, || {
                    for _ in 0..3 {
                        let _band = info_span!("band").entered();
                        sleep(Duration::from_millis(1));
                    }
                });
            }
        });
        table
    }

    #[test]
    fn spans_are_summed_by_name_within_their_parent_and_systems_by_their_own_name() {
        let rows = table_of_two_frames().rows();
        let told: Vec<_> =
            rows.iter().map(|r| (r.name.as_str(), r.depth, r.count, r.made)).collect();
        let expected = [
            ("frame", 0, 2, None),
            ("classify", 1, 2, Some(1)),
            ("cast", 1, 2, Some(2)),
            ("band", 2, 6, None),
        ];
        assert_eq!(told, expected);
    }

    #[test]
    fn on_one_thread_what_lies_within_a_span_takes_no_longer_than_the_span() {
        let rows = table_of_two_frames().rows();
        let [frame, classify, cast, band] = rows.as_slice() else { panic!("{rows:?}") };
        assert!(classify.seconds >= 0.004 && band.seconds >= 0.006, "{rows:?}");
        assert!(band.seconds <= cast.seconds, "{rows:?}");
        assert!(classify.seconds + cast.seconds <= frame.seconds, "{rows:?}");
    }

    #[test]
    fn the_table_stands_beside_the_seconds_of_the_paper() {
        let text = table_of_two_frames().to_string();
        let line = |start: &str| text.lines().find(|line| line.trim_start().starts_with(start));
        let column = line("stage").and_then(|line| line.find("paper"));
        assert!(column.is_some());
        assert_eq!(line("classify").and_then(|line| line.find("60 s classifying")), column);
        let last = text.lines().last().unwrap();
        assert_eq!(last.find("50 s volume alone, 70 s"), column, "{text}");
        assert!(last.starts_with("frame") && last.ends_with("80 s polygons traced"));
    }
}
