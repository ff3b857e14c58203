//! `mesh`: many polygons that share one surface, stated by vertices and faces or by a shape.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Many flat polygons as one entity: exactly one of `file`, `faces` (with `vertices`), `ellipsoid` or `prism`.
#[derive(Debug, Clone, PartialEq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mesh {
    /// An STL, PLY, OBJ, glTF or VTK PolyData: a path, relative to the scene's folder or to the data folder. Its triangles are
    /// flat, each of one normal, unless `smooth` is stated, and are `textured` where the file says that they lie in a texture; where vertices have colors, each triangle has the mean of its own in place of the surface's.
    /// Where the materials of a glTF or OBJ have colors, its triangles have these and their opacity (times that of the `surface`) too, and where they have pictures, these lie on them, unless `textured` states others.
    ///
    /// A triangle is as opaque as the mean alpha of its vertices (`COLOR_0` of a glTF) times its material, as `alphaMode` has it: `OPAQUE`
    /// ignores alpha, `MASK` cuts by it and `BLEND` takes it as it is. The picture of opacity of an OBJ (`map_d`) makes that of its color
    /// (`map_Kd`, else white times `Kd`) as opaque as its alpha, or, where all of that is opaque, as its stored brightness; of two of
    /// unlike sizes the one of fewer pixels is interpolated linearly to the other's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// With `file`: which way its axes run; default `lps`, as the world's, but of glTF `y-up`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub space: Option<Space>,
    /// With `file`: world units (mm) in one of its units, above 0; default 1, but of glTF, which is in meters, 1000.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub unit_mm: Option<f64>,
    /// Vertices in world coordinates.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub vertices: Vec<[f64; 3]>,
    /// Each face: at least three indices into `vertices`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faces: Vec<Vec<u32>>,
    /// A triangulated ellipsoid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ellipsoid: Option<Ellipsoid>,
    /// A closed prism.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub prism: Option<Prism>,
}

/// Which way the axes of a file of a mesh run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Space {
    /// Left, posterior, superior, as in DICOM, ITK and here.
    Lps,
    /// Right, anterior, superior, as in NIfTI and in scenes of 3D Slicer: x and y are turned over.
    Ras,
    /// Right, up, toward the observer, as in files of modelers: up becomes superior, and the front is seen.
    #[serde(rename = "y-up")]
    YUp,
}

/// An ellipsoid of `20 · 4^subdivisions` triangles, inscribed, with an optional smooth lumpiness.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ellipsoid {
    /// Centre, world.
    pub center: [f64; 3],
    /// Semi-axes along x, y and z, world units, above 0.
    pub radii: [f64; 3],
    /// 0 (an icosahedron) to 6.
    #[serde(default = "three")]
    #[schemars(range(max = 6))]
    pub subdivisions: u32,
    /// Relative height of smooth lumps, 0 (none) to 0.5: a tumour is no egg.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 0.5))]
    pub lumpiness: f64,
}

/// A prism: a regular profile swept from one point to another, closed at both ends.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Prism {
    /// Centre of the first end, world.
    pub from: [f64; 3],
    /// Centre of the last end, world.
    pub to: [f64; 3],
    /// Radius of the profile's circumscribed circle at the first end, world units.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub radius: f64,
    /// Radius at the last end; default: `radius`. A beam diverges.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub to_radius: Option<f64>,
    /// Sides of the profile, 3 to 256.
    #[serde(default = "four")]
    #[schemars(range(min = 3, max = 256))]
    pub sides: u32,
}

fn three() -> u32 {
    3
}

fn four() -> u32 {
    4
}
