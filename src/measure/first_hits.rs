//! What is seen first of each pixel: how deep it lies, which way it faces, and of which entity it is.
//!
//! A pixel's ray through its middle meets what makes it half opaque: where its transparency falls below ½, in gel or at a
//! polygon. Textures are left out, and so are volumes that are projected.

use glam::{DAffine3, DVec3};
use hecs::{Entity, World};
use rayon::prelude::*;

use crate::components::{OpacityUnit, Order, Sampling, Surface, View, Voxelize};
use crate::error::Error;
use crate::polygon::face::{Face, Faces};
use crate::polygon::outline::edges;
use crate::view::camera::Camera;
use crate::view::composite::thicken;
use crate::view::extent::Extent;
use crate::view::observer::first_view;
use crate::view::ray::Ray;
use crate::volume::gel::{CELLS, Gel, GelBricks};
use crate::volume::grid::{Grid, smallest_spacing};
use crate::volume::scene_volumes::{Content, with_content};
use crate::with_texels;

/// What a ray lets through where it has met something.
const HALF: f64 = 0.5;

/// For each pixel, row by row from the top, what its middle shows first.
#[derive(Debug, Clone, PartialEq)]
pub struct FirstHits {
    /// Pixels across and down.
    pub size: [usize; 2],
    /// Depth from the focal plane along the line of sight, world units, less is nearer; NaN where nothing is met.
    pub depth: Vec<f32>,
    /// The unit normal towards the observer, world; zeros where nothing is met or the gel has no slope.
    pub normal: Vec<[f32; 3]>,
    /// The place in the scene of the entity that is met, from 1; 0 where nothing is.
    pub entity: Vec<u32>,
}

/// What a ray met.
#[derive(Clone, Copy)]
struct Hit {
    depth: f64,
    normal: DVec3,
    entity: u32,
}

/// Finds out whether a world will have [`first_hits`]: not where volumes state `reconstruct = "values"`, of which no gel is made.
pub fn check(world: &World) -> Result<(), Error> {
    if with_content(world, Content::Values).is_empty() {
        return Ok(());
    }
    let problem = "maps are of gel, and a volume's `reconstruct` is values; take either away";
    Err(Error::entity("view", problem))
}

/// The first hits of a world whose systems have run, on its first view.
///
/// Fails without a view, and where [`check`] does.
pub fn first_hits(world: &World) -> Result<FirstHits, Error> {
    check(world)?;
    let missing = || Error::Schedule("there is no view to find first hits on".to_owned());
    let view = first_view(world).ok_or_else(missing)?;
    let mut seen = world.query_one::<(&View, &Sampling, &Extent)>(view);
    let (view, sampling, extent) = seen.get().map_err(|_| missing())?;
    let mut volumes = world.query::<(Entity, &Gel, &Grid, &OpacityUnit, Option<&Order>)>();
    let volumes: Vec<Volume> = volumes
        .iter()
        .map(|(_, gel, grid, unit, order)| Volume {
            gel: gel.lit.clone(),
            size: grid.size,
            to_index: grid.world_to_index(),
            unit: unit.0,
            entity: number(order),
        })
        .collect();
    let spacings = with_content(world, Content::Classified).into_iter();
    let spacings = spacings.chain(with_content(world, Content::Painted)).map(|v| v.grid);
    let step = sampling.distance_mm.or_else(|| smallest_spacing(spacings));
    let mut faces = world.query::<(&Faces, &Surface, Option<&Order>)>().without::<&Voxelize>();
    let camera = Camera::new(view, extent);
    let faces: Vec<Traced> = faces
        .iter()
        .flat_map(|(faces, surface, order)| {
            let opacity = f64::from(surface.opacity);
            let traced = |face: &Face| Traced::new(face, &camera, opacity, number(order));
            faces.0.iter().map(traced).collect::<Vec<_>>()
        })
        .collect();
    let step = step.unwrap_or(extent.radius());
    Ok(Scene { camera, extent: *extent, step, volumes, faces }.hits())
}

