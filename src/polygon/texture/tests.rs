//! What no filter may do, and wraps in closed form.

use super::*;
use TextureFilter::{Bilinear, Ellipse, Nearest, Trilinear};

const WRAPS: [Wrap; 4] = [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp, Wrap::Vanish];
const FILTERS: [TextureFilter; 4] = [Ellipse, Trilinear, Bilinear, Nearest];
const SIZES: [[usize; 2]; 7] = [[1, 1], [1, 7], [5, 1], [2, 2], [37, 23], [300, 3], [128, 128]];

fn picture(size: [usize; 2], texel: impl Fn(usize, usize) -> [f32; 4]) -> Picture {
    let texels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
    Picture::new(size, texels.map(|(x, y)| texel(x, y)).collect()).unwrap()
}

fn speckled(size: [usize; 2]) -> Picture {
    picture(size, |x, y| [0, 1, 2, 3].map(|c| ((x * 71 + y * 37 + c * 13) % 101) as f32 / 100.0))
}

fn white(size: [usize; 2]) -> Picture {
    picture(size, |_, _| [1.0; 4])
}

fn square(side: f64) -> Footprint {
    Footprint::new(DVec2::new(side, 0.0), DVec2::new(0.0, side))
}

/// Points, slivers, ordinary ones, mirror images, and what is too large or no number at all.
fn footprints() -> Vec<Footprint> {
    let sides = [
        [0.0, 0.0, 0.0, 0.0],
        [1e-9, 0.0, 0.0, 1e-12],
        [0.01, 0.003, -0.002, 0.02],
        [0.02, 0.01, 0.0, -0.03],
        [0.5, 0.5, -0.4, 0.6],
        [3.0, 1.0, 0.0, 0.0],
        [1e3, 1e3, 1e-3, -1e-3],
        [77.0, 0.0, 0.0, 55.0],
        [f64::INFINITY, 1.0, 1e300, f64::NAN],
    ];
    sides.map(|[a, b, c, d]| Footprint::new(DVec2::new(a, b), DVec2::new(c, d))).to_vec()
}

const PLACES: [[f64; 2]; 8] = [
    [0.5, 0.5],
    [0.0, 1.0],
    [0.123, 0.987],
    [-1e-18, 0.3],
    [-0.7, 1.9],
    [1e6, -1e6],
    [123_456.789, 0.25],
    [f64::NAN, f64::NEG_INFINITY],
];

/// Calls `check` with each result of every filter, wrap, place and footprint, and with what they were.
fn everywhere(picture: &Picture, check: impl Fn(Vec4, Wrap, String)) {
    for wrap in WRAPS {
        for footprint in footprints() {
            for uv in PLACES.map(DVec2::from) {
                let texture = MappedTexture::new(picture, wrap, Ellipse);
                let what = format!("{:?} {wrap:?} {uv} {footprint:?}", picture.size);
                check(texture.average(uv, &footprint), wrap, format!("average {what}"));
                for filter in FILTERS {
                    let found = texture.with(wrap, filter).filtered(uv, &footprint);
                    check(found, wrap, format!("{filter:?} {what}"));
                }
            }
        }
    }
}

/// Calls `check` with each result of a texture at every place and footprint, by each filter, and with what they were.
fn everywhere_of(texture: &MappedTexture, check: impl Fn(Vec4, String)) {
    for (footprint, uv) in
        footprints().into_iter().flat_map(|footprint| PLACES.map(|uv| (footprint, uv)))
    {
        let uv = DVec2::from(uv);
        check(texture.average(uv, &footprint), format!("average {uv} {footprint:?}"));
        for filter in FILTERS {
            let texture = MappedTexture { filter, ..texture.clone() };
            check(texture.filtered(uv, &footprint), format!("{filter:?} {uv} {footprint:?}"));
        }
    }
}

#[test]
fn results_lie_among_the_texels_whatever_is_asked() {
    for size in SIZES {
        let picture = speckled(size);
        let texels = || picture.pixels.iter().map(|&t| Vec4::from(t));
        let (low, high) =
            (texels().reduce(Vec4::min).unwrap(), texels().reduce(Vec4::max).unwrap());
        everywhere(&picture, |found, wrap, what| {
            let low = if wrap == Wrap::Vanish { Vec4::ZERO } else { low };
            let hull = found.cmpge(low - 1e-6).all() && found.cmple(high + 1e-6).all();
            assert!(found.is_finite() && hull, "{what}: {found} not in {low}..{high}");
            assert!((0.0..=1.0).contains(&found.w), "{what}: opacity {}", found.w);
        });
    }
}

#[test]
fn a_constant_is_preserved_to_a_millionth_and_one_vanishing_keeps_its_hue() {
    let colour = Vec4::new(0.3, 0.2, 0.1, 0.7);
    for size in SIZES {
        everywhere(&picture(size, |_, _| colour.to_array()), |found, wrap, what| {
            let part = if wrap == Wrap::Vanish { found.w / colour.w } else { 1.0 };
            assert!(found.abs_diff_eq(colour * part, 1e-6), "{what}: {found}");
        });
    }
}

