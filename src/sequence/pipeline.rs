//! Encoding beside rendering: pictures go through a bounded channel to a thread that writes them.
//!
//! Memory stays flat however long the sequence, for a slow encoder makes rendering wait. Both ends may give up: the
//! encoder is told, so that it leaves nothing half-written, or rendering stops at its next picture.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread::Builder;
use std::time::Duration;

use crossbeam::channel::{Receiver, Sender, bounded};

use crate::error::Error;
use crate::measure::stopwatch::Stopwatch;
use crate::view::picture::Picture;

/// Pictures that may wait to be encoded: one is written, one waits, one is rendered.
const WAITING: usize = 1;

/// A picture on its way to a file.
#[derive(Debug, Clone)]
pub struct Shot {
    /// Its place in the sequence, from 0.
    pub number: usize,
    /// What the view sees.
    pub picture: Picture,
    /// What the picture says of itself.
    pub notes: Vec<(String, String)>,
}

/// The end of the channel that pictures are put in.
pub struct Feed {
    sender: Sender<Result<Shot, Error>>,
    waited: Duration,
}

/// The encoder reads no more; why is its own to say.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Unread;

/// The end of the channel that pictures come out of, in the order in which they were put in.
pub struct Shots<'a> {
    receiver: Receiver<Result<Shot, Error>>,
    taken: usize,
    /// Pictures that were done with: all that were taken before the last, until [`Shots::end`].
    done: &'a AtomicUsize,
    idle: Duration,
}

/// How long the encoder took, and what rendering lost to it.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize)]
pub struct Times {
    /// Seconds in which the encoder was at work.
    pub encoding: f64,
    /// Seconds in which rendering waited for the encoder to take a picture.
    pub waited: f64,
}

/// A sequence that came to its end too early.
#[derive(Debug)]
pub struct Stopped {
    /// Why.
    pub error: Error,
    /// Pictures that were encoded until then.
    pub done: usize,
}

impl Feed {
    /// Hands a picture to the encoder, after waiting for it where it is behind.
    pub fn send(&mut self, shot: Shot) -> Result<(), Unread> {
        let start = Stopwatch::start();
        let sent = self.sender.send(Ok(shot)).map_err(|_| Unread);
        self.waited += start.elapsed();
        sent
    }
}

impl Iterator for Shots<'_> {
    type Item = Result<Shot, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        self.done.store(self.taken, Ordering::Relaxed);
        let start = Stopwatch::start();
        let shot = self.receiver.recv().ok();
        self.idle += start.elapsed();
        self.taken += usize::from(matches!(shot, Some(Ok(_))));
        shot
    }
}

/// Runs `render` here and `encode` on a thread of its own, until both are done.
///
/// `render` hands on [`Unread`] when the encoder has given up. Where it fails itself, its error comes out of the encoder's
/// end of the channel, so that nothing half-written stays. The encoder computes on its own thread alone and takes none of
/// those that cast rays.
pub fn run(
    render: impl FnOnce(&mut Feed) -> Result<(), RenderFault>,
    encode: impl FnOnce(&mut Shots) -> Result<(), Error> + Send,
) -> Result<Times, Stopped> {
    let (sender, receiver) = bounded(WAITING);
    let done = AtomicUsize::new(0);
    let mut feed = Feed { sender, waited: Duration::ZERO };
    let mut shots = Shots { receiver, taken: 0, done: &done, idle: Duration::ZERO };
    let thread = move || {
        let start = Stopwatch::start();
        let encoded = alone(|| encode(&mut shots));
        if encoded.is_ok() {
            shots.done.store(shots.taken, Ordering::Relaxed);
        }
        (encoded, start.elapsed().saturating_sub(shots.idle))
    };
    let (rendered, encoded, waited) = std::thread::scope(|scope| {
        let encoder = Builder::new().name("encoder".to_owned()).spawn_scoped(scope, thread)?;
        let rendered = render(&mut feed);
        if let Err(RenderFault::Failed(_)) = &rendered {
            let _ = feed.sender.send(Err(Error::Interrupted));
        }
        let Feed { sender, waited } = feed;
        drop(sender);
        Ok((rendered, encoder.join(), waited))
    })
    .map_err(|problem| Stopped { error: unmade(&problem), done: 0 })?;
    let stopped = |error| Stopped { error, done: done.load(Ordering::Relaxed) };
    let Ok((encoded, busy)) = encoded else {
        return Err(stopped(Error::Schedule("the encoder broke off".to_owned())));
    };
    if let Err(RenderFault::Failed(error)) = rendered {
        return Err(stopped(error));
    }
    encoded.map_err(stopped)?;
    Ok(Times { encoding: busy.as_secs_f64(), waited: waited.as_secs_f64() })
}

