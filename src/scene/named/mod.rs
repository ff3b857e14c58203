//! `preset` and `colormap` of `classify` as numbers: what a name means for the values of one volume.

mod colormap;

use crate::components::{
    Classify, Color, Contour, Level, Preset, Reconstruct, Tissue, TransferPoint,
};
use crate::measure::histogram::{Histogram, histogram};
use crate::measure::sigma::sigma;
use crate::volume::grid::Scalars;

/// Bins that values are counted in.
const BINS: usize = 4096;

/// What an unsigned CT adds to Hounsfield units, so that air is not negative.
pub(super) const SHIFT: f32 = 1024.0;

/// The classification that a name stands for, and what was guessed; `None` where none is named. Colors of a projection
/// are all as opaque as the last, and contours of values are surfaces.
pub(super) fn classification(
    stated: &Classify<Level>,
    scalars: &Scalars,
    (projected, reconstruct): (bool, Reconstruct),
) -> Option<(Classify, Option<String>)> {
    if let Some(map) = stated.colormap {
        let counted = histogram(scalars, BINS);
        let (low, high) = (counted.quantile(0.01), counted.quantile(0.99));
        let window = stated.window.unwrap_or(span(low, high));
        let level = stated.level.unwrap_or(f32::midpoint(low, high));
        let peak = stated.peak_opacity.unwrap_or(if projected { 1.0 } else { 0.25 });
        let mut points = colormap::points(map, [level - window / 2.0, level + window / 2.0], peak);
        if projected {
            for point in &mut points {
                point.opacity = peak;
            }
        }
        return Some((Classify { transfer: points, ..Classify::default() }, None));
    }
    stated.preset.map(|preset| {
        let (mut made, said) = of_preset(preset, scalars);
        if reconstruct == Reconstruct::Values {
            made.iso.iter_mut().for_each(|contour| contour.thickness_voxels = 0.0);
        }
        (made, said)
    })
}

/// The least value that a preset lets see in a volume.
pub(super) fn least_seen(preset: Preset, scalars: &Scalars) -> Option<f32> {
    let (made, _) = of_preset(preset, scalars);
    let contours = made.iso.iter().map(|contour| contour.value);
    // The first point of a transfer function is the last clear one.
    let points = made.transfer.iter().skip(1).map(|point| point.value);
    // Half-way from air into skin.
    let tissues =
        made.regions.windows(2).take(1).map(|pair| f32::midpoint(pair[0].value, pair[1].value));
    contours.chain(points).chain(tissues).reduce(f32::min)
}

fn of_preset(preset: Preset, scalars: &Scalars) -> (Classify, Option<String>) {
    let counted = histogram(scalars, BINS);
    match preset {
        Preset::CtBone | Preset::CtSkin | Preset::CtLung | Preset::CtVessel => {
            let (shift, said) = shift(&counted);
            (of_ct(preset, shift), said)
        }
        Preset::MrBrain => (brain(&counted), None),
        Preset::Fluorescence => (glow(&counted), None),
        Preset::Density => (density(scalars), None),
    }
}

/// What to add to Hounsfield units, and that it was guessed.
fn shift(counted: &Histogram) -> (f32, Option<String>) {
    if counted.low < 0.0 {
        return (0.0, None);
    }
    let said = format!(
        "no value is negative, so its values are taken as Hounsfield units plus {SHIFT}; where they are not, state `classify` in numbers"
    );
    (SHIFT, Some(said))
}

fn of_ct(preset: Preset, shift: f32) -> Classify {
    let point = |hounsfield: f32, opacity: f32, color: u32| TransferPoint {
        value: hounsfield + shift,
        opacity,
        color: Some(Color::from_number(color)),
    };
    let (mut iso, mut regions, mut transfer) = (Vec::new(), Vec::new(), Vec::new());
    match preset {
        Preset::CtSkin => {
            iso = vec![Contour {
                color: Some(Color::from_number(SKIN)),
                ..Contour::at(shift - 300.0)
            }];
        }
        Preset::CtLung => {
            transfer = vec![
                point(-960.0, 0.0, LUNG),
                point(-880.0, 0.03, LUNG),
                point(-600.0, 0.05, LUNG),
                point(-450.0, 0.0, LUNG),
                point(180.0, 0.0, BONE),
                point(400.0, 0.5, BONE),
            ];
        }
        Preset::CtVessel => {
            transfer = vec![
                point(120.0, 0.0, VESSEL),
                point(180.0, 0.3, VESSEL),
                point(320.0, 0.5, VESSEL),
                point(450.0, 0.5, BONE),
                point(900.0, 0.8, BONE),
            ];
        }
        _ => regions = bone_in_skin(shift),
    }
    Classify { iso, regions, transfer, ..Classify::default() }
}

/// Boundaries and not contours: the steep way from air into skin passes the values of bone, and a contour would show it.
fn bone_in_skin(shift: f32) -> Vec<Tissue> {
    let tissues = [
        (-1000.0, 0.0, SKIN),
        (40.0, 0.07, SKIN),
        (120.0, 0.015, SKIN),
        (400.0, 0.95, BONE),
        (900.0, 0.95, BONE),
        (3000.0, 1.0, BONE),
        (32_767.0, 1.0, BONE),
    ];
    let tissue = |(hounsfield, opacity, color)| Tissue {
        value: hounsfield + shift,
        opacity,
        color: Some(Color::from_number(color)),
    };
    tissues.map(tissue).to_vec()
}

const BONE: u32 = 0xf2_e8d5;
const SKIN: u32 = 0xdf_a183;
const LUNG: u32 = 0x9f_b7c9;
const VESSEL: u32 = 0xb8_322a;