#[test]
fn what_vanishes_counts_by_the_area_that_the_texture_shares_with_the_footprint() {
    let found = |size, uv: [f64; 2], side| {
        let texture = MappedTexture::new(&white(size), Wrap::Vanish, Ellipse);
        texture.average(DVec2::from(uv), &square(side)).w
    };
    for size in [[1, 1], [64, 64], [100, 7], [300, 300]] {
        for (uv, side, part) in [
            ([0.5, 0.5], 1.0, 1.0),
            ([0.5, 0.5], 4.0, 1.0 / 16.0),
            ([0.5, 0.5], 1e4, 1e-8),
            ([0.0, 0.0], 1.0, 0.25),
            ([1.25, 0.5], 1.0, 0.25),
            ([1.5, 0.5], 1.0, 0.0),
            ([1e6, 0.5], 1.0, 0.0),
        ] {
            let error = (found(size, uv, side) - part).abs();
            assert!(error < 1e-6, "{size:?} {uv:?} {side}: off by {error}");
        }
    }
    let diamond = Footprint::new(DVec2::new(1.0, 1.0), DVec2::new(-1.0, 1.0));
    let texture = MappedTexture::new(&white([64, 64]), Wrap::Vanish, Ellipse);
    assert!((texture.average(DVec2::splat(0.5), &diamond).w - 0.5).abs() < 1e-6);
    assert!((texture.average(DVec2::new(1.0, 0.5), &diamond).w - 0.375).abs() < 1e-6);
}

#[test]
fn what_is_mirrored_is_a_picture_of_itself_and_its_mirror_images_that_repeats() {
    for size in [[16, 8], [1, 4], [64, 32]] {
        let own = speckled(size);
        let fold = |x: usize, n: usize| x.min(2 * n - 1 - x);
        let whole = picture([2 * size[0], 2 * size[1]], |x, y| {
            own.pixel(fold(x, size[0]), fold(y, size[1]))
        });
        let mirrored = MappedTexture::new(&own, Wrap::Mirror, Ellipse);
        let repeated = MappedTexture::new(&whole, Wrap::Repeat, Ellipse);
        for side in [0.0, 0.03, 0.4, 1.7] {
            for uv in [[0.3, 0.8], [1.2, 0.1], [-0.4, 1.9], [7.7, -5.3], [1.0, -1.0]] {
                let uv = DVec2::from(uv);
                let sides = [DVec2::new(side, 0.1 * side), DVec2::new(-0.2 * side, side)];
                let footprint = |part: f64| Footprint::new(sides[0] * part, sides[1] * part);
                let near = |a: Vec4, b: Vec4| a.abs_diff_eq(b, 1e-5);
                let what = format!("{size:?} {side} {uv}");
                let average = repeated.average(uv / 2.0, &footprint(0.5));
                assert!(near(mirrored.average(uv, &footprint(1.0)), average), "{what}");
                for filter in FILTERS {
                    let a = mirrored.with(Wrap::Mirror, filter).filtered(uv, &footprint(1.0));
                    let b = repeated.with(Wrap::Repeat, filter).filtered(uv / 2.0, &footprint(0.5));
                    assert!(near(a, b), "{filter:?} {what}: {a} {b}");
                }
            }
        }
    }
}

#[test]
fn a_texture_may_go_on_in_one_way_to_its_sides_and_in_another_above_and_below() {
    let (own, size) = (speckled([16, 8]), [16, 8]);
    let ways = [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp];
    for wrap in ways.into_iter().flat_map(|across| ways.map(|down| [across, down])) {
        let texture = MappedTexture::new(&own, Wrap::Repeat, Bilinear).wrapping(wrap);
        // What that is, laid out: three textures across and three down, and what is asked for in the middle.
        let index = |at: usize, axis: usize| {
            wrap[axis].texel(at as i64 - size[axis] as i64, size[axis]).unwrap()
        };
        let whole = picture([48, 24], |x, y| own.pixel(index(x, 0), index(y, 1)));
        let whole = MappedTexture::new(&whole, Wrap::Clamp, Bilinear);
        for (side, uv) in [0.0, 0.05, 0.4].into_iter().flat_map(|side| {
            [[0.3, 0.8], [1.2, 0.1], [-0.4, 1.3], [1.5, -0.3], [0.0, 1.0]].map(|uv| (side, uv))
        }) {
            let uv = DVec2::from(uv);
            let footprint = |part: f64| square(side * part);
            let within = (uv + 1.0) / 3.0;
            let what = format!("{wrap:?} {side} {uv}");
            let a = texture.average(uv, &footprint(1.0));
            assert!(a.abs_diff_eq(whole.average(within, &footprint(1.0 / 3.0)), 1e-5), "{what}");
            for filter in [Ellipse, Bilinear, Nearest] {
                let as_is = |texture: &MappedTexture| MappedTexture { filter, ..texture.clone() };
                let a = as_is(&texture).filtered(uv, &footprint(1.0));
                let b = as_is(&whole).filtered(within, &footprint(1.0 / 3.0));
                assert!(a.abs_diff_eq(b, 1e-5), "{filter:?} {what}: {a} {b}");
            }
        }
        everywhere_of(&texture, |found, what| {
            assert!(found.is_finite() && (0.0..=1.0).contains(&found.w), "{what}");
        });
    }
    let vanishing = MappedTexture::new(&own, Wrap::Repeat, Ellipse);
    let vanishing = vanishing.wrapping([Wrap::Vanish, Wrap::Clamp]);
    assert_eq!(vanishing, vanishing.with(Wrap::Vanish, Ellipse));
}