fn unmade(problem: &std::io::Error) -> Error {
    Error::System(format!(
        "a thread that encodes pictures cannot be made ({problem}); raise the limits of the system (`ulimit -u`, `ulimit -v`)"
    ))
}

/// Why rendering came to its end too early.
#[derive(Debug)]
pub enum RenderFault {
    /// The encoder gave up.
    Unread,
    /// A picture could not be rendered.
    Failed(Error),
}

impl From<Unread> for RenderFault {
    fn from(_: Unread) -> Self {
        Self::Unread
    }
}

impl From<Error> for RenderFault {
    fn from(error: Error) -> Self {
        Self::Failed(error)
    }
}

/// Runs something whose parallel parts are to take one thread, its own; where none is to be had, those of all.
fn alone<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    match rayon::ThreadPoolBuilder::new().num_threads(1).build() {
        Ok(pool) => pool.install(work),
        Err(_) => work(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shot(number: usize) -> Shot {
        let picture = Picture::new([1, 1], vec![[0.0; 4]]).unwrap();
        Shot { number, picture, notes: Vec::new() }
    }

    fn send_all(feed: &mut Feed, count: usize) -> Result<(), RenderFault> {
        (0..count).try_for_each(|number| Ok(feed.send(shot(number))?))
    }

    #[test]
    fn every_picture_arrives_in_order_and_few_wait() {
        let (sent, most) = (AtomicUsize::new(0), AtomicUsize::new(0));
        let mut seen = Vec::new();
        let encode = |shots: &mut Shots| {
            for shot in shots {
                let number = shot?.number;
                std::thread::sleep(Duration::from_millis(2));
                most.fetch_max(sent.load(Ordering::SeqCst) - number, Ordering::SeqCst);
                seen.push(number);
            }
            Ok(())
        };
        let render = |feed: &mut Feed| {
            (0..20).try_for_each(|number| {
                feed.send(shot(number))?;
                sent.store(number + 1, Ordering::SeqCst);
                Ok(())
            })
        };
        let times = run(render, encode).unwrap();
        assert!(seen.iter().copied().eq(0..20));
        assert!(most.into_inner() <= WAITING + 2);
        assert!(times.waited > 0.0 && times.encoding >= 0.04, "{times:?}");
    }

    #[test]
    fn an_encoder_that_gives_up_stops_rendering_and_says_how_far_it_got() {
        let encode = |shots: &mut Shots| {
            shots.by_ref().take(3).for_each(drop);
            Err(Error::file("out", "is full"))
        };
        let stopped = run(|feed| send_all(feed, 1000), encode).unwrap_err();
        assert_eq!((stopped.error.to_string().as_str(), stopped.done), ("out: is full", 2));
    }

    #[test]
    fn where_rendering_fails_the_encoder_is_told() {
        let mut told = false;
        let encode = |shots: &mut Shots| {
            for shot in shots {
                told |= shot.is_err();
            }
            Ok(())
        };
        let render = |feed: &mut Feed| {
            send_all(feed, 2)?;
            Err(Error::Interrupted.into())
        };
        let stopped = run(render, encode).unwrap_err();
        assert!(matches!(stopped.error, Error::Interrupted) && stopped.done == 2 && told);
    }
}
