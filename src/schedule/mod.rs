//! The schedule: an order derived from who makes what, waves, thrift, spans. The only place that times anything.
//!
//! A system makes exactly one product from what a scene states and what other systems made. One maker a product gives
//! the order; comparing inputs gives the thrift: what is not asked for is taken off, what was made from the same
//! inputs is kept, and only the rest is made.

mod outbox;
mod pace;
mod product;
mod watch;

use std::time::Instant;

use hecs::{CommandBuffer, Entity, World};

use crate::error::Error;
pub use outbox::Outbox;
pub use pace::Pace;
pub use product::{Made, Product, ProductKey, Restore};
pub use watch::Watch;

/// A stage of the paper's figures 1, 4 and 5.
pub trait System {
    /// All that it can put in its outbox: writes are checked by the compiler.
    type Product: Product;
    /// The name of its span and its line in the cost table.
    const NAME: &'static str;
    /// The products that it reads; what a scene states needs no mention. A test hides every other one from it.
    const READS: &'static [ProductKey];

    /// Calls [`Outbox::derive`] once for every entity that is to carry the product.
    fn run(world: &World, out: &mut Outbox<'_, Self::Product>) -> Result<(), Error>;

    /// What `run` would make, from stated components alone, before anything is allocated.
    fn plan(world: &World) -> Plan;
}

/// What a system would make of a world, and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Plan {
    /// The entities that would carry the product, each with the most bytes that it can take.
    pub makes: Vec<(Entity, u64)>,
    /// The bytes that all of it is expected to take, where that is less than the most.
    pub expected: Option<u64>,
    /// Why, in words for a user: the component that asks for it, or the one that is absent.
    pub why: &'static str,
}

impl Plan {
    /// Nothing is made, because …
    #[must_use]
    pub fn absent(why: &'static str) -> Self {
        Self::of_most(Vec::new(), why)
    }

    /// Each entity with the most bytes, which are also those that are expected.
    #[must_use]
    pub fn of_most(makes: Vec<(Entity, u64)>, why: &'static str) -> Self {
        Self { makes, expected: None, why }
    }

    /// Of something that was found out about each entity: the most bytes, and the part of them that is expected, 0..=1.
    #[must_use]
    pub fn of<T>(
        found: &[(Entity, T)],
        most: impl Fn(&T) -> u64,
        part: impl Fn(&T) -> f64,
        why: &'static str,
    ) -> Self {
        let makes: Vec<_> = found.iter().map(|(entity, found)| (*entity, most(found))).collect();
        let parts =
            makes.iter().zip(found).map(|((_, most), (_, found))| *most as f64 * part(found));
        Self { expected: Some(parts.sum::<f64>() as u64), makes, why }
    }

    /// The bytes that all of it is expected to take.
    #[must_use]
    pub fn expected(&self) -> u64 {
        self.expected.unwrap_or_else(|| self.bytes())
    }

    /// The most bytes that all of it can take.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.makes.iter().fold(0, |sum, (_, bytes)| sum.saturating_add(*bytes))
    }
}

/// Runs a system; how many products it made and how many it kept.
type Run = fn(&World, &Watch, &mut CommandBuffer) -> Result<(u32, u32), Error>;

/// A system without its type: a line in the table of jobs.
#[derive(Clone, Copy)]
pub struct Job {
    /// The system's name.
    pub name: &'static str,
    /// What it makes.
    pub makes: ProductKey,
    /// The products that it reads.
    pub reads: &'static [ProductKey],
    /// What it would make of a world.
    pub plan: fn(&World) -> Plan,
    run: Run,
}

impl Job {
    /// The job of a system.
    #[must_use]
    pub const fn of<S: System>() -> Self {
        Self {
            name: S::NAME,
            makes: ProductKey::of::<S::Product>(),
            reads: S::READS,
            plan: S::plan,
            run: |world, watch, commands| {
                let mut out = Outbox::<S::Product>::new(world, watch, commands);
                S::run(world, &mut out)?;
                Ok(out.finish())
            },
        }
    }
}

/// What one system did in a run, and how long it took.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Ran {
    /// The system.
    pub name: &'static str,
    /// Products made.
    pub made: u32,
    /// Products kept, because their inputs were the same.
    pub reused: u32,
    /// Seconds it took.
    pub seconds: f64,
}

/// Jobs in the order that their products need.
#[derive(Clone)]
pub struct Schedule {
    waves: Vec<Vec<Job>>,
}

impl Schedule {
    /// Derives the order of some jobs: each after the makers of what it reads.
    ///
    /// Two makers of one product, or a cycle, is an error: the only ones that there are.
    pub fn new(jobs: &[Job]) -> Result<Self, Error> {
        for (at, job) in jobs.iter().enumerate() {
            if let Some(other) = jobs[..at].iter().find(|other| other.makes == job.makes) {
                let problem = format!("{} and {} both make {:?}", other.name, job.name, job.makes);
                return Err(Error::Schedule(problem));
            }
        }
        let (mut waves, mut left) = (Vec::new(), jobs.to_vec());
        while !left.is_empty() {
            let waits = |job: &Job| left.iter().any(|other| job.reads.contains(&other.makes));
            let (later, wave): (Vec<Job>, Vec<Job>) = left.iter().partition(|job| waits(job));
            if wave.is_empty() {
                let names: Vec<_> = later.iter().map(|job| job.name).collect();
                return Err(Error::Schedule(format!("{} wait for each other", names.join(", "))));
            }
            waves.push(wave);
            left = later;
        }
        Ok(Self { waves })
    }

    /// The jobs, wave by wave.
    #[must_use]
    pub fn waves(&self) -> &[Vec<Job>] {
        &self.waves
    }

    /// Runs every system once, one by one; what a wave made is in the world when the next begins.
    ///
    /// After an error or an interruption the world holds the products of the waves before.
    pub fn run(&self, world: &mut World, watch: &Watch) -> Result<Vec<Ran>, Error> {
        let mut report = Vec::new();
        for wave in &self.waves {
            let mut commands = CommandBuffer::new();
            for job in wave {
                watch.check()?;
                report.push(run_timed(job, world, watch, &mut commands)?);
            }
            commands.run_on(world);
        }
        Ok(report)
    }
}

fn run_timed(
    job: &Job,
    world: &World,
    watch: &Watch,
    commands: &mut CommandBuffer,
) -> Result<Ran, Error> {
    let field = tracing::field::Empty;
    let span = tracing::info_span!("system", name = job.name, made = field, reused = field);
    let _inside = span.enter();
    watch.begin(job.name);
    let start = Instant::now();
    let (made, reused) = (job.run)(world, watch, commands)?;
    let seconds = start.elapsed().as_secs_f64();
    span.record("made", made).record("reused", reused);
    Ok(Ran { name: job.name, made, reused, seconds })
}

#[cfg(test)]
mod tests;
