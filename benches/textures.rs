//! What a lookup of each texture filter costs, by how many texels a pixel covers.

use divan::{Bencher, black_box};
use gelray::components::{TextureFilter, Wrap};
use gelray::polygon::texture::{Footprint, MappedTexture};
use gelray::view::picture::Picture;
use glam::DVec2;

/// Texels that the pixel is wide; it is four times as long.
const TEXELS: [f64; 4] = [0.25, 1.0, 4.0, 16.0];

fn main() {
    divan::main();
}

fn texture(filter: TextureFilter) -> MappedTexture {
    let value = |i: usize| (i * 7919 % 101) as f32 / 101.0;
    let pixels = (0..512 * 512).map(|i| [value(i), value(i + 1), value(i + 2), 1.0]).collect();
    let picture = Picture::new([512; 2], pixels).expect("a square picture");
    MappedTexture::new(&picture, Wrap::Repeat, filter)
}

fn footprint(texels: f64) -> Footprint {
    let (side, long) = (texels / 512.0, 4.0 * texels / 512.0);
    Footprint::new(DVec2::new(0.8, 0.6) * side, DVec2::new(-0.6, 0.8) * long)
}

fn lookups(bencher: Bencher, filter: TextureFilter, texels: f64) {
    let (texture, footprint) = (texture(filter), footprint(texels));
    bencher
        .counter(divan::counter::ItemsCount::new(1_u32))
        .bench(|| black_box(&texture).filtered(black_box(DVec2::new(0.3, 0.7)), &footprint));
}

#[divan::bench(args = TEXELS)]
fn average(bencher: Bencher, texels: f64) {
    let (texture, footprint) = (texture(TextureFilter::Ellipse), footprint(texels));
    bencher
        .counter(divan::counter::ItemsCount::new(1_u32))
        .bench(|| black_box(&texture).average(black_box(DVec2::new(0.3, 0.7)), &footprint));
}

#[divan::bench(args = TEXELS)]
fn ellipse(bencher: Bencher, texels: f64) {
    lookups(bencher, TextureFilter::Ellipse, texels);
}

#[divan::bench(args = TEXELS)]
fn trilinear(bencher: Bencher, texels: f64) {
    lookups(bencher, TextureFilter::Trilinear, texels);
}

#[divan::bench(args = TEXELS)]
fn bilinear(bencher: Bencher, texels: f64) {
    lookups(bencher, TextureFilter::Bilinear, texels);
}

#[divan::bench(args = TEXELS)]
fn nearest(bencher: Bencher, texels: f64) {
    lookups(bencher, TextureFilter::Nearest, texels);
}