fn number(order: Option<&Order>) -> u32 {
    order.map_or(0, |order| order.0).saturating_add(1)
}

struct Scene {
    camera: Camera,
    extent: Extent,
    step: f64,
    volumes: Vec<Volume>,
    faces: Vec<Traced>,
}

/// A volume as gel.
struct Volume {
    gel: GelBricks,
    size: [usize; 3],
    to_index: DAffine3,
    unit: f64,
    entity: u32,
}

/// A polygon, with two axes of its plane.
struct Traced {
    normal: DVec3,
    center: DVec3,
    axes: [DVec3; 2],
    outlines: Vec<Vec<[f64; 2]>>,
    /// The rows of pixels that it lies in, from the first to the last; infinite where it reaches behind the eye.
    rows: [f64; 2],
    opacity: f64,
    entity: u32,
}

impl Scene {
    fn hits(&self) -> FirstHits {
        let size = self.camera.size;
        // Of a mesh a row of pixels passes by most faces.
        let row = |y: usize| {
            let near: Vec<&Traced> = self.faces.iter().filter(|face| face.is_near(y)).collect();
            (0..size[0]).map(|x| self.hit([x, y], &near)).collect::<Vec<_>>()
        };
        let hits: Vec<Option<Hit>> = (0..size[1]).into_par_iter().flat_map_iter(row).collect();
        let of = |hit: &Option<Hit>, value: fn(&Hit) -> f32| hit.as_ref().map_or(f32::NAN, value);
        FirstHits {
            size,
            depth: hits.iter().map(|hit| of(hit, |hit| hit.depth as f32)).collect(),
            normal: hits
                .iter()
                .map(|hit| hit.map_or([0.0; 3], |hit| hit.normal.as_vec3().to_array()))
                .collect(),
            entity: hits.iter().map(|hit| hit.map_or(0, |hit| hit.entity)).collect(),
        }
    }

    /// What the middle of a pixel shows first; it meets no faces but those `near`.
    fn hit(&self, [x, y]: [usize; 2], near: &[&Traced]) -> Option<Hit> {
        let ray = self.camera.ray(glam::DVec2::new(x as f64 + 0.5, y as f64 + 0.5));
        let mut met: Vec<(f64, &Traced)> = near
            .iter()
            .filter_map(|face| Some((face.depth(&ray)?, *face)))
            .filter(|(depth, _)| *depth >= self.camera.nearest())
            .collect();
        met.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut met = met.into_iter().peekable();
        let toward = -ray.along.normalize();
        let facing = |normal: DVec3| if normal.dot(toward) < 0.0 { -normal } else { normal };
        let middle = self.camera.depth(self.extent.center());
        let near = (middle - self.extent.radius()).max(self.camera.nearest());
        let slabs = (2.0 * self.extent.radius() / self.step).ceil().min(1e6) as usize;
        let slabs = if self.volumes.is_empty() { 0 } else { slabs };
        let mut clear = 1.0;
        for slab in 0..=slabs {
            let from = near + slab as f64 * self.step;
            let until = if slab == slabs { f64::INFINITY } else { from + self.step };
            while let Some((depth, face)) = met.next_if(|(depth, _)| *depth < until) {
                clear *= 1.0 - face.opacity;
                if clear < HALF {
                    let normal = facing(face.normal);
                    return Some(Hit { depth, normal, entity: face.entity });
                }
            }
            if slab < slabs {
                let before = clear;
                let at = ray.at(from + self.step / 2.0);
                let (left, thickest) = self.through(at, &ray);
                clear *= left;
                if clear < HALF {
                    let part = (before / HALF).ln() / (before / clear.max(1e-9)).ln();
                    let volume = thickest?;
                    let normal = facing(volume.slope(at).normalize_or_zero());
                    let depth = from + self.step * part.clamp(0.0, 1.0);
                    return Some(Hit { depth, normal, entity: volume.entity });
                }
            }
        }
        None
    }

