//! What a scene states: plain data, a component a key, one entity a table. No system changes any of it.
//!
//! Units are in the key or its description; colours are sRGB as written and linear once read ([`Color`]).

pub mod color;
pub mod direction;
mod knobs;

pub use color::Color;
pub use knobs::{Bound, KNOBS, Knob, NO_KNOBS, Setting};

/// Declares the files of components: a row is a file, what it makes public, and what a scene states of that: how it is read
/// (`row`, `checked` or `read_as`, of the table of the scene), its key, and the keys that it only makes sense beside.
///
/// The rows are handed on to whoever names a macro to `components!`.
macro_rules! files {
    ($($file:ident::{ $($public:ident),* } $($how:ident<$($stated:ty),*> $key:literal $with:tt)*;)*) => {
        $(mod $file;)*
        $(pub use $file::{$($public),*};)*

        macro_rules! components {
            ($then:ident) => { $then! { $($($how<$($stated),*> $key $with;)*)* } };
        }
        pub(crate) use components;
    };
}

// What an entity is first, then how that is done; messages list them in this order.
files! {
    volume::{ OpacityUnit, Reconstruct, Volume }
        checked<Volume> "volume" [];
    classify::{ Classify, Contour, Form, Level, MixtureMaterial, Tissue, TransferPoint }
        read_as<Classify<Level>, Classify> "classify" ["volume"];
    preset::{ Colormap, Preset };
    material::{ Material }
        row<Material> "material" ["volume"];
    clip::{ Clip }
        checked<Clip> "clip" ["volume"];
    projection::{ Projection }
        row<Projection> "projection" ["volume"];
    labels::{ Label, Labels }
        checked<Labels> "labels" ["volume"];
    polygon::{ Matte, Polygon, Surface, Voxelize }
        row<Polygon> "polygon" []
        row<Surface> "surface" ["polygon", "mesh", "molecule"]
        row<Voxelize> "voxelize" ["polygon", "mesh", "molecule"];
    mesh::{ Ellipsoid, Mesh, Prism, Space }
        checked<Mesh> "mesh" [];
    molecule::{ Molecule, MoleculeStyle }
        checked<Molecule> "molecule" [];
    smooth::{ Smooth, SmoothNormals }
        row<Smooth> "smooth" ["mesh", "molecule"];
    light::{ CastsShadow, Light, Observer, Shaft, Toward }
        checked<Light> "light" []
        row<CastsShadow> "casts_shadow" ["light"]
        row<Shaft> "shaft" ["light"];
    texture::{ Projects, Texture, TextureFilter, Textured, Wrap }
        checked<Texture> "texture" []
        checked<Textured> "textured" ["polygon", "mesh"]
        checked<Projects> "projects" ["light"];
    furniture::{ Axes, BoundingBox, Callout, Corner, Legend, LegendEntry, OrientationCube, ScaleBar, Title }
        row<Title> "title" []
        row<ScaleBar> "scale_bar" []
        checked<Legend> "legend" []
        row<Callout> "callout" []
        row<BoundingBox> "bounding_box" []
        row<Axes> "axes" []
        row<OrientationCube> "orientation_cube" [];
    view::{ View }
        row<View> "view" [];
    sampling::{ Filter, PixelFilter, Sampling, Skip, TexelKind }
        checked<Sampling> "sampling" ["view"];
    depth_cue::{ DepthCue }
        row<DepthCue> "depth_cue" ["view"];
    estimate::{ Estimate }
        row<Estimate> "estimate" ["view"];
    animate::{ Animate, Ease, Keyed, Track }
        checked<Animate> "animate" ["volume", "polygon", "mesh", "molecule", "light", "texture", "view"];
}

/// The name of an entity, unique in its scene.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Name(pub String);

/// The place of an entity in its scene: ties in depth are broken by it, and matting follows it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Order(pub u32);
