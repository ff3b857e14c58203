//! A scene and how it moves: what each picture of a sequence sets in it, and the one world that all are rendered from.

use hecs::World;

use super::range::Range;
use super::tracks::value;
use super::turn::{Axis, turned};
use crate::components::{Animate, Name, Order, Track, View};
use crate::error::{Blame, Error};
use crate::scene::{Kept, Loads, Scene, load_keeping, overridden};
use crate::view::observer::first_view;

/// A scene in motion: a world that is made ready for one picture after the other, in any order.
pub struct Film {
    loads: Loads,
    /// Changes of the scene that hold for every picture, `ENTITY.COMPONENT.KEY=VALUE`.
    changes: Vec<String>,
    kept: Kept,
    /// The scene as it stands now: as stated, then as the picture that was last shown sets it.
    pub scene: Scene,
    range: Range,
    axis: Option<Axis>,
    /// The name of the view, and what it states before anything turns.
    view: (String, View),
    /// By the names of their entities, in the order of the scene.
    tracks: Vec<(String, Track)>,
}

impl Film {
    /// Loads a scene that is to move over a range of pictures.
    ///
    /// Without an `axis` it moves as its `animate` components say or, where there are none, turns about azimuth. With one,
    /// the observer turns about it, from where the keyframes have him.
    pub fn open(
        loads: Loads,
        changes: Vec<String>,
        range: Range,
        axis: Option<Axis>,
    ) -> Result<Self, Error> {
        let mut kept = Kept::default();
        let scene = load_keeping(&loads, &changes, &mut kept)?;
        let tracks = tracks(&scene.world);
        let axis = axis.or(tracks.is_empty().then_some(Axis::Azimuth));
        let view = view(&scene.world)?;
        Ok(Self { loads, changes, kept, scene, range, axis, view, tracks })
    }

    /// The pictures of the sequence.
    #[must_use]
    pub fn range(&self) -> &Range {
        &self.range
    }

    /// What a picture sets in the scene: `ENTITY.COMPONENT.KEY=VALUE`, as `--set` takes it.
    #[must_use]
    pub fn changes(&self, number: usize) -> Vec<String> {
        let part = self.range.part(number);
        let set = |(name, track): &(String, Track)| {
            format!("{name}.{}={}", track.key, value(track, part))
        };
        let mut changes: Vec<_> = self.tracks.iter().map(set).collect();
        if let Some(axis) = self.axis {
            let before = self.view_at(part);
            let after = turned(&before, axis, self.range.degrees(number));
            let angle = |key, before: f64, after: f64| {
                (before != after).then(|| format!("{}.view.{key}={after}", self.view.0))
            };
            changes.extend(angle("azimuth", before.azimuth, after.azimuth));
            changes.extend(angle("elevation", before.elevation, after.elevation));
            changes.extend(angle("roll", before.roll, after.roll));
        }
        changes
    }

    /// The text of the scene with what a picture sets: what a plain render of that picture notes as its settings.
    pub fn text(&self, number: usize) -> Result<String, Error> {
        overridden(&self.loads.source, &self.all_changes(number)).map_err(|e| self.told(number, e))
    }

    /// The text of the scene before anything moves.
    pub fn stated(&self) -> Result<String, Error> {
        overridden(&self.loads.source, &self.changes)
    }

    /// Pixels across and down of every picture.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        self.view.1.size.map(|side| side as usize)
    }

    /// Makes the world ready for a picture: what systems made stays, and they make anew only what the picture changes.
    pub fn show(&mut self, number: usize) -> Result<(), Error> {
        let changes = self.all_changes(number);
        let stated = self.scene.restate(&self.loads, &changes, &mut self.kept);
        stated.map_err(|error| self.told(number, error))
    }

    /// Loads every picture that keyframes make, so that what one of them may not state is said before any is rendered.
    pub fn check(&mut self) -> Result<(), Error> {
        let count = if self.tracks.is_empty() { 1 } else { self.range.count() };
        (0..count).try_for_each(|number| self.show(number))
    }

    fn all_changes(&self, number: usize) -> Vec<String> {
        let own = self.changes(number);
        self.changes.iter().cloned().chain(own).collect()
    }

    /// The view before it turns: as stated, or as keyframes have it.
    fn view_at(&self, part: f64) -> View {
        let mut view = self.view.1.clone();
        for (_, track) in self.tracks.iter().filter(|(name, _)| *name == self.view.0) {
            let angle = match track.key.as_str() {
                "view.azimuth" => &mut view.azimuth,
                "view.elevation" => &mut view.elevation,
                "view.roll" => &mut view.roll,
                _ => continue,
            };
            *angle = value(track, part).parse().unwrap_or(*angle);
        }
        view
    }

    /// An error of a value that a picture sets: it stands in no line of the scene.
    fn told(&self, number: usize, error: Error) -> Error {
        match error {
            Error::Scene(mut fault) => {
                let (source, count) = (&self.loads.source.name, self.range.count());
                if fault.blame == Blame::Override {
                    fault.name = format!("{source}, frame {number} of {count}: {}", fault.name);
                } else {
                    fault.name = format!("{source}, frame {number} of {count}");
                }
                fault.blame = Blame::Scene;
                Error::Scene(fault)
            }
            other => other,
        }
    }
}

/// The tracks of all entities, in the order of the scene.
fn tracks(world: &World) -> Vec<(String, Track)> {
    let mut query = world.query::<(&Order, &Name, &Animate)>();
    let mut animated: Vec<_> = query.iter().collect();
    animated.sort_by_key(|(order, ..)| **order);
    let named = |(_, name, animate): (_, &Name, &Animate)| {
        let tracks: Vec<_> =
            animate.tracks.iter().map(|track| (name.0.clone(), track.clone())).collect();
        tracks
    };
    animated.into_iter().flat_map(named).collect()
}

fn view(world: &World) -> Result<(String, View), Error> {
    let missing = || Error::Schedule("the scene was loaded without a view".to_owned());
    let entity = first_view(world).ok_or_else(missing)?;
    let mut found = world.query_one::<(&Name, &View)>(entity);
    let (name, view) = found.get().map_err(|_| missing())?;
    Ok((name.0.clone(), view.clone()))
}
