//! Levoy's shading model for voxels and polygons alike, with any number of directional lights (algorithm §3).

use glam::{DVec3, Vec3};
use hecs::{Entity, World};

use crate::components::direction::unit;
use crate::components::{CastsShadow, Light, Material, Order, Shaft, Surface, Toward};
use crate::view::observer;

/// How something answers light: the coefficients of the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Reflectance {
    /// k_a in 0..=1.
    pub ambient: f32,
    /// k_d in 0..=1.
    pub diffuse: f32,
    /// k_s in 0..=1.
    pub specular: f32,
    /// n, at least 1.
    pub shininess: f32,
    /// Whether the normal is turned to the light's side.
    pub two_sided: bool,
}

impl From<&Material> for Reflectance {
    fn from(m: &Material) -> Self {
        let Material { ambient, diffuse, specular, shininess, two_sided, .. } = *m;
        Self { ambient, diffuse, specular, shininess, two_sided }
    }
}

impl From<&Surface> for Reflectance {
    fn from(s: &Surface) -> Self {
        let Surface { ambient, diffuse, specular, shininess, two_sided, .. } = *s;
        Self { ambient, diffuse, specular, shininess, two_sided }
    }
}

impl Reflectance {
    /// n, if it is a whole number: most highlights have one, and then a few products in 64 bits are nearer to the power than
    /// any general one of 32, and take a tenth of the time.
    #[must_use]
    #[inline]
    pub fn whole_shininess(&self) -> Option<u32> {
        let whole = self.shininess.fract() == 0.0 && (0.0..=65536.0).contains(&self.shininess);
        whole.then_some(self.shininess as u32)
    }

    /// `glint^n` of a cosine in 0..=1, to within an ulp, alike on every machine.
    #[must_use]
    #[inline]
    pub fn glint(&self, glint: f32) -> f32 {
        let Some(mut left) = self.whole_shininess() else {
            return libm::powf(glint, self.shininess);
        };
        let (mut square, mut product) = (f64::from(glint), 1.0);
        while left > 0 {
            product *= if left & 1 == 1 { square } else { 1.0 };
            square *= square;
            left >>= 1;
        }
        product as f32
    }
}

/// A light as it falls on a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Lamp {
    /// Unit vector towards the light, world.
    pub toward: Vec3,
    /// H: the unit vector half-way between the light and the observer.
    pub half: Vec3,
    /// Linear colour times strength.
    pub light: Vec3,
}

/// The lights of a scene, in its order: those that cast no shadow, and those that do.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Lamps {
    /// Lights with β = 1 everywhere.
    pub plain: Vec<Lamp>,
    /// Lights with a strength of their own at every voxel.
    pub shadowed: Vec<(Entity, Lamp)>,
}

impl Lamps {
    /// The lights of `world` for an observer in direction `observer` (unit vector from the scene towards him).
    ///
    /// A beam that passes through the volume without attenuation lights its dust alone: without a light-strength buffer
    /// nothing says which surfaces it falls on.
    #[must_use]
    pub fn of(world: &World, observer: DVec3) -> Self {
        let mut query =
            world.query::<(Entity, &Light, &Order, Option<&CastsShadow>, Option<&Shaft>)>();
        let mut lights: Vec<_> = query.iter().collect();
        lights.sort_by_key(|(_, _, order, ..)| **order);
        let mut lamps = Self::default();
        for (entity, light, _, shadow, shaft) in lights {
            let lamp = Lamp::new(light, observer);
            if shadow.is_some() {
                lamps.shadowed.push((entity, lamp));
            } else if shaft.is_none() {
                lamps.plain.push(lamp);
            }
        }
        lamps
    }
}

impl Lamp {
    /// A light as it falls on a scene seen from direction `observer`.
    #[must_use]
    pub fn new(light: &Light, observer: DVec3) -> Self {
        let toward = toward(light, observer);
        Self {
            toward: toward.as_vec3(),
            half: (toward + observer).normalize_or_zero().as_vec3(),
            light: light.color.0 * light.strength,
        }
    }

    /// What a surface of colour `color` and unit normal `normal` reflects of this light towards the observer:
    /// `c_p (k_d max(N·L, 0) + k_s max(N·H, 0)^n)` times the light. A zero normal reflects nothing; never NaN.
    #[must_use]
    pub fn reflected(&self, color: Vec3, normal: Vec3, how: &Reflectance) -> Vec3 {
        let facing = normal.dot(self.toward);
        let side = if how.two_sided && facing < 0.0 { -1.0 } else { 1.0 };
        let diffuse = how.diffuse * (side * facing).max(0.0);
        let glint = side * normal.dot(self.half);
        let specular =
            if how.specular > 0.0 && glint > 0.0 { how.specular * how.glint(glint) } else { 0.0 };
        color * self.light * (diffuse + specular)
    }
}

/// Unit vector towards a light for an observer in direction `observer`.
#[must_use]
pub fn toward(light: &Light, observer: DVec3) -> DVec3 {
    match light.toward {
        Toward::Direction(direction) => unit(direction).unwrap_or_default(),
        Toward::Observer(_) => observer,
    }
}

