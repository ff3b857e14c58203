//! Closed forms through the whole of preparation: balls, shadows, cuts and paint.

use std::ops::Deref;

use gelray::components::{
    CastsShadow, Clip, Color, Contour, DepthCue, Form, Material, Order, Sampling, TexelKind, Toward,
};
use gelray::light::strength::{LightStrength, Receding, VoxelStrength};
use gelray::shared::Shared;
use gelray::volume::bricks::Bricks;
use gelray::volume::gel::Gel;
use gelray::volume::grid::{Grid, Painted};
use gelray::volume::layer::{Composite, Layer, LitColors, Opacity};
use glam::{Vec3, Vec4};
use hecs::{Entity, World};

use super::{
    Ball, RADIUS, ball, colors, contour, prepare, sampled, spawn_light, spawn_view, spawn_volume,
    texel, voxels,
};

/// A light's strengths in one volume.
fn lit(volume: Entity, voxels: Bricks<u16>, full: f32) -> LightStrength {
    let strength = VoxelStrength { voxels, full, receding: Receding::NONE };
    LightStrength { volumes: vec![(volume, strength)], buffers: Vec::new() }
}

#[test]
fn a_ball_is_a_shell_of_the_stated_thickness_lit_along_its_radii() {
    let Ball { mut world, volume, grid, .. } = ball();
    prepare(&mut world);
    let colors = colors(&mut world, volume);
    let opacity = world.get::<&Opacity>(volume).unwrap();
    let gel = world.get::<&Gel>(volume).unwrap();
    let Material { ambient, diffuse, .. } = Material::default();
    let mut interesting = 0;
    for (voxel, point) in voxels(&grid) {
        let alpha = opacity.voxels.value(voxel);
        // The field falls by 1 per unit, so α is 0.9 (1 − |p| off the radius / 2).
        let expected = 0.9 * (1.0 - (point.length() - RADIUS).abs() / 2.0).max(0.0);
        assert!((f64::from(alpha) - expected).abs() < 0.02, "{point}: {alpha} {expected}");
        let color = Vec3::from(colors.base.value(voxel));
        let facing = (point.z / point.length()).abs() as f32;
        if alpha > 0.0 {
            let lit = ambient + 0.5 * diffuse * facing;
            assert!(color.abs_diff_eq(Vec3::splat(lit), 0.01), "{point}: {color} {lit}");
            interesting += 1;
        } else {
            assert_eq!(color, Vec3::ZERO);
        }
        assert_eq!(texel(&gel.lit, voxel), (color * alpha).extend(alpha));
    }
    assert!(interesting > 1000);
}

#[test]
fn a_one_sided_surface_is_lit_where_it_faces_the_light() {
    let Ball { mut world, volume, grid, .. } = ball();
    let material = Material { two_sided: false, ..Material::default() };
    world.insert_one(volume, material).unwrap();
    prepare(&mut world);
    let colors = colors(&mut world, volume);
    let at = |z: usize| Vec3::from(colors.base.value([15, 15, z])).x;
    assert_eq!(grid.index_to_world.translation.z, -15.0);
    // The light stands above: the ball's top is lit, its bottom has ambient light alone.
    assert!(at(14) > 0.55 && at(1) == 0.2, "{} {}", at(14), at(1));
}

#[test]
fn ambient_light_is_kept_apart_under_a_depth_cue_and_adds_up_to_the_same() {
    let Ball { mut world, volume, view, grid, .. } = ball();
    prepare(&mut world);
    let whole = world.get::<&Gel>(volume).unwrap().lit.clone();
    world.insert_one(view, DepthCue { k1: 1.0, k2: 0.1 }).unwrap();
    prepare(&mut world);
    let gel = world.get::<&Gel>(volume).unwrap();
    let ambient = gel.ambient.as_ref().unwrap();
    for (voxel, _) in voxels(&grid) {
        let (lit, ambient) = (texel(&gel.lit, voxel), texel(ambient, voxel));
        assert_eq!(lit.w, ambient.w);
        let sum = lit.truncate() + ambient.truncate();
        assert!(sum.abs_diff_eq(texel(&whole, voxel).truncate(), 1e-6));
    }
}

