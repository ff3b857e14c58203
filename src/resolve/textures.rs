//! Textures that polygons name: pictures of entities, or formulas, laid where they are stated.

use std::collections::HashMap;

use glam::{DVec2, DVec3};
use hecs::{Entity, World};

use super::carriers::{carriers, get};
use super::fault::{Fault, Notice};
use super::fill::{Became, fill, fill_from, withdraw};
use crate::components::{self, Name, Order, Polygon, Textured, Voxelize};
use crate::phantom;
use crate::polygon::texture::{Laid, Lies, MappedTexture, OwnTextures, TexturePlaces, TexturedBy};
use crate::view::picture::Picture;

/// What a texture on a polygon is made of: the statement, the texels of the entity that it names (else it names a
/// formula), and where the texture lies, if anything says.
type Named = (Textured, Option<Laid>, Option<Lies>);

/// Gives every entity that states `textured` the texture itself.
pub(super) fn fill_in(world: &mut World, notices: &mut Vec<Notice>) -> Result<(), Fault> {
    let mut formulas = HashMap::new();
    for entity in carriers::<TexturedBy>(world) {
        if stated_or_own(world, entity).is_none() {
            withdraw::<Named, TexturedBy>(world, entity);
        }
    }
    let mut all = carriers::<Textured>(world);
    all.extend(carriers::<OwnTextures>(world));
    let order = |entity| get::<Order>(world, entity);
    all.sort_by_cached_key(|&entity| (order(entity).is_none(), order(entity), entity));
    all.dedup();
    for entity in all {
        let Some((textured, is_stated)) = stated_or_own(world, entity) else { continue };
        let laid_there = match own(world, entity, &textured, is_stated) {
            Some(own) => Some(Laid::Each(own)),
            None => match carrier(world, entity, "textured", &textured.texture)? {
                Some(carrier) => texels(world, carrier, &textured)?.map(Laid::One),
                None => None,
            },
        };
        let lies = lies(world, entity, &textured);
        let named = (textured, laid_there, lies);
        let made = fill(world, entity, named, |named| laid(entity, named, &mut formulas))?;
        let voxelized = get::<Voxelize>(world, entity).is_some();
        if voxelized && made == Became::Made {
            let remedy = if is_stated { "one of the two" } else { "`voxelize`" };
            let problem = format!(
                "its texture is not shown, since `voxelize` draws it without the hybrid ray tracer; take {remedy} away"
            );
            notices.push(Notice { entity, problem });
        }
    }
    Ok(())
}

/// How an entity is textured, and whether that is stated; else as its mesh's file has it, if that says where.
fn stated_or_own(world: &World, entity: Entity) -> Option<(Textured, bool)> {
    if let Some(stated) = get::<Textured>(world, entity) {
        return Some((stated, true));
    }
    let has_own = world.get::<&OwnTextures>(entity).is_ok_and(|own| !own.all().is_empty());
    let name = get::<Name>(world, entity).map_or_else(String::new, |name| name.0);
    let textured = Textured::by(&name);
    (has_own && lies(world, entity, &textured).is_some()).then_some((textured, false))
}

/// The textures of an entity's own file, where no other is stated; a statement that names the entity says how they are laid.
fn own(world: &World, entity: Entity, textured: &Textured, is_stated: bool) -> Option<OwnTextures> {
    let own = get::<OwnTextures>(world, entity).filter(|own| !own.all().is_empty())?;
    if !is_stated {
        return Some(own);
    }
    let is_named = get::<Name>(world, entity).is_some_and(|name| name.0 == textured.texture);
    is_named.then(|| own.with(textured.wrap, textured.filter))
}

/// Where a texture lies: as stated, else by three corners of a polygon, else where a mesh's file says.
fn lies(world: &World, entity: Entity, textured: &Textured) -> Option<Lies> {
    if let Some(corners) = textured.corners {
        return Some(Lies::Corners(corners.map(DVec3::from)));
    }
    if let Some(polygon) = get::<Polygon>(world, entity)
        && let [first, second, .., last] = polygon.vertices[..]
    {
        return Some(Lies::Corners([first, second, last].map(DVec3::from)));
    }
    let places = get::<TexturePlaces>(world, entity)?;
    let is_one = |places: &[DVec2; 3]| places.iter().all(|place| place.is_finite());
    places.0.iter().any(is_one).then_some(Lies::Places(places))
}

/// The entity that a picture of that name is on; `None` for the name of a formula, and a fault of who names it for others.
pub(super) fn carrier(
    world: &World,
    entity: Entity,
    component: &'static str,
    name: &str,
) -> Result<Option<Entity>, Fault> {
    let called = |entity: &Entity| world.get::<&Name>(*entity).is_ok_and(|n| n.0 == name);
    if let Some(found) = carriers::<Picture>(world).into_iter().find(called) {
        return Ok(Some(found));
    }
    let Err(problem) = phantom::is_texture(name) else { return Ok(None) };
    let mut all = [carriers::<Picture>(world), carriers::<components::Texture>(world)].concat();
    all.sort_unstable();
    all.dedup();
    let names: Vec<_> = all.into_iter().filter_map(|e| get::<Name>(world, e)).collect();
    let names: Vec<_> = names.iter().map(|name| format!("`{}`", name.0)).collect();
    let names = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
    let problem =
        format!("no texture of the scene is called `{name}` (there are: {names}), and {problem}");
    Err(Fault::of(entity, component, "texture", problem))
}

/// The texels of an entity's picture, averaged once for all that name it.
fn texels(
    world: &mut World,
    carrier: Entity,
    textured: &Textured,
) -> Result<Option<MappedTexture>, Fault> {
    let Textured { wrap, filter, .. } = *textured;
    fill_from(world, carrier, |picture: &Picture| Ok(MappedTexture::new(picture, wrap, filter)))?;
    Ok(get::<MappedTexture>(world, carrier))
}

/// The texture of an entity, where it lies. A formula is made once for all that name it.
fn laid(
    entity: Entity,
    (textured, found, lies): &Named,
    formulas: &mut HashMap<String, MappedTexture>,
) -> Result<TexturedBy, Fault> {
    let Textured { wrap, filter, texture: name, .. } = textured;
    let laid = match (found, formulas.get(name)) {
        (Some(Laid::Each(own)), _) => Laid::Each(own.clone()),
        (Some(Laid::One(texels)), _) | (None, Some(texels)) => {
            Laid::One(texels.with(*wrap, *filter))
        }
        (None, None) => {
            let missing = |problem| Fault::of(entity, "textured", "texture", problem);
            let picture = phantom::texture(name).map_err(missing)?;
            let texture = MappedTexture::new(&picture, *wrap, *filter);
            formulas.insert(name.clone(), texture.clone());
            Laid::One(texture)
        }
    };
    let Some(lies) = lies.clone() else {
        let problem = "its mesh says nothing about where its texture lies; state `corners`";
        return Err(Fault::of(entity, "textured", "", problem));
    };
    if let Lies::Corners(corners) = &lies {
        let (across, down) = (corners[1] - corners[0], corners[2] - corners[0]);
        if across.cross(down).length() <= 1e-12 * across.length() * down.length() {
            let problem = "the corners of its texture lie on one line; state three that span it";
            return Err(Fault::of(entity, "textured", "corners", problem));
        }
    }
    Ok(TexturedBy { textured: textured.clone(), laid, lies })
}
