//! The front door: a world of entities goes in, a picture comes out, and what did not change is kept for the next.

use std::sync::Arc;

use hecs::{Entity, World};

use crate::error::Error;
use crate::measure::judged::Judged;
use crate::resolve::resolve;
use crate::scene::check_world;
use crate::schedule::{Ran, Schedule, Watch};
use crate::systems::JOBS;
use crate::view::observer::first_view;
use crate::view::picture::{Frame, Picture};
use crate::view::samples::{SampleArray, Samples};

/// Renders worlds: owns the schedule of all systems, and the watch that tells its progress and stops it.
///
/// What a world's systems made stays in it. So render one world again and again, with its components changed in between:
/// a turn of the view casts rays and does nothing else, a colour is shaded and classifies nothing. The pictures are those
/// of a new world, bit for bit.
pub struct Renderer {
    schedule: Schedule,
    watch: Arc<Watch>,
}

/// A picture, and what it took.
#[derive(Debug, Clone)]
pub struct Rendered {
    /// What the view sees: linear associated RGBA. Shared by pointer, so that a copy costs nothing.
    pub picture: Picture,
    /// The rays that the picture was made of: where they were cast, their colours and their counts.
    pub samples: Arc<SampleArray>,
    /// What the picture is off by, where the view states [`Estimate`](crate::components::Estimate).
    pub judged: Option<Judged>,
    /// The entity that carries the view.
    pub view: Entity,
    /// What was guessed because the world does not state it, or is stated without effect: a sentence each.
    pub notices: Vec<String>,
    /// Every system in the order in which they ran: how many products it made, how many it kept, and its seconds.
    pub ran: Vec<Ran>,
}

impl Renderer {
    /// A renderer with a watch of its own. The error is a defect of gelray: systems that wait for each other.
    pub fn new() -> Result<Self, Error> {
        Self::watched(Arc::default())
    }

    /// A renderer that tells its progress to `watch` and asks it whether to stop; renderers may share one.
    pub fn watched(watch: Arc<Watch>) -> Result<Self, Error> {
        Ok(Self { schedule: Schedule::new(JOBS)?, watch })
    }

    /// What another thread looks at for the progress, and stops the work by.
    #[must_use]
    pub fn watch(&self) -> &Arc<Watch> {
        &self.watch
    }

    /// The systems, in the order that they run in.
    #[must_use]
    pub fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    /// The picture of a world's first view.
    ///
    /// What the world states is held to what scene files are held to, and what it leaves out is filled in ([`resolve`]):
    /// components are put on its entities, and a head light and an observer are spawned where there is none. The error is
    /// the first thing that cannot be rendered, or that the [`watch`](Self::watch) was told to stop. Interrupted or failed, the world keeps what was made until then, and can be rendered again.
    pub fn render(&self, world: &mut World) -> Result<Rendered, Error> {
        let notices = Self::resolved(world)?;
        let ran = self.schedule.run(world, &self.watch)?;
        self.watch.check()?;
        let missing = || Error::Schedule("no system made a picture of the view".to_owned());
        let view = first_view(world).ok_or_else(missing)?;
        let mut made = world.query_one::<(&Frame, &Samples, Option<&Judged>)>(view);
        let (frame, samples, judged) = made.get().map_err(|_| missing())?;
        Ok(Rendered {
            picture: frame.0.clone(),
            samples: Arc::clone(&samples.0),
            judged: judged.cloned(),
            view,
            notices,
            ran,
        })
    }

    /// Checks a world and fills in what it leaves out; the notices.
    fn resolved(world: &mut World) -> Result<Vec<String>, Error> {
        let _span = tracing::info_span!("resolve").entered();
        check_world(world)?;
        let notices = resolve(world).map_err(|fault| fault.within(world))?;
        Ok(notices.iter().map(|notice| notice.within(world)).collect())
    }
}
