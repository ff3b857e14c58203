//! 3D scan-conversion of polygons with analytic anti-aliasing: shaded, filtered, sampled (paper §3, figure 4).

use glam::{DVec3, Vec3};
use hecs::{Entity, World};
use rayon::prelude::*;

use crate::components::{CastsShadow, Matte, Name, Surface, Voxelize};
use crate::error::Error;
use crate::light::shading::{Lamps, Reflectance, lamps};
use crate::polygon::coverage::REACH;
use crate::polygon::coverage::{Ball, Covered, Flat};
use crate::polygon::face::{Face, FaceColors, FaceOpacities, Faces};
use crate::schedule::{Outbox, Plan, ProductKey, System};
use crate::view::observer;
use crate::volume::bricks::{Bricks, VOXELS};
use crate::volume::grid::Grid;
use crate::volume::layer::{Coverage, Layer, LitColors};
use crate::volume::scene_volumes::{around, volumes};
use crate::volume::voxel_colors::VoxelColors;

/// Makes the [`Coverage`] of every polygon that carries `voxelize`, in the grid of the volume that it is in; and where a light
/// casts shadows, that of the hybrid tracer's polygons too: they cast theirs by it.
pub struct ScanConvert;

/// What a coverage is made from.
#[derive(Clone, PartialEq)]
struct Inputs {
    faces: Faces,
    surface: Surface,
    /// Colors in place of the surface's.
    own: Option<FaceColors>,
    /// Parts of the surface's opacity.
    opacities: Option<FaceOpacities>,
    /// How; its operator is not looked at, and always the default.
    voxelize: Voxelize,
    grid: Grid,
    unit: f64,
    lamps: Lamps,
    /// Whether ambient light is kept apart, for a depth cue.
    ambient_apart: bool,
    /// Whether it is there for its shadow alone, and needs no colour.
    colorless: bool,
}

impl System for ScanConvert {
    type Product = Coverage;
    const NAME: &'static str = "scan_convert";
    const READS: &'static [ProductKey] = &[];

    fn run(world: &World, out: &mut Outbox<'_, Coverage>) -> Result<(), Error> {
        type Stated<'a> = (
            Entity,
            &'a Faces,
            &'a Surface,
            (Option<&'a FaceColors>, Option<&'a FaceOpacities>),
            Option<&'a Voxelize>,
            Option<&'a Name>,
        );
        let (volumes, shadows) = (volumes(world), casts_shadows(world));
        let ambient_apart = observer::is_cued(world);
        let mut query = world.query::<Stated<'_>>();
        for (entity, faces, surface, (own, opacities), voxelize, name) in &mut query {
            out.watch().check()?;
            let name = name.map_or("polygon", |name| &name.0);
            if voxelize.is_none() && !shadows {
                continue;
            }
            let Some(volume) = around(&volumes, || faces.middle()) else {
                if voxelize.is_none() {
                    continue;
                }
                let problem = "`voxelize` puts it into a volume and the scene has none; state a `volume` or take `voxelize` off";
                return Err(Error::entity(name, problem));
            };
            let colorless = voxelize.is_none();
            let how = Reflectance::from(surface);
            let lamps = if colorless { Lamps::default() } else { lamps(world, &how) };
            // Another operator makes no other coverage.
            let voxelize = Voxelize {
                matte: Matte::default(),
                calibrated: voxelize.is_none_or(|voxelize| voxelize.calibrated),
            };
            let (faces, surface) = (faces.clone(), surface.clone());
            let (own, opacities) = (own.cloned(), opacities.cloned());
            let (grid, unit) = (volume.grid, volume.unit);
            let inputs = Inputs {
                faces,
                surface,
                own,
                opacities,
                voxelize,
                grid,
                unit,
                lamps,
                ambient_apart,
                colorless,
            };
            out.derive(entity, inputs, |inputs| {
                let _inside = tracing::trace_span!("polygon", name).entered();
                inputs.convert().map_err(|problem| Error::entity(name, problem))
            })?;
        }
        Ok(())
    }

    fn plan(world: &World) -> Plan {
        let volumes = volumes(world);
        if volumes.is_empty() {
            return Plan::absent("no volume to scan-convert polygons into");
        }
        let (apart, shadows) = (usize::from(observer::is_cued(world)), casts_shadows(world));
        let colors = 1 + apart + Lamps::of(world, DVec3::ZERO).shadowed.len();
        // A face is of one color, which is not kept voxel by voxel.
        let brick =
            |colors: usize| (VOXELS * (size_of::<f32>() + colors * size_of::<[f32; 3]>())) as u64;
        let mut query = world.query::<(Entity, &Faces, Option<&Voxelize>)>().with::<&Surface>();
        let makes: Vec<_> = query
            .iter()
            .filter(|(_, _, voxelize)| voxelize.is_some() || shadows)
            .filter_map(|(entity, faces, voxelize)| {
                let colors = if voxelize.is_some() && faces.0.len() > 1 { colors } else { 0 };
                let grid = around(&volumes, || faces.middle())?.grid;
                let table = grid.size.iter().map(|n| n.div_ceil(8) as u64).product::<u64>();
                let flats = faces.0.par_iter().filter_map(|face| Flat::new(face, &grid));
                // A brick near several faces is stored once.
                let bricks =
                    flats.map(|flat| flat.bricks(REACH, grid.size).len() as u64).sum::<u64>();
                Some((entity, bricks.min(table) * brick(colors) + table * 4 * (1 + colors as u64)))
            })
            .collect();
        if makes.is_empty() {
            return Plan::absent("no polygon carries `voxelize` or casts a shadow");
        }
        Plan::of_most(makes, "a polygon carries `voxelize`, or casts a shadow into the volume")
    }
}