#[test]
fn the_strength_of_each_light_weakens_its_own_color_in_the_order_of_the_scene() {
    let Ball { mut world, volume, light, grid, .. } = ball();
    let side = spawn_light(&mut world, 4, Toward::Direction([1.0, 0.0, 0.0]));
    world.insert_one(light, CastsShadow::default()).unwrap();
    world.insert_one(side, CastsShadow::default()).unwrap();
    prepare(&mut world);
    let unshadowed = world.get::<&Gel>(volume).unwrap().lit.clone();
    let opacity = world.get::<&Opacity>(volume).unwrap().voxels.clone();
    let quarter: Bricks<u16> = opacity.map(|_, _, made| made.fill(65535));
    world.insert_one(side, lit(volume, quarter, 0.25)).unwrap();
    prepare(&mut world);
    let colors = colors(&mut world, volume);
    let gel = world.get::<&Gel>(volume).unwrap();
    assert_eq!(colors.shadowed.len(), 2);
    for (voxel, point) in voxels(&grid) {
        let [base, above, side] = [&colors.base, &colors.shadowed[0], &colors.shadowed[1]]
            .map(|colors| Vec3::from(colors.value(voxel)));
        let alpha = opacity.value(voxel);
        let lit = texel(&gel.lit, voxel).truncate();
        assert!(lit.abs_diff_eq((base + above + 0.25 * side) * alpha, 1e-6), "{point}");
        let before = texel(&unshadowed, voxel).truncate();
        assert!(before.abs_diff_eq((base + above + side) * alpha, 1e-6));
    }
}