#[test]
fn a_border_that_vanishes_fades_over_a_texel() {
    let texture = MappedTexture::new(&white([8, 8]), Wrap::Vanish, Ellipse);
    for filter in [Ellipse, Trilinear, Bilinear] {
        let texture = texture.with(Wrap::Vanish, filter);
        let at = |texels: f64| texture.filtered(DVec2::new(texels / 8.0, 0.5), &square(0.0)).w;
        assert!((at(0.0) - 0.5).abs() < 1e-6, "{filter:?}");
        assert!(at(0.25) > 0.6 && at(0.25) < 0.9 && at(-0.25) < 0.4 && at(-0.25) > 0.1);
        assert!(at(-2.0) == 0.0 && (at(2.0) - 1.0).abs() < 1e-6);
    }
    assert_eq!(texture.average(DVec2::new(0.25 / 8.0, 0.5), &square(0.0)).w, 0.75);
}

#[test]
fn a_clamped_footprint_past_the_border_is_filled_with_the_outermost_texels() {
    let ramp = picture([4, 1], |x, _| [x as f32 / 3.0, 0.0, 0.0, 1.0]);
    let texture = MappedTexture::new(&ramp, Wrap::Clamp, Ellipse);
    let red = |u: f64, side| texture.average(DVec2::new(u, 0.5), &square(side)).x;
    assert!((red(1.0, 1.0) - (2.0 * 1.0 + 2.0 / 3.0 + 1.0) / 4.0).abs() < 1e-6);
    assert!((red(0.5, 3.0) - 0.5).abs() < 1e-6);
    assert!((red(0.0, 1e6) - 0.5).abs() < 1e-4);
    assert!((red(1e6, 7.0) - 1.0).abs() < 1e-6);
    assert_eq!(red(-5.0, 0.0), 0.0);
}

#[test]
fn a_repeated_texture_is_the_same_one_texture_on() {
    let texture = MappedTexture::new(&speckled([64, 16]), Wrap::Repeat, Ellipse);
    for filter in FILTERS {
        let texture = texture.with(Wrap::Repeat, filter);
        for uv in [[0.25, 0.125], [0.015_625, 0.75]].map(DVec2::from) {
            let at = |shift| texture.filtered(uv + DVec2::from(shift), &square(0.1));
            assert_eq!(at([0.0, 0.0]), at([3.0, -7.0]), "{filter:?}");
            assert_eq!(at([0.0, 0.0]), at([1e6, 1e6]), "{filter:?}");
        }
    }
}

#[test]
fn at_one_texel_a_pixel_a_texture_is_copied_and_between_texels_it_is_bilinear() {
    let texture = MappedTexture::new(&speckled([16, 16]), Wrap::Repeat, Bilinear);
    let texel = square(1.0 / 16.0);
    for i in 0..64 {
        let uv = DVec2::new(f64::from(i) * 0.013, f64::from(i) * 0.029);
        let centre = ((uv * 16.0).floor() + 0.5) / 16.0;
        let copied = texture.with(Wrap::Repeat, Nearest).filtered(uv, &texel);
        assert!(texture.average(centre, &texel).abs_diff_eq(copied, 1e-6));
        for footprint in [texel, square(0.0), square(0.01)] {
            let bilinear = texture.filtered(uv, &footprint);
            assert!(texture.average(uv, &footprint).abs_diff_eq(bilinear, 1e-6));
        }
    }
}

#[test]
fn an_average_is_the_mean_of_its_quarters_and_levels_hardly_change_it() {
    let texture = MappedTexture::new(&speckled([256, 192]), Wrap::Repeat, Ellipse);
    let (across, down) = (DVec2::new(0.11, 0.05), DVec2::new(-0.02, 0.13));
    for (scale, bound) in [(1.0, 1e-6), (8.0, 2e-3)] {
        let (p, q) = (across * scale, down * scale);
        let part = Footprint::new(p / 4.0, q / 4.0);
        let parts = (0..16).map(|i| {
            let place = DVec2::new(f64::from(i % 4), f64::from(i / 4)) / 4.0 - 0.375;
            texture.average(DVec2::new(0.3, 0.6) + p * place.x + q * place.y, &part)
        });
        let whole = texture.average(DVec2::new(0.3, 0.6), &Footprint::new(p, q));
        let mean = parts.sum::<Vec4>() / 16.0;
        assert!(whole.abs_diff_eq(mean, bound), "{scale}: {whole} {mean}");
    }
}
