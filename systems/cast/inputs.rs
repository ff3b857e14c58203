//! What the rays of a view may meet, gathered from the world: equal inputs need no second cast.

use hecs::{Entity, World};

use super::projection::StatedProjection;
use super::shaft::StatedShaft;
use crate::components::{
    Classify, Clip, DepthCue, Filter, Light, Material, Order, Projection, Sampling, Shaft, Surface,
    View, Voxelize,
};
use crate::light::shading::{Lamps, Reflectance, lamps};
use crate::light::strength::LightStrength;
use crate::light::strength::ProjectedBy;
use crate::polygon::face::{FaceColors, FaceOpacities, Faces};
use crate::polygon::smooth::CornerNormals;
use crate::polygon::texture::TexturedBy;
use crate::schedule::ProductKey;
use crate::view::camera::Camera;
use crate::view::extent::Extent;
use crate::volume::coefficients::Coefficients;
use crate::volume::gel::Gel;
use crate::volume::grid::{Grid, Scalars};
use crate::volume::pyramid::Pyramid;
use crate::volume::ranges::Ranges;
use crate::volume::scene_volumes::{self, SceneVolume, around, volumes, with_content};

/// The products that [`Inputs::of`] reads: those of whoever casts rays.
pub(super) const READS: [ProductKey; 5] = [
    ProductKey::of::<Gel>(),
    ProductKey::of::<Coefficients>(),
    ProductKey::of::<Pyramid>(),
    ProductKey::of::<LightStrength>(),
    ProductKey::of::<Ranges>(),
];

/// What the rays of a view meet.
#[derive(PartialEq)]
pub struct Inputs {
    pub view: View,
    pub sampling: Sampling,
    pub extent: Extent,
    pub cue: Option<DepthCue>,
    /// In the order of the scene.
    pub volumes: Vec<Placed>,
    pub polygons: Vec<TracedPolygons>,
    pub lamps: Lamps,
    /// β of each light of `lamps` that casts a shadow.
    pub strengths: Vec<Option<LightStrength>>,
    pub shafts: Vec<StatedShaft>,
    /// The volumes that are projected, in the order of the scene.
    pub projections: Vec<StatedProjection>,
}

/// Faces that stay polygons, and how they look.
#[derive(PartialEq)]
pub(crate) struct TracedPolygons {
    pub faces: Faces,
    pub surface: Surface,
    pub colors: Option<FaceColors>,
    pub opacities: Option<FaceOpacities>,
    pub normals: Option<CornerNormals>,
    pub textured: Option<TexturedBy>,
    /// The grid of the volume that they cast their shadows in.
    pub grid: Option<Grid>,
}

/// A volume and where it is.
#[derive(PartialEq)]
pub(crate) struct Placed {
    pub grid: Grid,
    pub content: Sampled,
    pub pyramid: Option<Pyramid>,
    pub unit: f64,
}

/// What rays sample of a volume.
#[derive(PartialEq)]
pub enum Sampled {
    Gel(Gel),
    Values(Box<StatedValues>),
}

/// Scalars that are classified and shaded at samples, and all that decides how they look.
#[derive(PartialEq)]
pub(crate) struct StatedValues {
    /// What is interpolated: the volume's own, or a spline's coefficients.
    pub scalars: Scalars,
    pub filter: Filter,
    /// Whether slabs are integrated: where it is asked for, and all voxels are numbers, so that no value is passed over.
    pub integrate: bool,
    pub classify: Classify,
    pub material: Material,
    pub clip: Option<Clip>,
    pub lamps: Lamps,
    /// β of each light of `lamps` that casts a shadow.
    pub strengths: Vec<Option<LightStrength>>,
}

impl Inputs {
    /// What the rays of a view of `world` may meet; `camera` is that view's.
    pub fn of(
        world: &World,
        (view, sampling, extent, cue): (&View, &Sampling, Extent, Option<DepthCue>),
        camera: &Camera,
    ) -> Self {
        let polygons = hybrid_polygons(world);
        let lamps =
            if polygons.is_empty() { Lamps::default() } else { Lamps::of(world, -camera.forward) };
        Self {
            view: view.clone(),
            sampling: sampling.clone(),
            extent,
            cue,
            volumes: placed(world, sampling),
            strengths: strengths(world, &lamps),
            polygons,
            lamps,
            shafts: shafts(world),
            projections: projections(world),
        }
    }
}

