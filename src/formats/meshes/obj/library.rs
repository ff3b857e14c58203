//! Materials of an OBJ (`.mtl`): a diffuse color and the picture that it multiplies, as lines of text.

use std::collections::HashMap;

use super::line::{argument, color_of};
use crate::components::Color;

/// A material, as far as it is read.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct ObjMaterial {
    /// `Kd`.
    pub color: Option<Color>,
    /// `map_Kd`: the picture that its color multiplies.
    pub picture: Option<PictureLine>,
    /// `map_d`: the picture of its opacity.
    pub veil: Option<PictureLine>,
    /// `d`, opaque at 1.
    opacity: Option<f64>,
    /// `Tr`, opaque at 0.
    transparency: Option<f64>,
}

/// A picture that a material names.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PictureLine {
    /// Its path as written, with `/`.
    pub name: String,
    /// Whether its outermost texels go on outside it.
    pub is_clamped: bool,
    /// What `u` and `v` are multiplied by and what is added then, `v` running up.
    pub moved: [[f64; 2]; 2],
    /// Whether it is made rough by turbulence, which is not read.
    pub is_rough: bool,
}

impl Default for PictureLine {
    fn default() -> Self {
        let (name, [is_clamped, is_rough]) = (String::new(), [false; 2]);
        Self { name, is_clamped, moved: AS_IT_IS, is_rough }
    }
}

/// Neither scaled nor shifted.
const AS_IT_IS: [[f64; 2]; 2] = [[1.0; 2], [0.0; 2]];

impl PictureLine {
    /// How it is scaled and shifted, if it is.
    pub fn moves(&self) -> Option<[[f64; 2]; 2]> {
        Some(self.moved).filter(|moved| *moved != AS_IT_IS)
    }

    /// Whether it lies where another does, and goes on outside itself likewise.
    pub fn lies_as(&self, other: &Self) -> bool {
        self.moved == other.moved && self.is_clamped == other.is_clamped
    }
}

impl ObjMaterial {
    /// How opaque all of it is, 0..=1: `d`, else 1 − `Tr`, else 1.
    pub fn opacity(&self) -> f32 {
        let opacity = self.opacity.or(self.transparency.map(|clear| 1.0 - clear));
        opacity.filter(|opacity| opacity.is_finite()).unwrap_or(1.0).clamp(0.0, 1.0) as f32
    }

    /// Whether all of it is clear by `Tr` alone, which some programs write for what is opaque.
    pub fn is_clear_by_tr(&self) -> bool {
        self.opacity.is_none() && self.opacity() <= 0.0
    }

    /// The picture that says where it lies: that of its color, else that of its opacity.
    pub fn laid(&self) -> Option<&PictureLine> {
        self.picture.as_ref().or(self.veil.as_ref())
    }

    /// The picture of its opacity where that is another than the one of its color, which has one.
    pub fn veil_apart(&self) -> Option<&PictureLine> {
        let color = self.picture.as_ref()?;
        self.veil.as_ref().filter(|veil| veil.name != color.name)
    }

    /// The color that its picture is multiplied by: programs that write black beside a picture mean the picture.
    pub fn tint(&self) -> Option<Color> {
        let is_black = |color: &Color| color.0 == glam::Vec3::ZERO;
        self.color.filter(|color| self.picture.is_none() || !is_black(color))
    }
}

/// Adds the materials of a file, by name: the lines `newmtl`, `Kd`, `d`, `Tr`, `map_Kd` and `map_d`; the rest is left out.
pub(super) fn add_materials(bytes: &[u8], materials: &mut HashMap<String, ObjMaterial>) {
    let mut name = None;
    for line in bytes.split(|&byte| byte == b'\n') {
        let line = String::from_utf8_lossy(line);
        let rest = argument(&line);
        let kind = line.split_whitespace().next().unwrap_or_default();
        if kind == "newmtl" {
            materials.insert(rest.to_owned(), ObjMaterial::default());
            name = Some(rest.to_owned());
            continue;
        }
        let Some(material) = name.as_ref().and_then(|name| materials.get_mut(name)) else {
            continue;
        };
        match kind {
            "Kd" => material.color = color(rest),
            "d" => material.opacity = last_number(rest),
            "Tr" => material.transparency = last_number(rest),
            "map_Kd" => material.picture = picture(rest),
            "map_d" => material.veil = picture(rest),
            _ => {}
        }
    }
}

/// One number for all channels or three; other ways to state a color are none.
fn color(rest: &str) -> Option<Color> {
    let numbers: Option<Vec<f64>> = rest.split_whitespace().map(|word| word.parse().ok()).collect();
    match numbers?[..] {
        [grey] => Some(color_of([grey; 3])),
        [r, g, b, ..] => Some(color_of([r, g, b])),
        _ => None,
    }
}