/// The lights as they fall on something of this reflectance. Where the observer makes no difference he is no part of it:
/// what is lit by them need not be shaded again for another view.
#[must_use]
pub(crate) fn lamps(world: &World, how: &Reflectance) -> Lamps {
    let depends = depends_on_view(world, how);
    Lamps::of(world, if depends { observer::direction(world) } else { observer::ANYWHERE })
}

/// Whether light on something of this reflectance depends on where the observer stands: then a turn of the view shades again.
#[must_use]
pub(crate) fn depends_on_view(world: &World, how: &Reflectance) -> bool {
    let mut lights = world.query::<&Light>();
    let mut lights = lights.iter().peekable();
    (how.specular > 0.0 && lights.peek().is_some())
        || lights.any(|light| matches!(light.toward, Toward::Observer(_)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::components::{Color, Observer};

    const MATT: Reflectance = Reflectance {
        ambient: 0.2,
        diffuse: 0.8,
        specular: 0.0,
        shininess: 20.0,
        two_sided: false,
    };

    fn lamp(toward: Toward) -> Lamp {
        Lamp::new(&Light { toward, strength: 0.5, color: Color::WHITE }, DVec3::NEG_Y)
    }

    #[test]
    fn a_facing_surface_reflects_diffuse_times_strength_and_one_turned_away_nothing() {
        let lamp = lamp(Toward::Direction([0.0, 0.0, 7.0]));
        assert_eq!(lamp.reflected(Vec3::ONE, Vec3::Z, &MATT), Vec3::splat(0.4));
        assert_eq!(lamp.reflected(Vec3::ONE, -Vec3::Z, &MATT), Vec3::ZERO);
        let both = Reflectance { two_sided: true, ..MATT };
        assert_eq!(lamp.reflected(Vec3::ONE, -Vec3::Z, &both), Vec3::splat(0.4));
    }

    #[test]
    fn a_highlight_is_brightest_half_way_between_light_and_observer() {
        let lamp = lamp(Toward::Direction([0.0, 0.0, 1.0]));
        let shiny = Reflectance { diffuse: 0.0, specular: 1.0, ..MATT };
        let at = |normal: Vec3| lamp.reflected(Vec3::ONE, normal.normalize(), &shiny).x;
        assert!((at(Vec3::new(0.0, -1.0, 1.0)) - 0.5).abs() < 1e-5);
        assert!(at(Vec3::new(0.0, -0.8, 1.0)) < 0.5 && at(Vec3::ZERO.with_z(1.0)) < 0.01);
    }

    #[test]
    fn a_power_of_a_whole_exponent_is_that_of_any_exponent() {
        for base in (0..=1000_u16).map(|i| f32::from(i) / 1000.0) {
            for exponent in [1.0, 2.0, 19.0, 20.0, 20.5, 255.0, 65536.0, 1e9] {
                let exact = libm::pow(f64::from(base), f64::from(exponent));
                let power = |base| Reflectance { shininess: exponent, ..MATT }.glint(base);
                let error = (f64::from(power(base)) - exact).abs();
                assert!(error <= exact * 1e-7 + 1e-44, "{base} {exponent} {error}");
            }
        }
    }

    #[test]
    fn a_highlight_does_not_vanish_where_light_grazes_exactly() {
        // The observer looks straight at a surface that the light just grazes.
        let lamp = lamp(Toward::Direction([0.0, 0.0, 1.0]));
        let shiny = Reflectance { diffuse: 0.0, specular: 1.0, shininess: 1.0, ..MATT };
        for how in [shiny, Reflectance { two_sided: true, ..shiny }] {
            let at =
                |z: f32| lamp.reflected(Vec3::ONE, Vec3::new(0.0, -1.0, z).normalize(), &how).x;
            assert!((at(0.0) - 0.5 * 0.5_f32.sqrt()).abs() < 1e-6, "{}", at(0.0));
            assert!((at(0.0) - at(1e-6)).abs() < 1e-5);
        }
    }

    #[test]
    fn a_zero_normal_reflects_nothing_and_a_head_light_stands_at_the_observer() {
        let lamp = lamp(Toward::Observer(Observer::Observer));
        let shiny = Reflectance { specular: 1.0, ..MATT };
        assert_eq!(lamp.reflected(Vec3::ONE, Vec3::ZERO, &shiny), Vec3::ZERO);
        assert_eq!(lamp.toward, Vec3::NEG_Y);
    }

    #[test]
    fn a_beam_without_shadows_lights_no_surface() {
        let mut world = World::new();
        let toward = Toward::Direction([0.0, 0.0, 1.0]);
        let light = Light { toward, strength: 1.0, color: Color::WHITE };
        let beam = Shaft { opacity: 0.1, color: None, attenuated: false };
        world.spawn((Order(0), light.clone()));
        world.spawn((Order(1), light.clone(), beam));
        let shadowed = world.spawn((Order(2), light, beam, CastsShadow::default()));
        let lamps = Lamps::of(&world, DVec3::NEG_Y);
        assert_eq!(lamps.plain.len(), 1);
        assert_eq!(
            lamps.shadowed.iter().map(|(entity, _)| *entity).collect::<Vec<_>>(),
            [shadowed]
        );
    }
}
