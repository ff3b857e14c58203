//! The parts of a report, each measured once and kept in its folder, so that what is done stays done.

use std::path::PathBuf;

use gelray::formats::pictures::{ray_map_beside, write_picture};
use gelray::measure::error::compare;
use gelray::scene::Source;
use gelray::view::picture::Picture;
use gelray::view::samples::POSITIONS;
use gelray::{Error, Rendered};
use serde::{Deserialize, Serialize};

use super::failure::Failure;
use super::flags::Flags;
use super::interrupt::Interrupt;
use super::noted::VERSION;
use super::outputs::write_json;
use super::profile_numbers::add_numbers;
use super::profile_run::{Subject, profile};
use super::profile_saved::Profile;
use super::report_figures::claim;
use super::steps::Steps;

/// The folder of parts, and how they are measured.
pub struct Parts<'a> {
    /// Where they are kept.
    pub folder: PathBuf,
    /// What is known already is taken as it is.
    pub resume: bool,
    /// Whole runs of a figure.
    pub repeat: usize,
    /// Pairs of frames of each of the paper's ratios.
    pub pairs: usize,
    /// Flags of the command line.
    pub flags: &'a Flags,
    /// What stops the work.
    pub interrupt: &'a Interrupt,
    /// How far the work is.
    pub steps: &'a Steps,
}

/// A figure: what it took, and its picture as a PNG.
pub struct Figure {
    /// What it took.
    pub profile: Profile,
    /// The PNG.
    pub png: Vec<u8>,
}

/// How far the settings of a scene are from `--exact`.
#[derive(Debug, Serialize, Deserialize)]
pub struct Exact {
    /// The scene after its overrides, as stated.
    settings: String,
    version: String,
    /// Decibels; absent where nothing differs.
    pub psnr_db: Option<f64>,
    /// The greatest difference of a channel.
    pub max: f64,
    /// Seconds of casting and resampling at `--exact`.
    pub seconds: f64,
}

impl Parts<'_> {
    /// A figure by the name of its scene; `keys` are the paper's numbers that are asked of it.
    pub fn figure(&self, name: &str, keys: &[&str]) -> Result<Figure, Failure> {
        self.steps.begin(name);
        let subject = self.subject(name, self.flags)?;
        if let Some(known) = self.known(name, &subject)? {
            self.steps.done();
            return Ok(known);
        }
        self.steps.expect(keys.len());
        let (first, made) = subject.run_and_look()?;
        let mut runs = vec![first];
        for _ in 1..self.repeat {
            runs.push(subject.run()?);
        }
        let mut profile = profile(&runs).ok_or(Error::Interrupted)?;
        add_numbers(&subject, &mut profile, (keys, self.pairs), self.steps)?;
        let png = self.keep(name, &made, &profile)?;
        self.steps.done();
        Ok(Figure { profile, png })
    }

    /// The picture of a figure's scene at `--exact`, and how far that of the scene's settings is from it.
    pub fn exact(&self, name: &str, stated: &Profile) -> Result<(Exact, Vec<u8>), Failure> {
        self.steps.begin("every ray");
        if let Some((exact, png)) = self
            .read::<Exact>("exact")
            .filter(|(exact, _)| exact.settings == stated.settings && exact.version == VERSION)
        {
            self.steps.done();
            return Ok((exact, png));
        }
        let flags = Flags { exact: true, ..self.flags.clone() };
        let (run, made) = self.subject(name, &flags)?.run_and_look()?;
        let (_, own) = self.subject(name, self.flags)?.run_and_look()?;
        let difference = off(&own.picture, &made.picture)?;
        let seconds = profile(&[run]).map_or(0.0, |profile| profile.frame.median);
        let (settings, version) = (stated.settings.clone(), VERSION.to_owned());
        let exact = Exact { settings, version, psnr_db: difference.0, max: difference.1, seconds };
        let png = self.keep("exact", &made, &exact)?;
        self.steps.done();
        Ok((exact, png))
    }

    fn subject(&self, name: &str, flags: &Flags) -> Result<Subject, Failure> {
        Subject::new(Source::embedded(name)?, flags, &[], &self.interrupt.watch)
    }

    /// A figure that was measured before of the same settings, by the same version on as many threads.
    fn known(&self, name: &str, subject: &Subject) -> Result<Option<Figure>, Failure> {
        let Some((profile, png)) = self.read::<Profile>(name) else { return Ok(None) };
        let same = profile.settings == subject.load()?.resolved
            && profile.version == VERSION
            && profile.threads == rayon::current_num_threads()
            && profile.run.seconds.len() == self.repeat;
        Ok(same.then_some(Figure { profile, png }))
    }

    /// A part that was kept, if it is to be used and is whole.
    fn read<P: for<'de> Deserialize<'de>>(&self, name: &str) -> Option<(P, Vec<u8>)> {
        Some((self.kept(name)?, std::fs::read(self.folder.join(format!("{name}.png"))).ok()?))
    }

    /// What was kept of a part beside pictures, if it is to be used and is whole.
    pub fn kept<P: for<'de> Deserialize<'de>>(&self, name: &str) -> Option<P> {
        let path = self.folder.join(format!("{name}.json"));
        let text = std::fs::read_to_string(path).ok().filter(|_| self.resume)?;
        serde_json::from_str(&text).ok()
    }

    /// Keeps a picture, or where its rays were cast, and then what was measured of it; the PNG.
    fn keep(&self, name: &str, made: &Rendered, part: &impl Serialize) -> Result<Vec<u8>, Failure> {
        let path = |end: &str| self.folder.join(format!("{name}.{end}"));
        let png = path("png");
        if claim(name).is_some_and(|claim| claim.shows_rays) {
            let size = made.samples.layout.size.map(|n| n * POSITIONS);
            ray_map_beside(&png, size, &made.samples.ray_map())?.appear()?;
        } else {
            write_picture(&png, &made.picture, &[])?;
        }
        write_json(&path("json"), part)?;
        std::fs::read(&png).map_err(|error| {
            let problem = format!(
                "cannot be read again ({error}); leave the folder alone until the report is written"
            );
            Error::file(&png, problem).into()
        })
    }
}

/// Decibels, absent where nothing differs, and the greatest difference.
fn off(a: &Picture, b: &Picture) -> Result<(Option<f64>, f64), Failure> {
    let found = compare(a, b)
        .map_err(|problem| Failure::Said(format!("the picture and its reference: {problem}")))?;
    let rmse = found.linear.rmse;
    Ok(((rmse > 0.0).then(|| -20.0 * rmse.log10()), found.linear.max))
}