/// The number that ends a line, after options such as `-halo`.
fn last_number(rest: &str) -> Option<f64> {
    rest.split_whitespace().next_back()?.parse().ok()
}

/// The picture of a line of options and a name, which may have blanks in it.
fn picture(rest: &str) -> Option<PictureLine> {
    let mut found = PictureLine::default();
    let mut rest = rest;
    while rest.starts_with('-') {
        let (option, after) = rest.split_once(char::is_whitespace)?;
        let numbers = match option {
            "-s" | "-o" | "-t" => 3,
            "-mm" => 2,
            _ => 1,
        };
        rest = after.trim_start();
        for at in 0..numbers {
            let (word, after) = rest.split_once(char::is_whitespace).unwrap_or((rest, ""));
            // Of three numbers the last two may be left out, and then a name begins.
            if at > 0 && word.parse::<f64>().is_err() {
                break;
            }
            found.is_clamped |= option == "-clamp" && word == "on";
            let number = word.parse::<f64>().unwrap_or(0.0);
            match option {
                "-s" if at < 2 => found.moved[0][at] = number,
                "-o" if at < 2 => found.moved[1][at] = number,
                "-t" => found.is_rough |= number != 0.0,
                _ => {}
            }
            rest = after.trim_start();
        }
    }
    found.name = rest.trim().replace('\\', "/");
    (!found.name.is_empty()).then_some(found)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn material(text: &str) -> ObjMaterial {
        let mut materials = HashMap::new();
        add_materials(format!("newmtl a b\r\n{text}").as_bytes(), &mut materials);
        materials.remove("a b").unwrap()
    }

    #[test]
    fn options_stand_before_a_name_that_may_have_blanks() {
        for (line, name, [is_clamped, is_rough], moved) in [
            ("map_Kd a b.png", "a b.png", [false; 2], AS_IT_IS),
            ("\tmap_Kd -clamp on a.png", "a.png", [true, false], AS_IT_IS),
            ("map_Kd -s 1 2 3 -o 1 my 2.png", "my 2.png", [false; 2], [[1.0, 2.0], [1.0, 0.0]]),
            ("map_Kd -s 2 2 a.png", "a.png", [false; 2], [[2.0; 2], [0.0; 2]]),
            ("map_Kd -t 0 0 0 -o 0 .5 a.png", "a.png", [false; 2], [[1.0; 2], [0.0, 0.5]]),
            ("map_Kd -t 0 0.1 a.png", "a.png", [false, true], AS_IT_IS),
            ("map_Kd -bm 0.5 -mm 0 1 c:\\x\\a.png", "c:/x/a.png", [false; 2], AS_IT_IS),
        ] {
            let name = name.to_owned();
            let expected = Some(PictureLine { name, is_clamped, moved, is_rough });
            assert_eq!(material(line).picture, expected, "{line}");
        }
        for line in ["map_Kd", "map_Kd -s", "map_Kd -s 1", "map_Kd -clamp on"] {
            assert_eq!(material(line).picture, None, "{line}");
        }
    }

    #[test]
    fn how_opaque_a_material_is_is_told_by_d_and_else_by_tr() {
        let opacities = |lines: &[&str]| -> Vec<f32> {
            lines.iter().map(|line| material(line).opacity()).collect()
        };
        let clear = ["d 0.5", "d -halo 0.5", "Tr 0.75", "Tr 0\nd 0.9", "d -3", "Tr 1"];
        assert_eq!(opacities(&clear), [0.5, 0.5, 0.25, 0.9, 0.0, 0.0]);
        let opaque = ["d 1", "d 7", "Tr 0", "Tr 1\nd 1", "Kd 1 1 1", "d nan", "Tr inf"];
        assert_eq!(opacities(&opaque), [1.0; 7]);
    }

    #[test]
    fn black_beside_a_picture_is_no_color() {
        assert_eq!(material("Kd 0 0 0").tint(), Some(Color(glam::Vec3::ZERO)));
        assert_eq!(material("Kd 0 0 0\nmap_Kd a.png").tint(), None);
        assert_eq!(material("Kd 1\nmap_Kd a.png").tint(), Some(Color::WHITE));
        assert_eq!(material("Kd spectral a.rfl").tint(), None);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(1500))]

        #[test]
        fn changed_bytes_never_panic(
            changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
            length in 0_usize..90,
        ) {
            let text = "newmtl a\nKd 1 .5 0\nd -halo 1\nTr 0\nmap_Kd -s 1 2 -t 1 -clamp on a b.png\nmap_d -mm 0 1 c\n";
            let mut bytes = text.as_bytes()[..length.min(text.len())].to_vec();
            for (at, value) in changes.iter().filter(|_| length > 0) {
                let at = at.index(bytes.len());
                bytes[at] = *value;
            }
            add_materials(&bytes, &mut HashMap::new());
        }
    }
}