#[test]
fn voxels_lit_all_lights_together_are_those_that_are_lit_light_by_light() {
    let shapes = [Form::Above, Form::Around];
    for (kind, form) in [TexelKind::F32, TexelKind::U16].into_iter().zip(shapes) {
        let Ball { mut world, volume, light, view, grid } = ball();
        let red = Some(Color(Vec3::X));
        let mut classify = contour(92.0);
        classify.iso.push(Contour { color: red, form, ..contour(88.0).iso[0].clone() });
        let clip = Clip { planes: vec![[0.6, 0.0, 0.8, 3.0]], r#box: None };
        let shiny = Material { specular: 0.4, shininess: 7.5, ..Material::default() };
        world.insert(volume, (classify, clip, shiny)).unwrap();
        world.insert(view, (DepthCue { k1: 1.0, k2: 0.1 },)).unwrap();
        world.get::<&mut Sampling>(view).unwrap().texel = kind;
        let side = spawn_light(&mut world, 4, Toward::Direction([1.0, 0.3, 0.0]));
        world.insert_one(side, CastsShadow::default()).unwrap();
        spawn_light(&mut world, 5, Toward::Direction([-1.0, 0.3, 0.2]));
        world.insert_one(light, CastsShadow::default()).unwrap();
        prepare(&mut world);
        let opacity = world.get::<&Opacity>(volume).unwrap().voxels.clone();
        let part: Bricks<u16> = opacity.map(|place, _, made| {
            place.voxels().for_each(|(at, voxel)| made[at] = (voxel[0] * 2000) as u16);
        });
        world.insert_one(side, lit(volume, part, 0.75)).unwrap();
        prepare(&mut world);
        let at_once = world.get::<&Gel>(volume).unwrap().deref().clone();
        let colors = colors(&mut world, volume);
        assert_eq!(colors.shadowed.len(), 2);
        world.insert_one(volume, Composite(Layer { opacity, colors })).unwrap();
        prepare(&mut world);
        let kept = world.get::<&Gel>(volume).unwrap();
        assert_eq!(kept.lit.kind(), kind);
        // Whole numbers are parts of the brightest, which made colors tell more nearly.
        let most = if kind == TexelKind::F32 { 0.0 } else { 2.0 / 65535.0 };
        let gels = [(&at_once.lit, &kept.lit)];
        let ambient = (at_once.ambient.as_ref().unwrap(), kept.ambient.as_ref().unwrap());
        for (once, kept) in gels.into_iter().chain([ambient]) {
            let differ = |voxel| (texel(once, voxel) - texel(kept, voxel)).abs().max_element();
            assert!(voxels(&grid).all(|(voxel, _)| differ(voxel) <= most));
            assert!(voxels(&grid).filter(|(voxel, _)| texel(kept, *voxel).x > 0.0).count() > 1000);
        }
    }
}

#[test]
fn a_composite_takes_the_place_of_the_volume_s_own_colors() {
    let Ball { mut world, volume, .. } = ball();
    prepare(&mut world);
    let opacity = world.get::<&Opacity>(volume).unwrap().voxels.clone();
    let base = opacity.map(|_, _, made| made.fill([0.25, 0.5, 1.0]));
    let colors = LitColors { base: base.into(), shadowed: Vec::new(), ambient: None };
    world.insert_one(volume, Composite(Layer { opacity: opacity.clone(), colors })).unwrap();
    prepare(&mut world);
    let gel = world.get::<&Gel>(volume).unwrap();
    let alpha = opacity.value([15, 15, 14]);
    assert!(alpha > 0.0);
    let expected = Vec4::new(0.25, 0.5, 1.0, 1.0) * alpha;
    assert_eq!(texel(&gel.lit, [15, 15, 14]), expected);
}

#[test]
fn a_clip_takes_away_half_a_volume_and_half_a_painting_alike() {
    let grid = Grid::axis_aligned([24, 9, 9], [0.5, 1.0, 1.0], [0.0; 3]).unwrap();
    let clip = Clip { planes: vec![[1.0, 0.0, 0.0, 5.0]], r#box: None };
    let mut world = World::new();
    spawn_view(&mut world, &grid);
    let volume = spawn_volume(&mut world, grid, sampled(&grid, |_| 8.0), contour(8.0));
    let painted = Painted::F32(Shared::new(vec![[1.0, 1.0, 1.0, 0.9]; grid.voxels()]));
    let painting = world.spawn((Order(3), grid, painted));
    for entity in [volume, painting] {
        world.insert_one(entity, clip.clone()).unwrap();
    }
    prepare(&mut world);
    for entity in [volume, painting] {
        let gel = world.get::<&Gel>(entity).unwrap();
        for (voxel, point) in voxels(&grid) {
            let expected = 0.9 * ((5.0 - point.x) / 0.5 + 0.5).clamp(0.0, 1.0);
            assert!((f64::from(texel(&gel.lit, voxel).w) - expected).abs() < 1e-6, "{point}");
        }
    }
}

#[test]
fn painted_voxels_keep_their_colors_whatever_the_lights() {
    let grid = Grid::axis_aligned([9; 3], [1.0; 3], [0.0; 3]).unwrap();
    let mut world = World::new();
    let paint = |at: usize| if at % 9 == 4 { [255, 0, 255, 51] } else { [9, 9, 9, 0] };
    let painted = Painted::U8(Shared::new((0..grid.voxels()).map(paint).collect()));
    let entity = world.spawn((Order(0), grid, painted));
    let light = spawn_light(&mut world, 1, Toward::Direction([0.0, 0.0, 1.0]));
    let clear = Bricks::make(grid.size, |_, _| true);
    world.insert(light, (CastsShadow::default(), lit(entity, clear, 1.0))).unwrap();
    spawn_view(&mut world, &grid);
    prepare(&mut world);
    let gel = world.get::<&Gel>(entity).unwrap();
    assert_eq!(texel(&gel.lit, [4, 3, 2]), Vec4::new(0.2, 0.0, 0.2, 0.2));
    assert_eq!(texel(&gel.lit, [5, 3, 2]), Vec4::ZERO);
    assert!(gel.ambient.is_none());
}

#[test]
fn gel_is_kept_in_the_numbers_that_the_view_states() {
    let Ball { mut world, volume, view, .. } = ball();
    for kind in [TexelKind::F32, TexelKind::U16, TexelKind::U8] {
        world.get::<&mut gelray::components::Sampling>(view).unwrap().texel = kind;
        prepare(&mut world);
        let gel = world.get::<&Gel>(volume).unwrap();
        let made = match gel.lit {
            gelray::volume::gel::GelBricks::F32(_) => TexelKind::F32,
            gelray::volume::gel::GelBricks::U16(_) => TexelKind::U16,
            gelray::volume::gel::GelBricks::U8(_) => TexelKind::U8,
        };
        assert_eq!(made, kind);
    }
}
