//! Tables of the colors of labels: 3D Slicer's `.ctbl` and the label descriptions of ITK-SNAP.
//!
//! Both are lines of text, a label each, with comments after `#`. Slicer: number, name, red, green, blue, alpha, all of
//! 0–255. ITK-SNAP: number, red, green, blue of 0–255, alpha of 0–1, two flags and a name in quotes.

use std::path::Path;

use crate::components::Color;
use crate::error::Error;

/// The most bytes of a table: a million labels take less.
const MOST_BYTES: u64 = 64 << 20;

/// A label of a table: its number, color and opacity (0..=1).
pub type Row = (u32, Color, f32);

/// Reads a table of colors; the error names the line that is no row of either kind.
pub(crate) fn read_label_table(path: &Path) -> Result<Vec<Row>, Error> {
    let unread = |error: std::io::Error| Error::file(path, format!("cannot be read ({error})"));
    let bytes = std::fs::metadata(path).map_err(unread)?.len();
    if bytes > MOST_BYTES {
        let problem = format!("has {bytes} bytes, and tables of colors are shorter; name another");
        return Err(Error::file(path, problem));
    }
    let bytes = std::fs::read(path).map_err(unread)?;
    rows(&String::from_utf8_lossy(&bytes)).map_err(|problem| Error::file(path, problem))
}

fn rows(text: &str) -> Result<Vec<Row>, String> {
    let mut rows = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let line = line.split('#').next().unwrap_or("").trim();
        if line.is_empty() {
            continue;
        }
        let row = row(line).ok_or_else(|| {
            format!(
                "line {} is no row of a color table; expected `number name red green blue alpha` (3D Slicer) or `number red green blue alpha …` (ITK-SNAP)",
                number + 1
            )
        })?;
        rows.push(row);
    }
    if rows.is_empty() {
        return Err("has no row of a color table; name a .ctbl or a label description".to_owned());
    }
    Ok(rows)
}

fn row(line: &str) -> Option<Row> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let label = words.first()?.parse().ok()?;
    let number = |word: &str| word.parse::<f32>().ok().filter(|n| n.is_finite());
    // A name may be a number, but only Slicer's rows have exactly six words.
    let (channels, most) = if words.len() != 6 && words.get(1).copied().and_then(number).is_some() {
        (words.get(1..5)?, 1.0)
    } else {
        (words.get(words.len().checked_sub(4)?.max(2)..)?, 255.0)
    };
    let values: Vec<f32> = channels.iter().copied().map(number).collect::<Option<_>>()?;
    let [r, g, b, alpha] = values[..] else { return None };
    let color = Color::from_srgb([r, g, b].map(|channel| (channel / 255.0).clamp(0.0, 1.0)));
    Some((label, color, (alpha / most).clamp(0.0, 1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const SLICER: &str = "# Color\n0 background 0 0 0 0\n1 bone 241 214 145 255\n2 3 10 20 30 51\n";
    const SNAP: &str = "# ITK-SnAP\n    0     0    0    0        0  0  0    \"Clear Label\"\n    1   255    0    0      0.5  1  1    \"bone # 1\"\n";

    #[test]
    fn tables_of_slicer_and_of_itk_snap_give_colors_and_opacities() {
        let slicer = rows(SLICER).unwrap();
        assert_eq!((slicer.len(), slicer[0].2, slicer[2].0, slicer[2].2), (3, 0.0, 2, 0.2));
        assert_eq!(slicer[1].1, Color::from_number(0xf1_d691));
        let snap = rows(SNAP).unwrap();
        assert_eq!(snap[1], (1, Color::from_number(0xff_0000), 0.5));
        assert_eq!(snap[0].2, 0.0);
    }

    #[test]
    fn what_is_no_row_is_named_by_its_line() {
        assert!(rows("1 bone 1 2 3 255\nbone\n").unwrap_err().contains("line 2"));
        assert!(rows("1 bone 1 nan 3 255\n").is_err() && rows("-1 a 1 2 3 4").is_err());
        assert!(rows("# nothing\n").unwrap_err().contains("no row"));
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn no_prefix_and_no_change_of_a_table_panics(
            cut in any::<prop::sample::Index>(),
            at in any::<prop::sample::Index>(),
            letter in any::<char>(),
            snap in any::<bool>(),
        ) {
            let mut text: Vec<char> = if snap { SNAP } else { SLICER }.chars().collect();
            let place = at.index(text.len());
            text[place] = letter;
            text.truncate(cut.index(text.len()) + 1);
            for (_, color, opacity) in rows(&text.into_iter().collect::<String>()).unwrap_or_default() {
                prop_assert!(color.0.is_finite() && (0.0..=1.0).contains(&opacity));
            }
        }
    }
}
