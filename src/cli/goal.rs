//! `--target`: what a picture is to keep, as accuracy or as time.

/// What the cheapest, or the most exact, settings are to keep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Goal {
    /// At least so many decibels.
    Psnr(f64),
    /// No channel off by more.
    Max(f64),
    /// At least so alike in structure.
    Ssim(f64),
    /// At most so many milliseconds a frame.
    Milliseconds(f64),
}

/// What `--target` looks like, for sentences.
const FORMS: &str = "psnr=45, max=0.01, ssim=0.99 or ms=20";

impl Goal {
    /// Reads `MEASURE=NUMBER`.
    pub fn parse(text: &str) -> Result<Self, String> {
        let wrong = || format!("a measure and a number are expected, such as {FORMS}");
        let (measure, number) = text.split_once('=').ok_or_else(wrong)?;
        let number: f64 =
            number.trim().parse().ok().filter(|n: &f64| n.is_finite()).ok_or_else(wrong)?;
        let positive = number > 0.0;
        match measure.trim() {
            "psnr" if positive => Ok(Self::Psnr(number)),
            "max" if positive => Ok(Self::Max(number)),
            "ssim" if positive && number <= 1.0 => Ok(Self::Ssim(number)),
            "ms" if positive => Ok(Self::Milliseconds(number)),
            "psnr" | "max" | "ms" => {
                Err(format!("{number} is not above 0; state for instance {FORMS}"))
            }
            "ssim" => {
                Err(format!("{number} is not above 0 and at most 1; state for instance {FORMS}"))
            }
            _ => Err(wrong()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_goal_is_a_measure_and_a_number() {
        assert_eq!(Goal::parse("psnr=45"), Ok(Goal::Psnr(45.0)));
        assert_eq!(Goal::parse("ms = 2.5"), Ok(Goal::Milliseconds(2.5)));
        for wrong in ["", "psnr", "psnr=", "psnr=-3", "ssim=1.5", "max=0", "speed=3", "ms=nan"] {
            assert!(Goal::parse(wrong).is_err(), "{wrong}");
        }
    }
}
