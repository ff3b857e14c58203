//! Which pictures a sequence has: how many, at which degrees, and the part of them that one machine makes.

/// The most pictures of a sequence.
const MOST: usize = 1_000_000;

/// The pictures of a sequence: degrees from `from` on, by `step`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrameRange {
    from: f64,
    to: f64,
    count: usize,
    /// Degrees between pictures; `None`: the whole way, divided by their number.
    step: Option<f64>,
}

impl FrameRange {
    /// A full turn in `count` pictures, each once: the next would be the first again.
    #[must_use]
    pub fn turn(count: usize) -> Self {
        Self { from: 0.0, to: 360.0, count, step: None }
    }

    /// A full turn as a number (`72`), or degrees as `FROM..TOxSTEP` (`0..90x5`).
    ///
    /// The last degree is a picture too, unless it shows what the first one shows: whole turns end before it. The error is
    /// a sentence without a subject.
    pub fn parse(text: &str) -> Result<Self, String> {
        const EXPECTED: &str = "is neither a number of frames for a full turn, such as 72, nor degrees FROM..TOxSTEP, such as 0..360x5";
        let refused = || EXPECTED.to_owned();
        let range = match text.split_once("..") {
            None => Self::turn(text.parse().map_err(|_| refused())?),
            Some((from, rest)) => {
                let (to, step) = rest.split_once(['x', '×']).ok_or_else(refused)?;
                let degrees = |text: &str| {
                    text.trim().parse().ok().filter(|degrees: &f64| degrees.abs() <= 1e6)
                };
                let numbers = degrees(from).zip(degrees(to)).zip(degrees(step));
                let ((from, to), step) = numbers.ok_or_else(refused)?;
                Self::by_step(from, to, step)?
            }
        };
        if (1..=MOST).contains(&range.count) {
            Ok(range)
        } else {
            Err(format!("makes {} frames; 1 to {MOST} are possible", range.count))
        }
    }

    fn by_step(from: f64, to: f64, step: f64) -> Result<Self, String> {
        if step <= 0.0 {
            return Err("has a step of 0 or below; state one above 0, as in 90..0x5".to_owned());
        }
        let whole = (to - from).abs();
        // The last picture may miss its degree by rounding.
        let steps = (whole / step + 1e-9).floor();
        let arrives = (steps * step - whole).abs() <= 1e-9 * whole.max(step);
        let closes = whole > 0.0 && whole % 360.0 == 0.0 && arrives;
        let count = steps as usize + usize::from(!closes);
        Ok(Self { from, to, count, step: Some(if to < from { -step } else { step }) })
    }

    /// How many pictures there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.count
    }

    /// The degrees of a picture, numbered from 0.
    #[must_use]
    pub fn degrees(&self, number: usize) -> f64 {
        let number = number as f64;
        match self.step {
            Some(step) => self.from + number * step,
            None => self.from + (self.to - self.from) * number / self.count as f64,
        }
    }

    /// Which part of the way a picture has behind it, 0..=1.
    #[must_use]
    pub fn part(&self, number: usize) -> f64 {
        if self.to == self.from {
            return 0.0;
        }
        ((self.degrees(number) - self.from) / (self.to - self.from)).clamp(0.0, 1.0)
    }
}

/// One of several machines that share the work: each makes every so-manieth picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    part: usize,
    of: usize,
}

impl Shard {
    /// All pictures.
    pub const WHOLE: Self = Self { part: 0, of: 1 };

    /// `2/8`: the second of eight; the error is a sentence without a subject.
    pub fn parse(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(part, of)| {
            Some((part.trim().parse::<usize>().ok()?, of.trim().parse::<usize>().ok()?))
        });
        match numbers {
            Some((part, of)) if part >= 1 && part <= of => Ok(Self { part: part - 1, of }),
            _ => Err("is no part of the work; the second of eight is 2/8, and they count from 1"
                .to_owned()),
        }
    }

    /// Whether a picture is among those of this machine.
    #[must_use]
    pub fn has(&self, number: usize) -> bool {
        number % self.of == self.part
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn degrees(text: &str) -> Vec<f64> {
        let range = FrameRange::parse(text).unwrap();
        (0..range.count()).map(|number| range.degrees(number)).collect()
    }

    #[test]
    fn a_turn_shows_each_degree_once_and_other_ranges_show_both_ends() {
        assert_eq!(degrees("4"), [0.0, 90.0, 180.0, 270.0]);
        assert_eq!(degrees("0..360x90"), degrees("4"));
        assert_eq!(degrees("0..90x45"), [0.0, 45.0, 90.0]);
        assert_eq!(degrees("10..-10x10"), [10.0, 0.0, -10.0]);
        assert_eq!(degrees("0..1x0.1").len(), 11);
        assert_eq!(degrees("0..10x4"), [0.0, 4.0, 8.0]);
        assert_eq!(degrees("5..5x1"), [5.0]);
        assert_eq!(degrees("0..360x7").len(), 52, "357 is not the first again");
    }

    #[test]
    fn parts_go_from_0_to_1_at_the_last_degree() {
        let part = |text, number| FrameRange::parse(text).unwrap().part(number);
        assert_eq!((part("0..90x45", 0), part("0..90x45", 2)), (0.0, 1.0));
        assert_eq!((part("90..0x45", 1), part("72", 36), part("5..5x1", 0)), (0.5, 0.5, 0.0));
    }

    #[test]
    fn what_is_no_range_is_refused_in_a_sentence() {
        for text in [
            "",
            "0",
            "-3",
            "x",
            "1.5",
            "0..360",
            "0..360x0",
            "0..360x-5",
            "0..x5",
            "nan..1x1",
            "0..1e6x1e-6",
            "0..1e999x1",
        ] {
            assert!(FrameRange::parse(text).is_err(), "{text}");
        }
        for text in ["", "0/2", "3/2", "1", "1/0", "a/b", "-1/2"] {
            assert!(Shard::parse(text).is_err(), "{text}");
        }
    }

    #[test]
    fn shards_are_disjoint_and_complete() {
        let shards = ["1/3", "2/3", "3/3"].map(|text| Shard::parse(text).unwrap());
        for number in 0..100 {
            assert_eq!(shards.iter().filter(|shard| shard.has(number)).count(), 1);
            assert!(Shard::WHOLE.has(number));
        }
    }
}