/// Whether some light casts shadows.
fn casts_shadows(world: &World) -> bool {
    world.query::<&CastsShadow>().iter().next().is_some()
}

impl Inputs {
    fn convert(&self) -> Result<Coverage, String> {
        let faces = &self.faces.0;
        let flat = |(at, face): (usize, &Face)| {
            let opacity = f64::from(FaceOpacities::of(self.opacities.as_ref(), at));
            Flat::new(face, &self.grid).map(|flat| flat.seen_through(opacity))
        };
        let flats: Option<Vec<Flat>> = faces.par_iter().enumerate().map(flat).collect();
        let flats = flats.ok_or(
            "a vertex is more than 1e100 voxels away from the volume; state vertices in the world's units",
        )?;
        let ball = Ball::stated(&self.surface, &self.voxelize, self.unit, &self.grid, &flats);
        let covered = Covered::new(faces, &flats, &ball, self.grid.size);
        let opacity = covered.opacity();
        let colors = self.colors(&covered, &opacity);
        Ok(Coverage(Layer { opacity, colors }))
    }

    /// The colours: directional lights shade a face alike all over, so it is shaded once.
    fn colors(&self, covered: &Covered, opacity: &Bricks<f32>) -> LitColors {
        let alike = |color: Vec3| VoxelColors::alike(color, opacity.clone());
        if self.colorless {
            return LitColors { base: alike(Vec3::ZERO), shadowed: Vec::new(), ambient: None };
        }
        let how = Reflectance::from(&self.surface);
        let bricks = |of_face: &(dyn Fn(Vec3, Vec3) -> Vec3 + Sync)| {
            let shade = |(at, face): (usize, &Face)| {
                let own = FaceColors::of(self.own.as_ref(), at);
                of_face(face.normal.as_vec3(), own.unwrap_or(self.surface.color).0)
            };
            match &self.faces.0.iter().enumerate().map(shade).collect::<Vec<_>>()[..] {
                [color] => alike(*color),
                colors => covered.colors(colors).into(),
            }
        };
        let in_base = if self.ambient_apart { 0.0 } else { how.ambient };
        let plain = &self.lamps.plain;
        let base = bricks(&|normal, color| {
            plain
                .iter()
                .fold(color * in_base, |sum, lamp| sum + lamp.reflected(color, normal, &how))
        });
        let shadowed = &self.lamps.shadowed;
        let shadowed = shadowed
            .iter()
            .map(|(_, lamp)| bricks(&|normal, color| lamp.reflected(color, normal, &how)))
            .collect();
        LitColors {
            base,
            shadowed,
            ambient: self.ambient_apart.then(|| bricks(&|_, color| color * how.ambient)),
        }
    }
}
