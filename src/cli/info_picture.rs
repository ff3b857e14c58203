//! `gelray info` of a picture: its size, its range in linear light, how much of it is transparent.

use std::path::Path;

use gelray::formats::pictures::{format_of, weighed};
use gelray::formats::read_picture;
use gelray::view::picture::Picture;

use super::failure::Failure;
use super::flags::Flags;
use super::memory;
use super::number::number;
use super::table::table;

/// What a picture holds, a fact a line.
pub fn words(path: &Path, flags: &Flags) -> Result<String, Failure> {
    memory::check(weighed(path)?.most(), flags.max_memory)?;
    let picture = read_picture(path)?;
    let [width, height] = picture.size;
    let name = format_of(path).map_or("picture", |format| format.name);
    let mut rows = vec![
        ["file".to_owned(), path.display().to_string()],
        ["pixels".to_owned(), format!("{width} × {height}, {name}")],
    ];
    let channels = ["red", "green", "blue", "alpha"].into_iter().enumerate();
    rows.extend(channels.map(|(channel, name)| [name.to_owned(), range(&picture, channel)]));
    let share = |of: &dyn Fn(f32) -> bool| {
        let count = picture.pixels.iter().filter(|pixel| of(pixel[3])).count();
        100.0 * count as f64 / picture.pixels.len() as f64
    };
    let (nothing, opaque) = (share(&|alpha| alpha == 0.0), share(&|alpha| alpha >= 1.0));
    rows.push([
        "empty".to_owned(),
        format!("{nothing:.1} % of the pixels; {opaque:.1} % are opaque"),
    ]);
    Ok(table(&rows, &[]))
}

/// Least, greatest and mean value of a channel, and how many are not finite.
fn range(picture: &Picture, channel: usize) -> String {
    let finite =
        || picture.pixels.iter().map(|pixel| pixel[channel]).filter(|value| value.is_finite());
    let (low, high) = finite()
        .fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    let count = finite().count();
    let wrong = picture.pixels.len() - count;
    if count == 0 {
        return format!("{wrong} infinite or not numbers");
    }
    let mean = finite().map(f64::from).sum::<f64>() / count as f64;
    let [low, high, mean] = [f64::from(low), f64::from(high), mean].map(number);
    let rest = if wrong > 0 { format!(", {wrong} infinite or not numbers") } else { String::new() };
    format!("{low} to {high}, mean {mean} (linear, associated){rest}")
}
