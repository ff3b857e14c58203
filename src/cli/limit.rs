//! `--fail-below`: how alike two images must be for a script to go on.

use gelray::measure::error::Errors;

use super::failure::Failure;

/// A measure of likeness and the least of it that is enough, in linear light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Limit {
    /// Decibels.
    Psnr(f64),
    /// At most 1.
    Ssim(f64),
}

impl Limit {
    /// Reads `psnr=40` or `ssim=0.99`.
    pub fn parse(text: &str) -> Result<Self, String> {
        let number = |text: &str| text.trim().parse::<f64>().ok().filter(|n| n.is_finite());
        let parts = text.split_once('=').and_then(|(name, n)| Some((name.trim(), number(n)?)));
        match parts {
            Some(("psnr", least)) => Ok(Self::Psnr(least)),
            Some(("ssim", least)) if least <= 1.0 => Ok(Self::Ssim(least)),
            _ => {
                Err("psnr=DECIBELS or ssim=NUMBER of at most 1 is expected, such as psnr=40"
                    .to_owned())
            }
        }
    }

    /// A failure that says what was found, if it is less.
    pub fn check(self, found: &Errors) -> Result<(), Failure> {
        let (name, found, least, unit) = match self {
            Self::Psnr(least) => ("psnr", found.psnr_db, least, " dB"),
            Self::Ssim(least) => ("ssim", found.ssim, least, ""),
        };
        if found >= least {
            return Ok(());
        }
        Err(Failure::Said(format!(
            "the images' {name} in linear light is {found:.4}{unit}, below the {least}{unit} of --fail-below"
        )))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_is_a_measure_and_a_number() {
        assert_eq!(Limit::parse("psnr=40"), Ok(Limit::Psnr(40.0)));
        assert_eq!(Limit::parse(" ssim = .99"), Ok(Limit::Ssim(0.99)));
        for text in ["", "psnr", "psnr=", "psnr=inf", "ssim=2", "max=1", "psnr=NaN"] {
            assert!(Limit::parse(text).is_err(), "{text}");
        }
    }
}
