//! Numbers of bytes, as people write and read them; K, M, G and T are powers of 1024.

const UNITS: [&str; 5] = ["B", "KiB", "MiB", "GiB", "TiB"];

/// Reads `8G`, `512M`, `1.5GiB` or plain bytes.
pub fn parse(text: &str) -> Result<u64, String> {
    let trimmed = text.trim();
    let end = trimmed.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(trimmed.len());
    let (number, unit) = trimmed.split_at(end);
    let unit = unit.trim().to_ascii_uppercase();
    let power = ["", "K", "M", "G", "T"].iter().position(|known| {
        unit.strip_prefix(known).is_some_and(|rest| matches!(rest, "" | "B" | "IB"))
    });
    let bytes = number
        .parse::<f64>()
        .ok()
        .zip(power)
        .map(|(number, power)| number * 1024_f64.powi(power as i32));
    match bytes {
        Some(bytes) if (1.0..1e18).contains(&bytes) => Ok(bytes as u64),
        _ => Err("a number of bytes above 0 is expected, such as 8G, 512M or 1500000".to_owned()),
    }
}

/// Three digits and a unit.
pub fn human(bytes: u64) -> String {
    let power = (1..UNITS.len()).rev().find(|&power| bytes >> (10 * power) > 0).unwrap_or(0);
    let number = bytes as f64 / 1024_f64.powi(power as i32);
    let digits = if power == 0 || number >= 100.0 {
        0
    } else if number >= 10.0 {
        1
    } else {
        2
    };
    format!("{number:.digits$} {}", UNITS[power])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_powers_of_1024() {
        for (text, bytes) in
            [("1", 1), ("2K", 2048), ("1.5g", 3 << 29), ("8GiB", 8 << 30), ("3 MB", 3 << 20)]
        {
            assert_eq!(parse(text), Ok(bytes), "{text}");
        }
    }

    #[test]
    fn what_is_no_number_of_bytes_is_refused() {
        for text in ["", "G", "0", "-1", "8X", "8GG", "1e9", "1..2", "999999999T", "8 iB K"] {
            assert!(parse(text).is_err(), "{text}");
        }
    }

    #[test]
    fn three_digits_are_enough_to_read() {
        let read = [0, 1023, 1024, 14_811_136, 41 << 30].map(human);
        assert_eq!(read, ["0 B", "1023 B", "1.00 KiB", "14.1 MiB", "41.0 GiB"]);
    }
}
