//! Whoever looks on while the rays of a view are cast (progressive refinement, paper §6).

use std::time::Duration;

use crossbeam::channel::{Receiver, Sender, TrySendError, bounded};

use super::picture::Picture;
use crate::schedule::Pace;

/// A component of a view: pictures of it are handed out at equal intervals while it is rendered, each better than the last.
///
/// The first comes as soon as a sixty-fourth of the pixels has a ray. The rendering never waits: what is not taken before
/// the next is due is followed by the next after it. The final picture is that of
/// [`Renderer::render`](crate::renderer::Renderer::render), equal bit for bit whether somebody looks on or not.
///
/// ```
/// use std::time::Duration;
/// use gelray::prelude::*;
/// use gelray::view::viewer::Viewer;
///
/// let mut world = World::new();
/// let (grid, scalars) = volume(vec![1.0_f32; 8 * 8 * 8], [8; 3], [1.0; 3])?;
/// world.spawn((grid, scalars, Classify::iso(0.5)));
/// let (viewer, pictures) = Viewer::new(Duration::from_millis(100));
/// world.spawn((View::default(), viewer));
/// let looking = std::thread::spawn(move || pictures.iter().count());
/// let last = Renderer::new()?.render(&mut world)?.picture;
/// drop(world); // and with it the viewer: there is no more to come
/// assert!(looking.join().unwrap() >= 1);
/// # Ok::<(), Error>(())
/// ```
#[derive(Debug)]
pub struct Viewer {
    pace: Pace,
    pictures: Sender<Picture>,
}

impl Viewer {
    /// A viewer who wants a picture `every` so often, and where the pictures come out; one waits there at most.
    #[must_use]
    pub fn new(every: Duration) -> (Self, Receiver<Picture>) {
        let (pictures, taken) = bounded(1);
        (Self { pace: Pace::new(every), pictures }, taken)
    }

    /// Whether it is time for a picture, and the last was taken.
    #[must_use]
    pub(crate) fn is_due(&self) -> bool {
        self.pictures.is_empty() && self.pace.is_due()
    }

    /// Hands a picture out, if the last was taken.
    pub fn show(&self, picture: Picture) {
        if !matches!(self.pictures.try_send(picture), Err(TrySendError::Full(_))) {
            self.pace.happened();
        }
    }
}