/// The polygons that stay polygons, in the order of the scene.
fn hybrid_polygons(world: &World) -> Vec<TracedPolygons> {
    type Seen<'a> = (&'a Order, &'a Faces, &'a Surface, Own<'a>, Option<&'a TexturedBy>);
    type Own<'a> = (Option<&'a FaceColors>, Option<&'a FaceOpacities>, Option<&'a CornerNormals>);
    let volumes = volumes(world);
    let mut query = world.query::<Seen<'_>>().without::<&Voxelize>();
    let mut polygons: Vec<_> = query.iter().collect();
    polygons.sort_by_key(|(order, ..)| **order);
    let shown =
        |(_, faces, surface, (colors, opacities, normals), textured): <Seen<'_> as hecs::Query>::Item<'_>| {
            TracedPolygons {
                faces: faces.clone(),
                surface: surface.clone(),
                colors: colors.cloned(),
                opacities: opacities.cloned(),
                normals: normals.cloned(),
                textured: textured.cloned(),
                grid: around(&volumes, || faces.middle()).map(|volume| volume.grid),
            }
        };
    polygons.into_iter().map(shown).collect()
}

/// The strengths of the lights that cast shadows.
fn strengths(world: &World, lamps: &Lamps) -> Vec<Option<LightStrength>> {
    let strength = |light: Entity| world.get::<&LightStrength>(light).ok().map(|s| (*s).clone());
    lamps.shadowed.iter().map(|(light, _)| strength(*light)).collect()
}

/// The shafts of light, in the order of the scene.
fn shafts(world: &World) -> Vec<StatedShaft> {
    type Beam<'a> = (&'a Shaft, &'a Light, Option<&'a ProjectedBy>, Option<&'a LightStrength>);
    let mut query = world.query::<(&Order, Beam<'_>)>();
    let mut shafts: Vec<_> = query.iter().collect();
    shafts.sort_by_key(|(order, _)| **order);
    let stated = |(_, (shaft, light, projected, strength)): (_, Beam<'_>)| StatedShaft {
        shaft: *shaft,
        light: light.clone(),
        projected: projected.cloned(),
        strength: strength.filter(|_| shaft.attenuated).cloned(),
    };
    shafts.into_iter().map(stated).collect()
}

/// The scene's volumes as far as they are seen, in its order.
fn placed(world: &World, sampling: &Sampling) -> Vec<Placed> {
    let placed = |SceneVolume { entity, grid, unit, content }| {
        let content = if content == scene_volumes::Content::Values {
            Sampled::Values(Box::new(values(world, entity, sampling)?))
        } else {
            Sampled::Gel((*world.get::<&Gel>(entity).ok()?).clone())
        };
        let pyramid = world.get::<&Pyramid>(entity).ok().map(|pyramid| (*pyramid).clone());
        Some(Placed { grid, content, pyramid, unit })
    };
    volumes(world).into_iter().filter_map(placed).collect()
}

/// What is stated of a volume whose values are sampled.
fn values(world: &World, entity: Entity, sampling: &Sampling) -> Option<StatedValues> {
    type Stated<'a> = (&'a Scalars, &'a Classify, Option<&'a Material>, Option<&'a Clip>);
    let mut query = world.query_one::<Stated<'_>>(entity);
    let (scalars, classify, material, clip) = query.get().ok()?;
    let material = material.cloned().unwrap_or_default();
    let lamps = lamps(world, &Reflectance::from(&material));
    let made = world.get::<&Coefficients>(entity).ok();
    Some(StatedValues {
        scalars: made.map_or_else(|| scalars.clone(), |made| made.values.clone()),
        filter: sampling.filter,
        integrate: sampling.integrate
            && world.get::<&Ranges>(entity).is_ok_and(|ranges| ranges.are_finite()),
        classify: classify.clone(),
        material,
        clip: clip.cloned(),
        strengths: strengths(world, &lamps),
        lamps,
    })
}

/// The volumes of which a ray shows one value, in the order of the scene.
fn projections(world: &World) -> Vec<StatedProjection> {
    let projection = |SceneVolume { entity, grid, .. }| {
        let stated = StatedProjection {
            shows: get::<Projection>(world, entity)?,
            grid,
            scalars: get::<Scalars>(world, entity)?,
            ranges: get::<Ranges>(world, entity)?,
            classify: get::<Classify>(world, entity)?,
            material: get::<Material>(world, entity).unwrap_or_default(),
            clip: get::<Clip>(world, entity),
        };
        Some(stated)
    };
    with_content(world, scene_volumes::Content::Projected)
        .into_iter()
        .filter_map(projection)
        .collect()
}

fn get<T: hecs::Component + Clone>(world: &World, entity: Entity) -> Option<T> {
    world.get::<&T>(entity).ok().map(|component| (*component).clone())
}
