//! A pixel as it would be with a ray at every position that it is made of.

use super::lanes::{LANES, Lanes, Packet, TilePlaces, each};
use super::targets::{Caster, RayColors};
use crate::components::{Color, PixelFilter};
use crate::view::picture::Picture;
use crate::view::resampling::resample;
use crate::view::samples::{Colors, Counts, Layout, POSITIONS, SampleArray};

/// Every region is split to single positions.
const ALL_SPLIT: u8 = 0b1_1111;

/// The picture of pixel `(x, y)` alone, from rays at all the positions that `filter` asks for.
pub fn exact_pixel<C: Caster>(
    caster: &C,
    [x, y]: [usize; 2],
    (filter, background): (PixelFilter, Option<Color>),
    scratch: &mut C::Scratch,
    counts: &mut Counts,
) -> Picture {
    let reach = filter.reach();
    let layout = Layout::new([1, 1], 1, reach);
    let mut array = all_open(layout);
    let (first, side) = (layout.margin - reach, 2 * reach + 1);
    let mut rays = [RayColors::default(); LANES];
    let all = side * side;
    // Row after row, sixteen at a time: tiles of four by four would be full of rays that nobody wants.
    for begin in (0..all).step_by(LANES) {
        let count = LANES.min(all - begin);
        let at = |lane: usize| [(begin + lane) % side, (begin + lane) / side];
        let place = |pixel: usize, at: usize| (pixel * POSITIONS + at) as i64 - reach as i64;
        let position = |lane: usize| [place(x, at(lane)[0]), place(y, at(lane)[1])];
        let positions: [[i64; 2]; LANES] = std::array::from_fn(position);
        let places = TilePlaces::single(&positions[..count]);
        let wanted = Lanes::MAX >> (LANES - count);
        let met = caster.cast(&Packet { places, step: 1, wanted }, &mut rays, scratch, counts);
        for lane in each(if met { wanted } else { 0 }) {
            let [i, j] = at(lane).map(|n| first + n);
            let (within, block) = layout.place(i, j);
            if within == 0 {
                array.colors.lattice[block] = rays[lane].full;
            } else {
                array.colors.fine[block][within] = rays[lane].full;
            }
        }
        counts.rays += u64::from(wanted.count_ones());
    }
    resample(&array, filter, background)
}

/// An array with a ray at every position, none of which has a color yet.
fn all_open(layout: Layout) -> SampleArray {
    let blocks: usize = layout.blocks().iter().product();
    let mut colors = Colors::new(&layout);
    colors.fine = vec![[[0.0; 4]; POSITIONS * POSITIONS]; blocks];
    SampleArray {
        layout,
        colors,
        opened: (0..blocks as u32).collect(),
        cast: vec![u16::MAX; blocks],
        splits: vec![ALL_SPLIT; blocks],
        voxel_rays: None,
        counts: Counts::default(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// White to the left of the middle of pixel (0, 0), where alone a packet meets anything.
    struct Half;

    impl Caster for Half {
        type Scratch = ();

        fn scout(&self, _: &Packet, (): &mut (), _: &mut Counts) {}

        fn cast(
            &self,
            packet: &Packet,
            rays: &mut [RayColors; LANES],
            (): &mut (),
            _: &mut Counts,
        ) -> bool {
            let is_left = |lane: usize| packet.position(lane)[0] < 0;
            let met = each(packet.wanted).any(is_left);
            for lane in each(if met { packet.wanted } else { 0 }) {
                rays[lane].full = if is_left(lane) { [1.0; 4] } else { [0.0; 4] };
            }
            met
        }
    }

    #[test]
    fn what_a_packet_does_not_meet_is_clear_whatever_the_one_before_it_saw() {
        let pixel = |x: usize| {
            let looks = (PixelFilter::Box, None);
            exact_pixel(&Half, [x, 3], looks, &mut (), &mut Counts::default()).pixels[0]
        };
        // Half of the box lies left of the middle, and a quarter of a position's way more is interpolated.
        assert!((pixel(0)[3] - 0.375).abs() < 1e-6, "{:?}", pixel(0));
        assert_eq!(pixel(1), [0.0; 4]);
    }
}
