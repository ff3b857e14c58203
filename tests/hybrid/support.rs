//! Scenes of gel and polygons made in memory, rendered, and seen ray by ray; and the one head that the tests share.

use std::io::Write;
use std::path::PathBuf;
use std::sync::{Arc, LazyLock, Mutex, MutexGuard, PoisonError};

use gelray::components::{
    Color, DepthCue, Name, OpacityUnit, Order, PixelFilter, Sampling, Skip, Surface, TexelKind,
    View,
};
use gelray::polygon::face::{Face, Faces};
use gelray::scene::{Source, load};
use gelray::schedule::{Ran, Schedule, Watch};
use gelray::shared::Shared;
use gelray::systems::JOBS;
use gelray::view::camera::Camera;
use gelray::view::extent::Extent;
use gelray::view::picture::Frame;
use gelray::view::picture::Picture;
use gelray::view::samples::SampleArray;
use gelray::view::samples::Samples;
use gelray::volume::grid::{Grid, Painted};
use glam::{DVec2, DVec3, Vec3};
use hecs::{Entity, World};

/// A polygon's outlines and how it looks.
pub type Polygon = (Vec<Vec<DVec3>>, Surface);

/// A scene: gel, polygons and a view of them.
#[derive(Clone)]
pub struct Mixture {
    pub volume: Option<(Grid, Painted)>,
    /// u.
    pub unit: f64,
    /// An entity each.
    pub polygons: Vec<Polygon>,
    pub view: View,
    pub sampling: Sampling,
    pub cue: Option<DepthCue>,
}

/// A picture, and the rays that it was made of.
pub struct Rendered {
    pub picture: Picture,
    pub array: Arc<SampleArray>,
    pub camera: Camera,
}

impl Mixture {
    /// Gel without polygons; u is the smallest spacing.
    pub fn of(grid: Grid, painted: Painted) -> Self {
        let unit = grid.spacing().min_element();
        Self { volume: Some((grid, painted)), unit, ..Self::nothing() }
    }

    /// Polygons without gel.
    pub fn polygons(polygons: Vec<Polygon>) -> Self {
        Self { polygons, ..Self::nothing() }
    }

    fn nothing() -> Self {
        Self {
            volume: None,
            unit: 1.0,
            polygons: Vec::new(),
            view: View::default(),
            sampling: Sampling::default(),
            cue: None,
        }
    }

    /// The view that looks at the origin through a square window of `size` pixels and `height` world units.
    pub fn seen(mut self, (azimuth, elevation): (f64, f64), size: u32, height: f64) -> Self {
        let (focal_point, height_mm) = (Some([0.0; 3]), Some(height));
        self.view =
            View { azimuth, elevation, focal_point, height_mm, size: [size; 2], ..self.view };
        self
    }

    pub fn extent(&self) -> Extent {
        let corners = self.volume.iter().flat_map(|(grid, _)| grid.corners());
        let vertices = self.polygons.iter().flat_map(|(outlines, _)| outlines.iter().flatten());
        Extent::of(corners.chain(vertices.copied())).unwrap()
    }

    /// The world of the scene, and its view.
    pub fn world(&self) -> (World, Entity) {
        self.try_world().unwrap()
    }

    /// The world of a scene whose polygons may be refused.
    fn try_world(&self) -> Result<(World, Entity), String> {
        let mut world = World::new();
        if let Some((grid, painted)) = &self.volume {
            world.spawn((Order(0), *grid, painted.clone(), OpacityUnit(self.unit)));
        }
        for (i, (outlines, surface)) in self.polygons.iter().enumerate() {
            let face = Face::new(outlines.clone())?;
            let faces = Faces(Arc::new(vec![face]));
            world.spawn((Order(1 + i as u32), faces, surface.clone()));
        }
        let order = Order(1 + self.polygons.len() as u32);
        let seen = (self.view.clone(), self.sampling.clone(), self.extent());
        let view = world.spawn((Name("view".into()), order, seen.0, seen.1, seen.2));
        if let Some(cue) = self.cue {
            world.insert_one(view, cue).unwrap();
        }
        Ok((world, view))
    }

    pub fn render(&self) -> Rendered {
        self.try_render().unwrap()
    }

    /// Renders what may be refused.
    pub fn try_render(&self) -> Result<Rendered, String> {
        let (mut world, view) = self.try_world()?;
        schedule().run(&mut world, &Watch::default()).map_err(|error| error.to_string())?;
        Ok(rendered(&world, view))
    }
}

impl Rendered {
    /// Every ray that was cast: its position, window coordinates and C.
    pub fn rays(&self) -> impl Iterator<Item = ([usize; 2], DVec2, [f32; 4])> + '_ {
        let array = &self.array;
        let [across, down] = array.layout.positions();
        let all = (0..down).flat_map(move |j| (0..across).map(move |i| [i, j]));
        all.filter(|&[i, j]| array.is_cast(i, j)).map(|[i, j]| {
            let window = DVec2::new(array.layout.window(i), array.layout.window(j));
            ([i, j], window, array.color(i, j))
        })
    }

    pub fn rays_per_pixel(&self) -> f64 {
        self.array.counts.rays as f64 / (self.picture.size[0] * self.picture.size[1]) as f64
    }
}