    /// What a slab around a point lets through, and which volume holds back the most.
    fn through(&self, at: DVec3, ray: &Ray) -> (f64, Option<&Volume>) {
        let way = self.step * ray.along.length();
        let (mut left, mut thickest) = (1.0, (0.0, None));
        for volume in &self.volumes {
            let opacity = thicken(volume.opacity(at), way / volume.unit);
            left *= 1.0 - opacity;
            if opacity > thickest.0 {
                thickest = (opacity, Some(volume));
            }
        }
        (left, thickest.1)
    }
}

impl Volume {
    /// The opacity at a world point, per opacity unit; 0 outside.
    fn opacity(&self, world: DVec3) -> f64 {
        let index = self.to_index.transform_point3(world).to_array();
        let last = self.size.map(|n| n as f64 - 1.0);
        if (0..3).any(|a| !(0.0..=last[a]).contains(&index[a])) {
            return 0.0;
        }
        let cell = index.map(|n| n as usize);
        let within = DVec3::from_array(std::array::from_fn(|a| index[a] - cell[a] as f64));
        with_texels!(&self.gel, texels => {
            let slices = texels.slices();
            let brick = slices.stored(texels.entry(cell));
            f64::from(slices.sample(brick, cell.map(|n| n % CELLS), within.as_vec3()).w)
        })
    }

    /// Where the opacity falls, world: minus its gradient.
    fn slope(&self, world: DVec3) -> DVec3 {
        let to_world = self.to_index.inverse().matrix3;
        let differences = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| {
            let step = to_world * axis;
            self.opacity(world + step) - self.opacity(world - step)
        });
        -(self.to_index.matrix3.transpose() * DVec3::from(differences))
    }
}

impl Traced {
    fn new(face: &Face, camera: &Camera, opacity: f64, entity: u32) -> Self {
        let axes = face.normal.any_orthonormal_pair();
        let flat = |vertex: &DVec3| {
            let from = *vertex - face.center;
            [from.dot(axes.0), from.dot(axes.1)]
        };
        let outlines =
            face.outlines.iter().map(|outline| outline.iter().map(flat).collect()).collect();
        let Face { normal, center, .. } = *face;
        let rows = rows(face, camera);
        Self { normal, center, axes: [axes.0, axes.1], outlines, rows, opacity, entity }
    }

    /// Whether the middles of a row of pixels may meet it.
    fn is_near(&self, y: usize) -> bool {
        let middle = y as f64 + 0.5;
        self.rows[0] <= middle && middle <= self.rows[1]
    }

    /// How deep a ray meets it.
    fn depth(&self, ray: &Ray) -> Option<f64> {
        let depth = self.normal.dot(self.center - ray.origin) / self.normal.dot(ray.along);
        let from = ray.at(depth) - self.center;
        let [x, y] = self.axes.map(|axis| axis.dot(from));
        let crosses = |([ax, ay], [bx, by]): ([f64; 2], [f64; 2])| {
            (ay <= y) != (by <= y) && x < ax + (y - ay) / (by - ay) * (bx - ax)
        };
        let edges = self.outlines.iter().flat_map(|outline| edges(outline));
        let inside = edges.filter(|edge| crosses(*edge)).count() % 2 == 1;
        (depth.is_finite() && inside).then_some(depth)
    }
}

/// Between which heights in the window a face lies, pixels, with room for what is rounded.
fn rows(face: &Face, camera: &Camera) -> [f64; 2] {
    let vertices = || face.outlines.iter().flatten();
    if vertices().any(|vertex| camera.depth(*vertex) < camera.nearest()) {
        return [f64::NEG_INFINITY, f64::INFINITY];
    }
    let heights = vertices().map(|vertex| camera.project(*vertex).0.y);
    let [low, high] = heights
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], y| [low.min(y), high.max(y)]);
    [low - 0.25, high + 0.25]
}
