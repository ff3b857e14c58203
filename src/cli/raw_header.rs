//! `--raw`: on the command line, the header that a file of bare voxels lacks.

use gelray::formats::Stated;

/// What is stated of a headerless file, as a scene's `volume` would.
#[derive(Debug, Clone, PartialEq)]
pub struct RawHeader(pub Stated);

impl RawHeader {
    /// Reads `256x256x113,uint16,little,1x1x2`; the byte order may be left away where a number is one byte, the spacing always.
    pub fn parse(text: &str) -> Result<Self, String> {
        Self::read(text).ok_or_else(|| {
            "voxels on each axis and their type are expected, then the byte order and the spacing in mm where there are any, such as 256x256x113,uint16,little,1x1x2".to_owned()
        })
    }

    fn read(text: &str) -> Option<Self> {
        let mut parts = text.split(',').map(str::trim);
        let size = Some(three(parts.next()?)?);
        let voxel_type = Some(parts.next().filter(|name| !name.is_empty())?.to_owned());
        let mut stated = Stated { size, voxel_type, ..Stated::default() };
        for part in parts {
            if part.starts_with(|c: char| c.is_ascii_digit() || c == '-' || c == '.') {
                stated.spacing_mm = Some(three(part).filter(|_| stated.spacing_mm.is_none())?);
            } else if stated.spacing_mm.is_none() && stated.endian.is_none() {
                stated.endian = Some(part.to_owned());
            } else {
                return None;
            }
        }
        Some(Self(stated))
    }
}

/// Three numbers with an `x` between them.
fn three<T: std::str::FromStr>(text: &str) -> Option<[T; 3]> {
    let numbers: Option<Vec<T>> = text.split(['x', '×']).map(|n| n.parse().ok()).collect();
    numbers?.try_into().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_header_is_read_with_what_may_be_left_away() {
        let whole = RawHeader::parse("4x5x6,uint16,big,1x1x-2.5").unwrap().0;
        assert_eq!((whole.size, whole.spacing_mm), (Some([4, 5, 6]), Some([1.0, 1.0, -2.5])));
        assert_eq!(
            (whole.voxel_type.as_deref(), whole.endian.as_deref()),
            (Some("uint16"), Some("big"))
        );
        let short = RawHeader::parse("4x5x6,uint8").unwrap().0;
        assert_eq!((short.endian, short.spacing_mm), (None, None));
        for text in ["", "4x5", "4x5x6", "4x5x6,", "4x5x6,uint8,1x1", "4x5x6,uint8,1x1x1,little"] {
            assert!(RawHeader::parse(text).is_err(), "{text}");
        }
    }
}
