//! Where the voxels of an NRRD file are: `spacings`, or `space directions` and `space origin` in a named space.

use glam::{DAffine3, DMat3, DVec3};

use super::header::{Fields, Header};

/// From voxel index to world (LPS: +x left, +y posterior, +z superior); columns may be 0 or NaN where the file says so.
///
/// Directions and origin are converted from the space that they are stated in. Spacings alone have no direction:
/// the axes are taken as those of the world. Without an origin, the first voxel is at the world's.
pub(super) fn affine(header: &Header, warnings: &mut Vec<String>) -> Result<DAffine3, String> {
    let fields = &header.fields;
    let to_world = to_world(fields, warnings)?;
    let components = usize::from(header.painted);
    let matrix3 = match fields.get("spacedirections")? {
        Some(text) => to_world * directions(text, components)?,
        None => DMat3::from_diagonal(spacings(fields, components)?),
    };
    let translation = match fields.get("spaceorigin")? {
        Some(text) => match vectors(text, "space origin")?[..] {
            [Some(origin)] => to_world * origin,
            _ => return Err(malformed("space origin", text, "one vector (x,y,z)")),
        },
        None => DVec3::ZERO,
    };
    Ok(DAffine3 { matrix3, translation })
}

/// From the header's space to LPS.
fn to_world(fields: &Fields, warnings: &mut Vec<String>) -> Result<DMat3, String> {
    let space = fields.get("space")?.unwrap_or("").to_ascii_lowercase();
    if let Some(dimension) = fields.get("spacedimension")?
        && dimension != "3"
    {
        return Err(malformed("space dimension", dimension, "3"));
    }
    let signs = match space.as_str() {
        "" | "left-posterior-superior" | "lps" | "scanner-xyz" | "3d-right-handed" => [1, 1, 1],
        "right-anterior-superior" | "ras" => [-1, -1, 1],
        "left-anterior-superior" | "las" => [1, -1, 1],
        "3d-left-handed" => {
            warnings.push(
                "its space is 3D-left-handed: y is negated, so that nothing is mirrored".to_owned(),
            );
            [1, -1, 1]
        }
        _ => {
            return Err(malformed(
                "space",
                &space,
                "right-anterior-superior, left-anterior-superior, left-posterior-superior, scanner-xyz, 3D-right-handed or 3D-left-handed",
            ));
        }
    };
    Ok(DMat3::from_diagonal(DVec3::from(signs.map(f64::from))))
}

fn directions(text: &str, components: usize) -> Result<DMat3, String> {
    let expected = "a vector (x,y,z) for each axis of space and `none` for components";
    let found = vectors(text, "space directions")?;
    if found.len() != components + 3 || found[..components].iter().any(Option::is_some) {
        return Err(malformed("space directions", text, expected));
    }
    let column = |axis: usize| found[components + axis].unwrap_or(DVec3::NAN);
    Ok(DMat3::from_cols(column(0), column(1), column(2)))
}

fn spacings(fields: &Fields, components: usize) -> Result<DVec3, String> {
    let Some(text) = fields.get("spacings")? else { return Ok(DVec3::ONE) };
    let expected = "a number for each axis";
    let found: Vec<f64> = text
        .split_whitespace()
        .map(|word| word.parse().map_err(|_| malformed("spacings", text, expected)))
        .collect::<Result<_, _>>()?;
    if found.len() != components + 3 {
        return Err(malformed("spacings", text, expected));
    }
    Ok(DVec3::from_slice(&found[components..]))
}

/// Vectors such as `(1, 0, 0)` and, as `None`, the words `none`.
fn vectors(text: &str, field: &str) -> Result<Vec<Option<DVec3>>, String> {
    let wrong = || malformed(field, text, "vectors such as (1,0,0)");
    let mut found = Vec::new();
    let mut rest = text.trim_start();
    while !rest.is_empty() {
        if let Some(after) = rest.strip_prefix("none") {
            found.push(None);
            rest = after.trim_start();
            continue;
        }
        let (inside, after) =
            rest.strip_prefix('(').and_then(|open| open.split_once(')')).ok_or_else(wrong)?;
        let numbers: Vec<f64> = inside
            .split(',')
            .map(|word| word.trim().parse().map_err(|_| wrong()))
            .collect::<Result<_, _>>()?;
        let three: [f64; 3] = numbers.try_into().map_err(|_| wrong())?;
        found.push(Some(DVec3::from(three)));
        rest = after.trim_start();
    }
    Ok(found)
}

fn malformed(field: &str, found: &str, expected: &str) -> String {
    format!("its `{field}` is `{found}`; expected {expected}; correct the header")
}
