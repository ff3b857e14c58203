//! A scene and how it moves: what each picture of a sequence sets in it, and the one world that all are rendered from.

use hecs::World;

use super::range::FrameRange;
use super::tracks::value;
use super::turn::{Axis, turned};
use crate::components::{Animate, Name, Order, Track, View};
use crate::error::{Blame, Error};
use crate::scene::{Kept, Loads, Scene, load_keeping, overridden};
use crate::view::camera::Camera;
use crate::view::extent::Extent;
use crate::view::observer::first_view;

/// A scene in motion: a world that is made ready for one picture after the other, in any order.
pub struct Film {
    loads: Loads,
    /// Changes of the scene that hold for every picture, `ENTITY.COMPONENT.KEY=VALUE`.
    changes: Vec<String>,
    kept: Kept,
    /// The scene as it stands now: as stated, then as the picture that was last shown sets it.
    pub scene: Scene,
    range: FrameRange,
    axis: Option<Axis>,
    /// The name of the view, and what it states before anything turns.
    view: (String, View),
    /// By the names of their entities, in the order of the scene.
    tracks: Vec<(String, Track)>,
    /// The height of every window, world units, where neither the view nor a track states one.
    height: Option<f64>,
}

impl Film {
    /// Loads a scene that is to move over a range of pictures.
    ///
    /// Without an `axis` it moves as its `animate` components say or, where there are none, turns about azimuth. With one,
    /// the observer turns about it, from where the keyframes have him.
    pub fn open(
        loads: Loads,
        changes: Vec<String>,
        range: FrameRange,
        axis: Option<Axis>,
    ) -> Result<Self, Error> {
        let mut kept = Kept::default();
        let scene = load_keeping(&loads, &changes, &mut kept)?;
        let tracks = tracks(&scene.world);
        let axis = axis.or(tracks.is_empty().then_some(Axis::Azimuth));
        let (view, extent) = view(&scene.world)?;
        let mut film =
            Self { loads, changes, kept, scene, range, axis, view, tracks, height: None };
        film.height = film.fitted(&extent);
        Ok(film)
    }

    /// The height of a window that holds the scene in every picture: fitted to each alone, it would breathe.
    fn fitted(&self, extent: &Extent) -> Option<f64> {
        let own = |(name, track): &(String, Track)| {
            *name == self.view.0 && track.key.starts_with("view.height_mm")
        };
        let stated = self.view.1.height_mm.is_some() || self.tracks.iter().any(own);
        let height = |number: usize| {
            let camera = Camera::new(&self.view_of(number), extent);
            camera.pixel * camera.size[1] as f64
        };
        (!stated).then(|| (0..self.range.count()).map(height).fold(0.0, f64::max))
    }

    /// The pictures of the sequence.
    #[must_use]
    pub fn range(&self) -> &FrameRange {
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
        if let Some(height) = self.height {
            changes.push(format!("{}.view.height_mm={height}", self.view.0));
        }
        if self.axis.is_some() {
            let (before, after) = (self.view_at(part), self.view_of(number));
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

    /// Where the observer stands in a picture.
    fn view_of(&self, number: usize) -> View {
        let before = self.view_at(self.range.part(number));
        self.axis.map_or_else(
            || before.clone(),
            |axis| turned(&before, axis, self.range.degrees(number)),
        )
    }

    /// The view before it turns: as stated, or as keyframes have it.
    fn view_at(&self, part: f64) -> View {
        let mut view = self.view.1.clone();
        for (_, track) in self.tracks.iter().filter(|(name, _)| *name == self.view.0) {
            let angle = match track.key.as_str() {
                "view.azimuth" => &mut view.azimuth,
                "view.elevation" => &mut view.elevation,
                "view.roll" => &mut view.roll,
                "view.field_of_view" => view.field_of_view.get_or_insert_default(),
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

/// The first view, what it is called and states, and the box that it shows.
fn view(world: &World) -> Result<((String, View), Extent), Error> {
    let missing = || Error::Schedule("the scene was loaded without a view".to_owned());
    let entity = first_view(world).ok_or_else(missing)?;
    let mut found = world.query_one::<(&Name, &View, &Extent)>(entity);
    let (name, view, extent) = found.get().map_err(|_| missing())?;
    Ok(((name.0.clone(), view.clone()), *extent))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Source;

    fn film(view: &str) -> Film {
        let text = format!(
            "[[entity]]\nname = \"v\"\nvolume = {{ file = \"phantom:ball\" }}\n[[entity]]\nname = \"o\"\n{view}\n"
        );
        let source = Source::inline("s", text);
        let loads = Loads { data: Vec::new(), exact: false, most_bytes: None, source };
        Film::open(loads, Vec::new(), FrameRange::turn(8), None).unwrap()
    }

    /// What each picture says of the height of its window, as TOML.
    fn heights(film: &Film) -> Vec<String> {
        let height = |number| {
            let changes = film.changes(number);
            changes.iter().filter_map(|c| c.strip_prefix("o.view.height_mm=")).collect()
        };
        (0..8).map(height).collect()
    }

    #[test]
    fn a_window_without_a_stated_height_keeps_one_that_holds_every_picture() {
        let stated = film("view = { size = [40, 40], height_mm = 9 }");
        assert!(heights(&stated).iter().all(String::is_empty));
        for view in ["view = { size = [40, 40] }", "view = { size = [40, 30], field_of_view = 40 }"]
        {
            let film = film(view);
            let heights = heights(&film);
            assert!(heights.iter().all(|height| *height == heights[0]), "{heights:?}");
            let (_, extent) = super::view(&film.scene.world).unwrap();
            let mut free = f64::INFINITY;
            for number in 0..8 {
                let view = View { height_mm: heights[0].parse().ok(), ..film.view_of(number) };
                let camera = Camera::new(&view, &extent);
                for corner in extent.corners() {
                    let [x, y] = camera.project(corner).0.to_array();
                    let [width, height] = camera.size.map(|side| side as f64);
                    let sides = [x / width, 1.0 - x / width, y / height, 1.0 - y / height];
                    free = sides.into_iter().fold(free, f64::min);
                }
            }
            assert!((free - 0.05).abs() < 1e-9, "{free}");
        }
    }
}