pub fn rendered(world: &World, view: Entity) -> Rendered {
    let extent = *world.get::<&Extent>(view).unwrap();
    Rendered {
        picture: world.get::<&Frame>(view).unwrap().0.clone(),
        array: Arc::clone(&world.get::<&Samples>(view).unwrap().0),
        camera: Camera::new(&world.get::<&View>(view).unwrap(), &extent),
    }
}

pub fn schedule() -> Schedule {
    Schedule::new(JOBS).unwrap()
}

pub fn run(world: &mut World) -> Vec<Ran> {
    schedule().run(world, &Watch::default()).unwrap()
}

/// A grid of spacing `h` about the origin.
pub fn centred(size: [usize; 3], h: f64) -> Grid {
    Grid::axis_aligned(size, [h; 3], size.map(|n| -h * (n - 1) as f64 / 2.0)).unwrap()
}

/// Straight linear RGBA from the index of each voxel.
pub fn paint(grid: &Grid, color: impl Fn([usize; 3]) -> [f32; 4]) -> Painted {
    let [nx, ny, _] = grid.size;
    let voxels =
        (0..grid.voxels()).map(|at| color([at % nx, at / nx % ny, at / (nx * ny)])).collect();
    Painted::F32(Shared::new(voxels))
}

/// The same gel at every voxel.
pub fn homogeneous(grid: &Grid, rgba: [f32; 4]) -> Painted {
    paint(grid, |_| rgba)
}

/// A surface that shows its colour whatever the light.
pub fn flat(color: [f32; 3], opacity: f32) -> Surface {
    let color = Color(Vec3::from(color));
    Surface { color, opacity, ambient: 1.0, diffuse: 0.0, ..Surface::default() }
}

/// A square of half side `half` about `center`, perpendicular to `normal`.
pub fn square(center: DVec3, normal: DVec3, half: f64) -> Vec<DVec3> {
    let (a, b) = normal.normalize().any_orthonormal_pair();
    [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        .map(|(x, y)| center + (a * x + b * y) * half)
        .to_vec()
}

/// One ray a pixel, at the pixels' middles, no stopping, 32-bit texels.
pub fn every_pixel() -> Sampling {
    let texel = TexelKind::F32;
    Sampling { coarsest: 4, finest: 4, stop_at: 0.0, texel, ..Sampling::default() }
}

/// A ray at every position, no stopping; empty gel is still stepped over, which loses nothing.
pub fn every_position() -> Sampling {
    Sampling { skip: Skip::Pyramid, ..Sampling::default().exact() }
}

/// The bits of a picture.
pub fn bits(picture: &Picture) -> Vec<[u32; 4]> {
    picture.pixels.iter().map(|pixel| pixel.map(f32::to_bits)).collect()
}

/// The greatest difference of a channel.
pub fn worst(a: &Picture, b: &Picture) -> f32 {
    assert_eq!(a.size, b.size);
    let pairs = a.pixels.iter().flatten().zip(b.pixels.iter().flatten());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

/// What every picture of light within 0..=1 is: finite, 0 ≤ α ≤ 1, colours within 0..=α but for rounding.
pub fn assert_sound(picture: &Picture, what: &str) {
    for (at, pixel) in picture.pixels.iter().enumerate() {
        let [r, g, b, alpha] = *pixel;
        let sound = (0.0..=1.0).contains(&alpha)
            && [r, g, b].iter().all(|c| (0.0..=alpha + 2e-7).contains(c));
        assert!(sound, "{what}: pixel {at} is {pixel:?}");
    }
}

/// A world and its view that tests take turns with.
pub struct Shown {
    pub world: World,
    pub view: Entity,
}

impl Shown {
    /// An embedded scene, its data taken from `data`.
    pub fn embedded(name: &str, data: &[PathBuf]) -> Self {
        let scene = load(&Source::embedded(name).unwrap(), &[], data, false).unwrap();
        let world = scene.world;
        let view = world.query::<(Entity, &View)>().iter().next().unwrap().0;
        Self { world, view }
    }

    /// Renders with a view changed and a sampling chosen; everything else is kept.
    pub fn render(&mut self, change: impl FnOnce(&mut View), sampling: Sampling) -> Rendered {
        change(&mut self.world.get::<&mut View>(self.view).unwrap());
        self.world.insert_one(self.view, sampling).unwrap();
        run(&mut self.world);
        rendered(&self.world, self.view)
    }
}

static HEAD: LazyLock<Mutex<Shown>> =
    LazyLock::new(|| Mutex::new(Shown::embedded("figure_06a", &[])));

/// Figure 6a of the phantom of a head; whoever holds it sets view and sampling as needed.
pub fn head() -> MutexGuard<'static, Shown> {
    HEAD.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The folder of real data, if it is stated and holds the head of figure 6; else says so.
pub fn data(fact: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("GELRAY_DATA").map(PathBuf::from);
    let found = folder.filter(|folder| {
        folder.join("cthead.nrrd").exists() || folder.join("cthead/cthead.nrrd").exists()
    });
    if found.is_none() {
        // Past the harness, which keeps what passing tests print to itself.
        let _ = writeln!(
            std::io::stderr(),
            "skipped: {fact}: set GELRAY_DATA to a folder with cthead.nrrd"
        );
    }
    found
}

/// The sampling of figure 6a with another pixel filter, texel or the like.
pub fn sampling_of_the_head() -> Sampling {
    Sampling { distance_mm: Some(1.0), pixel_filter: PixelFilter::Box, ..Sampling::default() }
}
