//! Worlds of one volume and one light, swept by the system itself.

use gelray::components::{CastsShadow, Color, Light, Name, OpacityUnit, Order, Shaft, Toward};
use gelray::light::strength::LightStrength;
use gelray::light::strength::ProjectedBy;
use gelray::schedule::{Job, Schedule, Watch};
use gelray::systems::light_sweep::LightSweep;
use gelray::volume::bricks::{Bricks, VOXELS};
use gelray::volume::grid::Grid;
use gelray::volume::layer::Opacity;
use glam::{DAffine3, DVec3};
use hecs::{Entity, World};

pub const NO_BIAS: CastsShadow = CastsShadow { bias_voxels: 0.0, k1: 1.0, k2: 0.0 };

pub struct Scene {
    pub world: World,
    pub volume: Entity,
    pub light: Entity,
}

/// Unit voxels from the origin on.
pub fn cubes(size: [usize; 3]) -> Grid {
    Grid::new(size, DAffine3::IDENTITY).unwrap()
}

pub fn bricks(size: [usize; 3], value: impl Fn([usize; 3]) -> f32 + Send + Sync) -> Bricks<f32> {
    Bricks::make(size, |place, brick: &mut [f32; VOXELS]| {
        place.voxels().for_each(|(at, voxel)| brick[at] = value(voxel));
        brick.iter().any(|&v| v != 0.0)
    })
}

impl Scene {
    /// A volume of the stated opacities per world unit, and a light that casts shadows.
    pub fn new(
        grid: Grid,
        toward: [f64; 3],
        shadow: CastsShadow,
        opacity: impl Fn([usize; 3]) -> f32 + Send + Sync,
    ) -> Self {
        let mut world = World::new();
        let voxels = bricks(grid.size, opacity);
        let opacity = Opacity { voxels, nan_voxels: 0 };
        let volume = world.spawn((grid, opacity, OpacityUnit(1.0), Order(0)));
        let light = Light { toward: Toward::Direction(toward), strength: 1.0, color: Color::WHITE };
        let light = world.spawn((light, shadow, Order(1), Name("key".to_owned())));
        Self { world, volume, light }
    }

    pub fn unit(mut self, unit: f64) -> Self {
        self.world.insert_one(self.volume, OpacityUnit(unit)).unwrap();
        self
    }

    /// Puts a slide before the light whose middle falls on the volume's.
    pub fn projecting(mut self, mut projected: ProjectedBy) -> Self {
        let grid = *self.world.query::<&Grid>().iter().next().unwrap();
        projected.center = grid.corners().iter().sum::<DVec3>() / 8.0;
        self.world.insert_one(self.light, projected).unwrap();
        self
    }

    /// With a reader of the whole buffer.
    pub fn buffered(mut self) -> Self {
        let shaft = Shaft { opacity: 0.01, color: None, attenuated: true };
        self.world.insert_one(self.light, shaft).unwrap();
        self
    }

    pub fn try_sweep(&mut self) -> Result<LightStrength, gelray::Error> {
        let schedule = Schedule::new(&[Job::of::<LightSweep>()])?;
        schedule.run(&mut self.world, &Watch::default())?;
        Ok((*self.world.get::<&LightStrength>(self.light).unwrap()).clone())
    }

    pub fn sweep(&mut self) -> LightStrength {
        self.try_sweep().unwrap()
    }
}

/// β at a voxel.
pub fn beta(strength: &LightStrength, voxel: [usize; 3]) -> f64 {
    let strength = &strength.volumes[0].1;
    f64::from(strength.beta(strength.voxels.value(voxel), voxel))
}

/// β at a world point, without bias.
pub fn at(strength: &LightStrength, world: DVec3) -> f64 {
    {
        assert!(!strength.buffers.is_empty());
        f64::from(strength.at(world))
    }
}

pub fn voxels(size: [usize; 3]) -> impl Iterator<Item = [usize; 3]> {
    let [nx, ny, nz] = size;
    (0..nz).flat_map(move |z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])))
}

pub fn point(voxel: [usize; 3]) -> DVec3 {
    DVec3::from(voxel.map(|v| v as f64))
}

/// A number in 0..1 that looks random.
pub fn noise(seed: u64) -> f64 {
    let mut h = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    h = (h ^ (h >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    h = (h ^ (h >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((h ^ (h >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}
