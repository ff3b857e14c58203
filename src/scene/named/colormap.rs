//! Color maps of the field as transfer functions: eleven equal stops each, sRGB, linear in between in linear light.

use crate::components::{Color, Colormap, TransferPoint};

type Stops = [u32; 11];

const GRAY: Stops = [
    0x00_0000, 0x1a_1a1a, 0x33_3333, 0x4d_4d4d, 0x66_6666, 0x80_8080, 0x99_9999, 0xb3_b3b3,
    0xcc_cccc, 0xe6_e6e6, 0xff_ffff,
];
const VIRIDIS: Stops = [
    0x44_0154, 0x48_2475, 0x41_4487, 0x35_5f8d, 0x2a_788e, 0x21_918c, 0x22_a884, 0x44_bf70,
    0x7a_d151, 0xbd_df26, 0xfd_e725,
];
const MAGMA: Stops = [
    0x00_0004, 0x14_0e36, 0x3b_0f70, 0x64_1a80, 0x8c_2981, 0xb7_3779, 0xde_4968, 0xf7_705c,
    0xfe_9f6d, 0xfe_cf92, 0xfc_fdbf,
];
const CIVIDIS: Stops = [
    0x00_224e, 0x08_3370, 0x35_456c, 0x4f_576c, 0x66_6970, 0x7d_7c78, 0x94_8e77, 0xae_a371,
    0xc8_b866, 0xe5_cf52, 0xfe_e838,
];
const COOL_WARM: Stops = [
    0x3b_4cc0, 0x59_77e3, 0x7b_9ff9, 0x9e_beff, 0xc0_d4f5, 0xdd_dcdc, 0xf2_cbb7, 0xf7_ac8e,
    0xee_8468, 0xd6_5244, 0xb4_0426,
];

/// The colors of a map across the values `low` and `high`; the opacity rises from 0 to `peak`, linear in the value.
///
/// Of values out of the window, those below are clear and those above as the last. A window so narrow that the numbers
/// between its ends are not told apart has fewer points, still in rising order.
pub(super) fn points(map: Colormap, [low, high]: [f32; 2], peak: f32) -> Vec<TransferPoint> {
    let stops = match map {
        Colormap::Gray => GRAY,
        Colormap::Viridis => VIRIDIS,
        Colormap::Magma => MAGMA,
        Colormap::Cividis => CIVIDIS,
        Colormap::CoolWarm => COOL_WARM,
    };
    let last = (stops.len() - 1) as f32;
    let mut points: Vec<TransferPoint> = Vec::with_capacity(stops.len());
    for (i, number) in stops.into_iter().enumerate() {
        let part = i as f32 / last;
        let value = low * (1.0 - part) + high * part;
        if points.last().is_none_or(|before| before.value < value) {
            points.push(TransferPoint {
                value,
                opacity: peak * part,
                color: Some(Color::from_number(number)),
            });
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_map_spans_its_window_in_rising_order_however_narrow() {
        for map in [
            Colormap::Gray,
            Colormap::Viridis,
            Colormap::Magma,
            Colormap::Cividis,
            Colormap::CoolWarm,
        ] {
            for window in [[0.0, 1.0], [-3e38, 3e38], [1e9, 1e9 + 64.0], [5.0, 5.0]] {
                let made = points(map, window, 0.5);
                assert!(made.windows(2).all(|pair| pair[0].value < pair[1].value), "{map:?}");
                assert_eq!((made[0].value, made[0].opacity), (window[0], 0.0));
            }
            assert_eq!(points(map, [0.0, 1.0], 0.5).len(), 11);
        }
    }
}
