//! gelray renders mixtures of volumes and polygons as colored, semi-transparent gel, after Levoy's "Rendering mixtures of
//! geometric and volumetric data" (TR88-052, 1988). A ball of gel, a polygon through it and a light, from arrays in memory:
//!
//! ```
//! use gelray::prelude::*;
//!
//! // 32³ numbers, the last axis fastest: densest in the middle, 0 at a distance of 15 world units.
//! let squares = |i: usize| [i / 1024, i / 32 % 32, i % 32].map(|n| (n as f32 - 15.5).powi(2));
//! let density = |i: usize| 15.0 - squares(i).iter().sum::<f32>().sqrt();
//! let voxels: Vec<f32> = (0..32 * 32 * 32).map(density).collect();
//!
//! let mut world = World::new();
//! let (grid, scalars) = volume(voxels, [32; 3], [1.0; 3])?;
//! world.spawn((grid, scalars, Classify::iso(4.0)));
//! let square = [[-14.0, -14.0, 0.0], [14.0, -14.0, 0.0], [14.0, 14.0, 3.0], [-14.0, 14.0, 3.0]];
//! let red = Color::from_srgb([0.9, 0.2, 0.1]);
//! world.spawn((polygon(&square)?, Surface { color: red, opacity: 0.6, ..Surface::default() }));
//! world.spawn((Light::from_direction([-0.4, -0.8, 0.5]),));
//! let picture = Renderer::new()?.render(&mut world)?.picture;
//! assert!(picture.pixel(190, 190)[3] > 0.9);
//! # Ok::<(), Error>(())
//! ```
//!
//! [`prelude`] lists what entities may carry. The rest of this page is the architecture; paper sections are §, figures by
//! number.
//!
//! # The house
//!
//! `src` holds the nouns, [`systems`] the verbs. A scene *states* [`components`]; a system *makes* exactly one
//! [product](schedule::Product) from them and from what other systems made. Nothing is changed in place.
//!
//! - **Stated.** A [`scene`] is TOML: entities (a volume, polygons, lights, textures, a view) that carry components. An
//!   option is a component too: `voxelize` on a polygon has it scan-converted instead of traced, `casts_shadow` on a light
//!   brings in the light sweep, `sampling` on the view holds every knob of accuracy. There are no global settings.
//! - **Made.** A product is carried by the entity that it was made for, immutable and shared by pointer. Its equality is
//!   identity, so comparing inputs costs nothing however large they are.
//! - **Derived order.** Each product has one maker, and a system names what it reads. From that the [`schedule`] derives
//!   its waves; two makers or a cycle are its only errors. Systems run one by one and are parallel inside.
//! - **Thrift.** [`schedule::Outbox::derive`] takes a product off where nobody asks for it, keeps it where its inputs are
//!   those of the last run, and makes it else. So a turn of the view casts rays and does nothing else, and a scene without
//!   a shadow has no light buffer, in time or memory. `gelray plan` prints what would run, and why, before it does.
//! - **Measured.** The schedule opens a span around every system; [`cost_table`](measure::cost_table) (feature `cli`) sums them to
//!   the cost table of §7, which `gelray profile` prints. Counts of rays and samples are facts about a picture and live in the product [`Samples`](view::samples::Samples).
//!
//! # The rooms
//!
//! What two stages share lives in `src`, under the thing that it is about; what one stage alone uses lives in that stage's
//! folder in `systems/`. A room names only those above it in this table, no files name each other in a circle, and no stage
//! names a file of another: a test walks the imports.
//!
//! | room | what is in it |
//! |---|---|
//! | `error` | what can go wrong, by whose fault |
//! | `shared` | arrays made once and compared by identity |
//! | `schedule` | systems, their products and their order |
//! | `components` | what a scene states |
//! | `volume` | grids, ranges, gradients, bricks, gel, pyramid, classification, clips, painted voxels |
//! | `view` | the camera, the walk of a ray, samples, compositing, the picture |
//! | `polygon` | faces, textures, what a polygon covers of voxels |
//! | `light` | shading, and how strong a light still is |
//! | `measure` | errors between pictures and how they are estimated, histograms, fronts, growth, the cost table |
//! | `formats` | a file format a file |
//! | `phantom` | volumes and textures made by formula |
//! | `resolve` | what a world leaves out, filled in |
//! | `scene` | TOML to a world of entities |
//! | `systems` | the stages, a folder each |
//! | `renderer` | the front door: a world in, a picture out |
//! | `sequence` | pictures in a row: turns, keyframes, encoding beside rendering |
//! | `prelude` | what a caller needs of all rooms |
//!
//! # The walk of a voxel
//!
//! | stage | makes | by way of |
//! |---|---|---|
//! | `scene`, `formats` | [`grid::Scalars`] in the file's own number type, [`grid::Grid`] | a file, or a [`phantom`] made by formula |
//! | `ranges` | between which scalars each brick lies, once a volume | [`ranges`] |
//! | `classify` | α_V, in [`bricks`] stored only where something is interesting; no others are looked at that [`ranges`] rules out, nor those [`buried`](volume) in what is opaque | [`gradients`], [`classification`], [`clipping`] |
//! | `scan_convert`, `matte` | c_G and α_G of polygons that state `voxelize`; α_C, and c_C a brick at a time where `relight` asks for it (§3, figure 4) | [`coverage`], [`voxel_colors`] |
//! | `light_sweep` | β of each light that casts a shadow (§4, figure 5) | [`strength`] |
//! | `relight` | [`gel`]: c_T · α and α in 8³-cell bricks (equation 4); voxels are lit on the way, light by light, and matted with what polygons send | `lit_layer`, [`gradients`] again, [`shading`]; [`painting`] for RGBA volumes |
//! | `pyramid` | which cells are interesting, and how far away the nearest is (§6) | [`pyramid`] |
//!
//! A volume that states `reconstruct = "values"` walks a shorter way: of it only `ranges` and `pyramid` are made, the bits of
//! the latter from the values of voxels around each cell ([`seen`]; a bit a voxel where no gradient counts), so that an edit of what is seen makes bits and a picture;
//! `classify` runs where a light casts shadows, and `prefilter` where [`coefficients`] of a spline are asked for.
//!
//! # The walk of a ray
//!
//! `cast` owns the rays of a view. `adaptive` casts rays on a coarse grid of the sample array, 4 × 4 positions a pixel, and
//! splits regions whose corners differ in C; below a ray a pixel only where C_G and C_A both say that an edge is seen, of a
//! polygon or a surface of values. Rays go in packets: tiles of four by four neighbours on the grid in use, or, where few
//! are wanted, those of several tiles, put together by `gathered`. `march` takes a packet through slabs ([`composite`]), splits a slab at each polygon that `polygons` finds near the ray's beam into slivers (equations
//! 2a and 2b), and stops a ray when what lies behind can add no more than ε_T. `medium` asks the [`pyramid`] how far the
//! whole packet sees nothing (and before it a `Group` of packets), `window` finds which of its rays meet gel at the next four
//! samples, all sixty-four places at once, and `kernel` samples it for them, with the widest instructions that the machine has; `values` samples a [`field`] of scalars in its place, and classifies, cuts,
//! shades and shadows it there. Of a volume alone, `slices` casts rays through its voxels where that is asked for: a row of them
//! at a time, slice by slice, since all pass a slice alike. `several` joins gels that overlap, `texture` filters what is mapped onto a
//! polygon over the ray's footprint ([`texture`], §5), and `shaft` adds the light that dust scatters (§8). Then `resample`
//! ([`view::resampling`]) integrates the sample array to the picture, and [`formats::pictures`] writes it.
//!
//! Where a view states `estimate`, `judge`, a second system of the same folder, casts a few pixels exactly, drawn as often as the
//! picture changes around them, and tells how far all of it is off ([`measure::survey`]).
//!
//! What lies over the picture, such as titles, scale bars and legends, `furnish` lays on it at its own resolution; boxes and
//! leader lines are polygons in the gel.
//!
//! For whoever looks on ([`view::viewer`]) `preview` hands out what is known so far: a few coarse pictures first, then each
//! level of the refinement, and rows of a level that is not done; the rays of the final picture are the same with and without.
//!
//! # The walk of a sequence
//!
//! A [`sequence::film::Film`] is a scene and how it moves. For each picture it states a few values as `--set` would and
//! [states](scene::Scene::restate) the scene again, but for what was read before; the components go into the one world,
//! whose products stay, so the schedule makes again what they touch. Pictures go through a bounded channel to an encoder
//! ([`sequence::pipeline`]): frames as PNGs, or a clip of [`formats::moving`]. A frame's file says what it shows, so no
//! record of what is done can be wrong, however a run ended; nothing is learned from one frame for the next, so a frame
//! depends neither on shards nor on what was rendered before it.
//!
//! # Where this differs from the paper, and why
//!
//! - **Colours are associated before they are interpolated**, and composited in linear light. Interpolating colour and
//!   opacity apart bleeds colour out of voxels that are not seen.
//! - **Samples have one global phase**: sample k lies at (k + ½) Δ from the plane through the focal point. Their places are
//!   fixed-point voxel indices ([`ray::Walk`]), affine over the picture, so that n steps at once are n steps exactly: stepping
//!   over empty gel meets the very samples that walking would have met, and pictures are equal bit for bit with the pyramid
//!   and without it, on any number of threads and with any set of instructions.
//! - **Views may be in perspective** (`field_of_view`). Depth is measured along the line of sight for every ray, so that the
//!   samples of all lie in the same planes; a slab is as thick as a ray's own way through it, and the one that the eye is in
//!   counts from the eye on. `1 / (depth + eye)` is affine over a polygon where the depth is in a parallel view.
//! - **Several volumes may overlap**, each on its grid: optical depths add and colours weigh by them
//!   ([`composite::overlap`](view::composite::overlap)), independent of their order. What comes through several of them to a
//!   voxel is the product of what comes through each, so each is swept by a light alone.
//! - **Rays go in packets of sixteen**, neighbours side by side from sample to sample; each gathers what it would alone. Voxels
//!   are classified and shaded eight side by side ([`light`]); none differs by a bit from what it would be alone.
//! - **The pyramid's upper levels are distances**: how many blocks of 4³ cells away the nearest interesting one is. A level
//!   leaps to the end of an aligned cell, a distance across all the room there is. Near what is interesting, sixteen rays are
//!   looked up at four samples at once in the bits of the cells; a bit a cell for what is near it, for all rays of a packet,
//!   was no faster.
//! - **Opacity is per unit of thickness.** A voxel's opacity is that of a slab one opacity unit thick; a sample stands for
//!   one of thickness Δ ([`composite::thicken`]). A change of Δ changes the accuracy and not the picture. The powers that this
//!   takes are made of sums, products and quotients alone, alike on every machine, for sixteen rays side by side.
//! - **Values may be interpolated in place of colors** (`reconstruct = "values"`, the better reconstruction of §8): scalars are
//!   reconstructed by the view's `filter` and classified and shaded where they are sampled, by gradients of the same filter,
//!   so that a picture which magnifies voxels stays sharp. A clip is then cut exactly, within the slab that it crosses.
//!   Shadows are approximate in one thing: the sweep reads the opacities of voxels, classified alike, and interpolates those.
//!   Colors stay the default, by measurement (`benches/sharp`): values are nearer to the truth by 1.6 to 1.9 dB, are edited
//!   sooner, and of opaque surfaces cost twice as much a frame; but of gel that rays go through, under three lights with
//!   shadows, a frame takes seven times as long (figure 11). The paper's figures keep colors in any case.
//! - **A contour of thickness 0 is a surface** of values: where a ray crosses it is found within the slab, so that it is as
//!   sharp as a polygon at any step, and its opacity is its own. A polygon in that very slab lies before it or behind it, as it does; of several surfaces in one
//!   slab that a polygon cuts, all count as where the first is. Its edges ask for rays as those of polygons do: C_A sees it lit, and C_G its normal in place of a color, so that there are
//!   more than one a pixel where it ends or hides another part of itself, and not where it bends. One of what is above its value is
//!   closed by flat faces where the volume is cut and where its grid ends, lit by their planes' normals.
//! - **Slabs of values may be integrated** (`integrate`): a transfer function is taken as the scalar goes straight from a slab's
//!   beginning to its sample and on to its end, piece by piece in closed form, so that a sharp one does not ask for short
//!   steps: at one step a voxel it is off by a fifth to a thirtieth of what middles of slabs are. Shading stays that of the sample.
//! - **A cut is shaded by its plane**, turned to the surface's own normal over a voxel under it: gradients inside the volume
//!   have nothing to do with where it was cut.
//! - **Gel bricks carry an apron.** A brick holds 8³ cells and the 9³ texels at their corners, so that a sample touches one
//!   brick. It costs 42 % of memory where all is full, and nothing where all is empty, for such bricks are not stored; it costs
//!   no light, for bricks get their aprons from those after them.
//! - **The normal is −∇f**, out of what is denser. `two_sided` materials turn it to the light.
//! - **A clip is opacity**, baked in by `classify` as a ramp one voxel wide along its normal: a cut face shows no stairs, its inside is lit
//!   and shadowed like any other gel, and the pyramid steps over what was cut away.
//! - **Scan-converted opacity is calibrated** so that a plane seen face-on has its stated opacity, in the mean over its
//!   places between voxels; `calibrated = false` gives the paper's ([`coverage`]).
//! - **Falloff divides once.** Equation 3 as printed divides by k_1 + k_2 d at every sample, which compounds with their
//!   number ([`strength`]).
//! - **Strengths are swept in columns along the light**, a sheared buffer, so that only opacities are interpolated: one of
//!   the paper's three resamplings is gone, as its §8 wishes.
//! - **A traced polygon reads its shadows outside the layer that casts its own**, or at the bias if that is farther.
//! - **Dust is modelled where light falls on it** (`shaft`): the paper gives every voxel a slight opacity, here a ray adds
//!   the light's strength times the dust's at its samples, so that the volume keeps its empty space.
//! - **Rays may go through the voxels' own lattice** (`per_voxel`; Lacroute and Levoy 1994): of a volume alone in a parallel
//!   view. Samples lie on planes across one axis, as far apart along a ray as others are, and are interpolated between eight
//!   voxels as others are; what is new is which rays there are, and that the picture is interpolated between them: a pixel is
//!   the mean over it of cubics through the rays around. What lies on a plane between two planes of voxels is found once for
//!   all the rays of a voxel. Of the painted CThead at 380², three rays a voxel took .4 of the time of a ray a pixel, at its
//!   error (44.4 dB), and 2.9 to 3.2 times that of VolPack, which samples slices of voxels (32.4 dB); two took 2.1 to 2.2 times
//!   its time, at 42.6 dB, and one 1.5 to 1.6 times, at 41.0; a ray for two voxels, in 8 bits, took its time, and was .6 dB
//!   nearer (`cargo bench --bench peers`, two runs of 36 views). Half of what rays took was waiting for texels, which are now
//!   asked for a brick ahead; to sample slices of voxels too, four texels in place of eight, gained nothing, and neither did
//!   leaving out rays beside all bricks that have anything.
//! - **Gel is kept in 16 bits** where its opacity and light allow (`texel = "auto"`): half the memory that a ray waits for.
//!   Light above 1 is kept in parts of its brightest, which lights and material bound before any voxel is lit.
//! - **The reference for texture filters is the exact mean** of square texels over a ray's parallelogram, weighed by area;
//!   ellipse, trilinear, bilinear and nearest are measured against it.
//! - **Regions that outlines of polygons cross are split to a ray a pixel from the start** (`outlines`): polygons smaller
//!   than the first grid of rays are not lost between them. Those thinner than a pixel are split to the finest there, so that
//!   what they cover does not depend on where between rays they fall; one thinner than the finest grid may still be missed.
//! - **Polygons are looked for in the picture, not in space**: all rays of a view are known, so that each face is projected
//!   once, dropped where it lies between all rays before its plane or its light is asked for, and put to the tiles of 16 × 16
//!   positions that it may be met in; of a tile that lies in a face none of its edges is asked. A hierarchy in space would be
//!   walked by every ray. Facets of a mesh are lit where they are met, few flat faces in advance.
//!   At a ray a pixel, a frame of figure 6a took 1.23 times that without its planes, and with 102,400 translucent triangles
//!   in their place, of samples a voxel apart, 3.1 times (`cargo bench --bench costs`); rays that edges ask for between
//!   pixels cost as much again.
//!
//! # What the paper leaves open, as chosen here
//!
//! - Position p of the sample array lies at p/4 of a pixel; a pixel is the integral of the bilinear interpolation between
//!   positions. `roll` turns the picture counter-clockwise.
//! - A window without a stated height just holds the silhouette of the scene's box, with 5 % free on each side, and about 12 % where
//!   a title, a legend or axes stand around it.
//! - A contour is of what is *above* its isovalue, as other programs show it; `form = "around"` is the paper's region, seen
//!   on both sides of the isovalue and so also at steep boundaries that pass it by.
//! - N = −∇f/|∇f| is one-sided. Specular light is not gated by N·L. Ambient light counts once, without a light's colour.
//! - Colours of contours weigh by their own opacity; those of regions are associated, and outside of the tissues opacity is 0.
//! - Paint in integers is sRGB, in floats linear. Paint and textures state straight alpha.
//! - Factors of several clips combine by their minimum, each a ramp one voxel wide along its own normal. The mattes `in` and
//!   `out` multiply the volume by 1 − min(1, 4/3 coverage).
//! - Columns of a sweep are anchored at the slice of entry and run along the axis nearest to the light in index space; biases
//!   count in smallest spacings; a slide is averaged over a column's cell.
//! - What comes through to a voxel of a light is kept in 16 bits, with `--exact` too: an error of 2⁻¹⁷ of the light there
//!   would be; the falloff k_1 + k_2 d is divided by where it is read.
//! - Light passes a scan-converted polygon slice by slice, and not at the samples of rays for which its opacity is calibrated:
//!   one of opacity .9 lets .091 of the light through, and not .1.
//! - Scalars are classified as 32-bit floats; where that loses digits which tell values apart, it is said.
//! - Polygons are simple, holes lie inside and do not overlap; anything else is refused, for the two methods would differ.
//!
//! # Limits
//!
//! A scene has one view, and lights are directional. In perspective, highlights and head lights are those of an observer far
//! away on the line of sight, so that voxels are shaded once. A polygon is scan-converted into, and casts its shadow in, the
//! first volume that holds its middle; none is scan-converted into values. Voxels are shaded before they are
//! interpolated, as in the paper, unless a volume states values, so that what is magnified much looks soft. Values are
//! interpolated as 32-bit floats: integers of more than 24 bits lose their last digits. A material with highlights, or a light at
//! the observer, is shaded anew for every view. Polygons are planar; meshes are polygons, whose `smooth` bends their normals and not their outlines.
//!
//! What numbers do at their extremes, each with the test that holds it:
//!
//! | what | how far | test |
//! |---|---|---|
//! | the whole way in 32 bits against a reference in 64 | 1e-6 of a ray, spacings to 1 : 100 | `hybrid::reference` |
//! | opacity of a voxel | 1e-9 to 1 − 6e-8 to every digit, 1e-12 to one in ten thousand, in 32-bit texels | `hybrid::layers`, `hybrid::extremes` |
//! | in texels of 16 and 8 bits | under half a step (8e-6, 2e-3) nothing is seen, however many layers; half a step a layer else | `hybrid::layers` |
//! | samples of a ray | a million, to 1e-6; a scene with more is refused | `hybrid::extremes` |
//! | Δ in opacity units | 1e-6 to 1e3 | `hybrid::extremes` |
//! | the world's scale | 1e-9 to 1e9, to 1e-4 of a ray; where digits no longer tell voxels apart, a sentence says so | `hybrid::scales` |
//! | its distance from the origin | a million of its voxels, to 1e-4 | `hybrid::scales` |
//! | polygons | coincident, on planes of samples or voxels, sharing edges: each met once; edge-on: not met | `hybrid::extremes`, `hybrid::watertight` |
//! | fields of view | 0.001° to 179°, from inside too; under 0.01° it is a parallel view | `hybrid::scales` |
//! | windows | 1e-9 to 1e9 world units high | `hybrid::scales` |
//!
//! A picture's own error is in the same terms: [`measure::judged`] estimates it from a few pixels, wherever a view states
//! `estimate`.
//!
//! [`texture`]: polygon::texture
//! [`coverage`]: polygon::coverage
//! [`strength`]: light::strength
//! [`shading`]: light::shading
//! [`ray::Walk`]: view::walk::Walk
//! [`composite`]: view::composite
//! [`composite::thicken`]: view::composite::thicken
//! [`pyramid`]: volume::pyramid
//! [`painting`]: volume::painting
//! [`ranges`]: volume::ranges
//! [`seen`]: volume::seen
//! [`field`]: volume::field
//! [`coefficients`]: volume::coefficients
//! [`gradients`]: volume::gradients
//! [`grid::Scalars`]: volume::grid::Scalars
//! [`grid::Grid`]: volume::grid::Grid
//! [`gel`]: volume::gel
//! [`clipping`]: volume::clipping
//! [`classification`]: volume::classification
//! [`bricks`]: volume::bricks
//! [`voxel_colors`]: volume::voxel_colors

pub mod components;
pub mod error;
pub mod formats;
pub mod light;
pub mod measure;
pub mod phantom;
pub mod polygon;
pub mod prelude;
pub mod renderer;
pub mod resolve;
pub mod scene;
pub mod schedule;
pub mod sequence;
pub mod shared;
#[path = "../systems/mod.rs"]
pub mod systems;
pub mod view;
pub mod volume;

pub use error::Error;
pub use renderer::{Rendered, Renderer};
