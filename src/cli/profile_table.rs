//! A profile as a table beside the paper's §7, and as comma-separated numbers.

use std::fmt::Write;

use gelray::measure::median::median;

use super::bytes::human;
use super::profile_saved::{Number, Profile, Stage};
use super::table::table;

/// The heading, a row a stage that made something, what they make up together, and the paper's numbers.
pub fn words(profile: &Profile) -> String {
    let Profile { scene, size: [width, height], threads, version, run, .. } = profile;
    let runs = run.seconds.len();
    let mut text = format!(
        "{scene}: {width} × {height} pixels, {threads} threads, gelray {version}; medians over whole runs ({runs})\n\n"
    );
    text.push_str(&table(&rows(profile), &[1, 3, 4, 5, 7]));
    if !profile.numbers.is_empty() {
        text.push('\n');
        let heading = ["", "ours", "in 19 of 20", "paper"].map(str::to_owned);
        let numbers = profile.numbers.iter().map(number);
        let rows: Vec<_> = std::iter::once(heading).chain(numbers).collect();
        text.push_str(&table(&rows, &[1]));
    }
    text
}

/// The table's rows, for text and for pages: name, seconds, least to most, share, processor seconds, each, counts, bytes, the paper's seconds.
pub fn rows(profile: &Profile) -> Vec<[String; 9]> {
    let heading = [
        "stage",
        "seconds",
        "least–most",
        "share",
        "processor",
        "each",
        "counts",
        "bytes",
        "the paper, on a Sun 4/280",
    ];
    let mut rows = vec![heading.map(str::to_owned)];
    rows.extend(profile.stages.iter().filter(|stage| stage.made > 0).map(row));
    let share = format!("{:.1} %", 100.0 * profile.accounted());
    let cells = ["all stages", "", "", &share, "", "", "", "", ""].map(str::to_owned);
    rows.push(cells);
    let peak = profile.peak_bytes.map_or_else(String::new, human);
    let [name, seconds, range, share, busy, each, counts, _, paper] = row(&profile.run);
    rows.push([name, seconds, range, share, busy, each, counts, peak, paper]);
    rows.push(row(&Stage { name: "cast and resample".to_owned(), ..profile.frame.clone() }));
    rows
}

fn row(stage: &Stage) -> [String; 9] {
    let counts = stage.counts.iter().map(|(what, count)| format!("{count} {what}"));
    let each = stage.median / stage.made.max(1) as f64;
    let paper = stage.paper_seconds.zip(stage.paper_what.as_deref());
    [
        stage.name.clone(),
        format!("{:.4}", stage.median),
        format!("{:.4}–{:.4}", stage.least, stage.most),
        format!("{:.1} %", 100.0 * stage.share),
        format!("{:.4}", median(&stage.busy)),
        if stage.made > 1 { format!("{each:.4}") } else { String::new() },
        counts.collect::<Vec<_>>().join(", "),
        if stage.bytes > 0 { human(stage.bytes) } else { String::new() },
        paper.map_or_else(String::new, |(seconds, what)| format!("{seconds} s {what}")),
    ]
}

/// A number of the paper: what it is of, ours, its bounds, the paper's.
pub fn number(number: &Number) -> [String; 4] {
    let told = |ours: f64| match ours {
        ours if ours >= 100.0 => format!("{ours:.0}"),
        ours if ours >= 10.0 => format!("{ours:.1}"),
        ours => format!("{ours:.2}"),
    };
    let [ours, within] = match number.ours {
        None => ["–".to_owned(), number.note.clone()],
        Some(ours) => {
            let ours = format!("{} {}", told(ours), number.note).trim_end().to_owned();
            let within = number.within.map(|[low, high]| format!("{}–{}", told(low), told(high)));
            [ours, within.unwrap_or_default()]
        }
    };
    [number.what.clone(), ours, within, number.paper.clone()]
}

/// A line a stage, one for casting and resampling together, one for the run, and one a number of the paper, by its key.
pub fn csv(profile: &Profile) -> String {
    let mut text =
        "stage,made,median_seconds,least_seconds,most_seconds,share,processor_seconds,bytes,counts,paper_seconds,number,number_low,number_high,paper_number\n"
            .to_owned();
    for stage in profile.stages.iter().chain([&profile.frame, &profile.run]) {
        let counts = stage.counts.iter().map(|(what, count)| format!("{count} {what}"));
        let busy = median(&stage.busy);
        let Stage { name, made, median, least, most, share, bytes, .. } = stage;
        let paper = stage.paper_seconds.map_or_else(String::new, |seconds| seconds.to_string());
        let _ = writeln!(
            text,
            "{name},{made},{median},{least},{most},{share},{},{bytes},\"{}\",{paper},,,,",
            busy,
            counts.collect::<Vec<_>>().join("; ")
        );
    }
    for Number { key, ours, within, paper, .. } in &profile.numbers {
        let told = |number: Option<f64>| number.map_or_else(String::new, |n| n.to_string());
        let [low, high] = [0, 1].map(|end| told(within.map(|within| within[end])));
        let _ = writeln!(text, "{key},,,,,,,,,,{},{low},{high},{paper}", told(*ours));
    }
    text
}