/// Gray and white matter: from the brightness that half of what is not background exceeds on up.
fn brain(counted: &Histogram) -> Classify {
    let [background, tissue] = halves(counted);
    let span = span(background, tissue);
    ramp(
        background,
        span,
        [
            (0.45, 0.0, 0x8a_6f66),
            (0.8, 0.06, 0xb0_9084),
            (1.2, 0.3, 0xd8_c2b4),
            (1.8, 0.6, 0xf4_ece4),
        ],
    )
}

/// A transfer function of points at `low` and so many spans above it: part, opacity, sRGB color.
fn ramp(low: f32, span: f32, points: [(f32, f32, u32); 4]) -> Classify {
    let transfer = points.map(|(part, opacity, color)| TransferPoint {
        value: low + part * span,
        opacity,
        color: Some(Color::from_number(color)),
    });
    Classify { transfer: transfer.to_vec(), ..Classify::default() }
}

/// How far two values are apart; where they are as good as one, so far that points between them are told apart.
fn span(low: f32, high: f32) -> f32 {
    let least = (low.abs() * 1e-3).max(1e-6);
    if high - low > least { high - low } else { least }
}

/// The mean of the voxels below the mean of all, and of those above it.
fn halves(counted: &Histogram) -> [f32; 2] {
    let mean = |from: usize, to: usize| {
        let bins = || (from..to).map(|bin| (counted.counts[bin] as f64, counted.center(bin)));
        let voxels: f64 = bins().map(|(count, _)| count).sum();
        let sum: f64 = bins().map(|(count, value)| count * f64::from(value)).sum();
        if voxels > 0.0 { (sum / voxels) as f32 } else { counted.low }
    };
    let number = counted.counts.len();
    let all = mean(0, number);
    let border = (0..number).find(|&bin| counted.center(bin) > all).unwrap_or(number);
    [mean(0, border), mean(border, number)]
}

/// From where half of the voxels are, which is background, to the brightest hundredth.
fn glow(counted: &Histogram) -> Classify {
    let (low, high) = (counted.quantile(0.5), counted.quantile(0.99));
    // Of a volume that is dark nearly everywhere the hundredth is dark too.
    let high = if high > low { high } else { counted.high };
    let span = span(low, high);
    ramp(
        low,
        span,
        [
            (0.2, 0.0, 0x0a_5c3c),
            (0.5, 0.05, 0x16_a862),
            (1.0, 0.35, 0x64_f29a),
            (2.0, 0.8, 0xea_fff0),
        ],
    )
}

/// A contour at two standard deviations above the mean.
fn density(scalars: &Scalars) -> Classify {
    let level = sigma(scalars).map_or(0.0, |found| found.level(2.0) as f32);
    let contour = Contour { color: Some(Color::from_number(0x8f_b4e3)), ..Contour::at(level) };
    Classify { iso: vec![contour], ..Classify::default() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shared::Shared;

    fn preset(preset: Preset) -> Classify<Level> {
        toml::from_str(&format!("preset = \"{}\"", preset.name())).unwrap()
    }

    fn named(stated: &Classify<Level>, values: Vec<f32>) -> (Classify, Option<String>) {
        let how = (false, Reconstruct::Colors);
        classification(stated, &Scalars::F32(Shared::new(values)), how).unwrap()
    }

    fn rising(classify: &Classify) -> bool {
        classify.transfer.windows(2).all(|pair| pair[0].value < pair[1].value)
            && classify.regions.windows(2).all(|pair| pair[0].value < pair[1].value)
    }

    #[test]
    fn skin_is_at_minus_300_hounsfield_units_with_and_without_the_shift() {
        let skin = || preset(Preset::CtSkin);
        let (signed, said) = named(&skin(), vec![-1000.0, 40.0, 900.0]);
        assert_eq!((signed.iso[0].value, said), (-300.0, None));
        let how = (false, Reconstruct::Values);
        let voxels = Scalars::F32(Shared::new(vec![-1000.0, 40.0, 900.0]));
        let (sharp, _) = classification(&skin(), &voxels, how).unwrap();
        assert_eq!((sharp.iso[0].value, sharp.iso[0].thickness_voxels), (-300.0, 0.0));
        assert!(signed.iso[0].thickness_voxels > 0.0);
        let (shifted, said) = named(&skin(), vec![0.0, 1064.0, 1924.0]);
        assert_eq!(shifted.iso[0].value, 724.0);
        assert!(said.unwrap().contains("1024"));
    }

    #[test]
    fn every_preset_makes_rising_points_of_any_values() {
        let volumes = [vec![7.0; 9], vec![f32::NAN; 3], vec![0.0, 0.0, 0.0, 1e30], vec![-1.0, 2.0]];
        for name in Preset::ALL {
            for values in &volumes {
                let (made, _) = named(&preset(name), values.clone());
                assert!(rising(&made), "{name:?} {values:?}");
                let ways = [made.iso.len(), made.regions.len(), made.transfer.len()];
                assert_eq!(ways.iter().filter(|&&points| points > 0).count(), 1, "{name:?}");
                assert!(least_seen(name, &Scalars::F32(Shared::new(values.clone()))).is_some());
            }
        }
    }

    #[test]
    fn a_window_and_a_level_place_a_color_map() {
        let stated = "colormap = \"gray\"\nlevel = 40\nwindow = 400";
        let stated = toml::from_str(stated).unwrap();
        let (made, _) = named(&stated, vec![-1000.0, 3000.0]);
        assert!(rising(&made));
        let (first, last) = (&made.transfer[0], made.transfer.last().unwrap());
        assert_eq!((first.value, first.opacity), (-160.0, 0.0));
        assert_eq!((last.value, last.opacity), (240.0, 0.25));
    }
}
