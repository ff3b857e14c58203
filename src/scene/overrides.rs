//! Overrides, `ENTITY.COMPONENT.KEY…=VALUE`: changes of a scene's text before it is read, so that spans stay right.

use serde_json::Value as Schema;
use toml_edit::{Array, ArrayOfTables, DocumentMut, InlineTable, Item, Table, Value};

use super::error::Text;
use super::grammar::{child, items, keys, unknown_key};
use super::nearest::{list, suggestion};
use super::parse::{entity_names, root};
use super::table::{COMPONENTS, Row, no_component};
use crate::error::SceneError;

/// The text after every override, in the order given. `file` is how sentences name the text.
///
/// A value is TOML; a bare word that is no TOML value is a string. What the schema allows and the text does not state is
/// created: an array grows by its next item, and `observer.…` creates the view that a scene may leave out.
pub(super) fn apply(file: &str, text: &str, overrides: &[String]) -> Result<String, SceneError> {
    overrides.iter().try_fold(text.to_owned(), |text, change| {
        let names = entity_names(&root(Text { file, text: &text })?);
        let mut document: DocumentMut = text.parse().map_err(|e: toml_edit::TomlError| {
            Text { file, text: &text }.error(e.span().unwrap_or(0..0), e.message())
        })?;
        one(&mut document, &names, change)
            .map_err(|problem| SceneError::of_override(change, problem))?;
        Ok(document.to_string())
    })
}

fn one(document: &mut DocumentMut, names: &[String], change: &str) -> Result<(), String> {
    let Some((path, value)) = change.split_once('=') else {
        return Err("there is no `=`; write ENTITY.COMPONENT.KEY=VALUE".to_owned());
    };
    let value = value.trim();
    let value = value.parse::<Value>().unwrap_or_else(|_| Value::from(value));
    let (name, rest) = split_name(path.trim(), names);
    let mut steps = rest.split('.').map(|step| step.trim().trim_matches(['"', '\'']));
    let component = steps.next().unwrap_or_default();
    let known: Vec<_> = COMPONENTS.iter().map(|row| row.key).collect();
    let Some(row) = Row::of(component) else {
        return Err(without_entity(document, names, name, path.trim())
            .unwrap_or_else(|| no_component(component, &known)));
    };
    let entity = entity(document, names, name, row)?;
    let steps: Vec<_> = steps.collect();
    let place = Assignment { path: row.key.to_owned(), schema: row.schema().clone() };
    let entry = entity.as_table_like_mut().ok_or("the entity is no table; write `[[entity]]`")?;
    set(entry.entry(row.key).or_insert(Item::None), &place, &steps, value)
}

/// The sentence about a path that begins with a component where an entity is meant: the entities that have it.
fn without_entity(
    document: &DocumentMut,
    names: &[String],
    component: &str,
    path: &str,
) -> Option<String> {
    let row = Row::of(component).filter(|_| names.iter().all(|name| name != component))?;
    let entities = document.get("entity").and_then(Item::as_array_of_tables);
    let has = |index: usize| entities?.get(index)?.get(row.key);
    let owners: Vec<&str> =
        (0..names.len()).filter(|&i| has(i).is_some()).map(|i| names[i].as_str()).collect();
    let owner = match owners.first() {
        Some(owner) => owner,
        None if row.key == "view" || row.key == "sampling" => "observer",
        None => return None,
    };
    let others = if owners.len() > 1 { format!(" (of {})", list(&owners)) } else { String::new() };
    Some(format!(
        "there is no entity `{component}`: that is a component of `{owner}`{others}; write {owner}.{path}"
    ))
}

/// The entity's name and the rest of the path; a name may have points in it, so known names go first, the longest before.
fn split_name<'p>(path: &'p str, names: &[String]) -> (&'p str, &'p str) {
    let named = |name: &String| {
        path.strip_prefix(name.as_str())?.strip_prefix('.').map(|rest| (name.len(), rest))
    };
    match names.iter().filter_map(named).max_by_key(|(length, _)| *length) {
        Some((length, rest)) => (&path[..length], rest),
        None => path.split_once('.').unwrap_or((path, "")),
    }
}

/// The entity's table; an observer is created if what is set belongs to a view and the scene leaves the view out.
fn entity<'d>(
    document: &'d mut DocumentMut,
    names: &[String],
    name: &str,
    row: &Row,
) -> Result<&'d mut Item, String> {
    let tables = document.entry("entity").or_insert(Item::ArrayOfTables(ArrayOfTables::new()));
    let index = match names.iter().position(|known| known == name) {
        Some(index) => index,
        None => observer(tables, names, name, row)?,
    };
    let table = tables.get_mut(index);
    table.ok_or_else(|| "`entity` must be tables, each begun by `[[entity]]`".to_owned())
}

/// Adds an observer after the other entities and tells its position; the error lists the entities that there are.
fn observer(tables: &mut Item, names: &[String], name: &str, row: &Row) -> Result<usize, String> {
    let views =
        (0..names.len()).any(|i| tables.get(i).is_some_and(|table| table.get("view").is_some()));
    let of_view = row.key == "view" || row.with.contains(&"view");
    match tables.as_array_of_tables_mut() {
        Some(tables) if name == "observer" && of_view && !views => {
            let mut table = Table::new();
            table.insert("name", Item::Value("observer".into()));
            table.insert("view", Item::Value(InlineTable::new().into()));
            table.decor_mut().set_prefix("\n");
            tables.push(table);
            Ok(tables.len() - 1)
        }
        _ => {
            let mut known: Vec<_> = names.iter().map(String::as_str).collect();
            if !views && !known.contains(&"observer") {
                known.push("observer");
            }
            Err(format!("there is no entity `{name}`; {}", suggestion(name, &known)))
        }
    }
}

/// A place in a component: its path for sentences, and what is allowed there.
struct Assignment {
    path: String,
    schema: Schema,
}

impl Assignment {
    /// What stands one step further; the error lists what would be right.
    fn step(&self, step: &str, length: usize) -> Result<Self, String> {
        let path = format!("{}.{step}", self.path);
        let inner = match (items(&self.schema), step.parse::<usize>()) {
            (Some(inner), Ok(index)) if index <= length => Some(inner),
            (Some(_), Ok(index)) => {
                return Err(format!(
                    "`{}` has {length} items, counted from 0; {index} is past its end",
                    self.path
                ));
            }
            _ => child(&self.schema, step),
        };
        match inner {
            Some(inner) => Ok(Self { path, schema: inner.clone() }),
            None if !keys(&self.schema).is_empty() => {
                Err(unknown_key(&self.path, step, &self.schema))
            }
            None if items(&self.schema).is_some() => Err(format!(
                "`{}` is an array; a number from 0 must stand in place of `{step}`",
                self.path
            )),
            None => Err(format!("`{}` is a single value; leave `.{step}` away", self.path)),
        }
    }
}

/// Follows the steps into an item, creating what is not there yet, and puts the value at their end.
fn set(item: &mut Item, place: &Assignment, steps: &[&str], value: Value) -> Result<(), String> {
    let Some((step, rest)) = steps.split_first() else {
        if !keys(&place.schema).is_empty()
            && items(&place.schema).is_none()
            && !value.is_inline_table()
        {
            let keys = list(&keys(&place.schema));
            return Err(format!(
                "`{}` is a table; set one of its keys, {keys}, or {{ key = value }}",
                place.path
            ));
        }
        let mut value = value;
        if let Some(old) = item.as_value() {
            *value.decor_mut() = old.decor().clone();
        }
        *item = Item::Value(value);
        return Ok(());
    };
    if item.is_none() {
        let array = items(&place.schema).is_some() && step.parse::<usize>().is_ok();
        let new = if array { Value::Array(Array::new()) } else { InlineTable::new().into() };
        *item = Item::Value(new);
    }
    let length = item.as_array().map(Array::len);
    let length = length.or_else(|| item.as_array_of_tables().map(ArrayOfTables::len)).unwrap_or(0);
    let next = place.step(step, length)?;
    match step.parse::<usize>() {
        Ok(index) if items(&place.schema).is_some() => {
            let inner = existing_or_new(item, index, &next).ok_or_else(|| mismatch(place))?;
            set(inner, &next, rest, value)
        }
        _ => {
            let table = item.as_table_like_mut().ok_or_else(|| mismatch(place))?;
            set(table.entry(step).or_insert(Item::None), &next, rest, value)
        }
    }
}

/// An item of an array, put in at the end if it is the next.
fn existing_or_new<'i>(
    item: &'i mut Item,
    index: usize,
    next: &Assignment,
) -> Option<&'i mut Item> {
    if item.get(index).is_none() {
        let new: Value =
            if keys(&next.schema).is_empty() { 0.into() } else { InlineTable::new().into() };
        match item {
            Item::Value(Value::Array(array)) => array.push(new),
            Item::ArrayOfTables(tables) => tables.push(Table::new()),
            _ => return None,
        }
    }
    item.get_mut(index)
}

fn mismatch(place: &Assignment) -> String {
    format!(
        "the scene states `{}` as a single value; set it whole, as VALUE or {{ key = value }}",
        place.path
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "# A head.\n[[entity]]\nname = \"head\"\nvolume = { file = \"phantom:head\" } # made\nclassify = { iso = [{ value = 1300 }] }\n\n[[entity]]\nname = \"plane\"\npolygon = { vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]] }\n";

    fn after(changes: &[&str]) -> Result<String, String> {
        let changes: Vec<_> = changes.iter().map(|&c| c.to_owned()).collect();
        apply("head.toml", HEAD, &changes).map_err(|e| e.to_string())
    }

    #[test]
    fn without_overrides_not_a_byte_changes() {
        assert_eq!(after(&[]).unwrap(), HEAD);
    }

    #[test]
    fn a_value_is_put_in_its_place_and_comments_stay() {
        let text = after(&["head.classify.iso.0.value=1200"]).unwrap();
        assert_eq!(text, HEAD.replace("1300", "1200"));
        let text = after(&["head.volume.file=phantom:ball"]).unwrap();
        assert_eq!(text, HEAD.replace("phantom:head", "phantom:ball"));
    }

    #[test]
    fn components_and_keys_that_are_not_there_are_created() {
        let text = after(&["plane.voxelize.matte=over", "plane.surface.color=#d03030"]).unwrap();
        assert!(text.contains("voxelize = { matte = \"over\" }"), "{text}");
        assert!(text.contains("surface = { color = \"#d03030\" }"), "{text}");
        let text = after(&["head.classify.iso.1.value=1.5sigma"]).unwrap();
        assert!(text.contains("value = 1300 }, { value = \"1.5sigma\" }"), "{text}");
    }

    #[test]
    fn an_observer_is_created_where_the_scene_has_no_view() {
        let text = after(&["observer.sampling.skip=none", "observer.view.azimuth=30"]).unwrap();
        let view = "[[entity]]\nname = \"observer\"\nview = { azimuth = 30 }\nsampling = { skip = \"none\" }\n";
        assert!(text.starts_with(HEAD) && text.ends_with(view), "{text}");
    }

    #[test]
    fn a_wrong_path_lists_the_right_ones() {
        let wrong = |change| after(&[change]).unwrap_err();
        assert!(
            wrong("hed.volume.file=x")
                .contains("did you mean `head`? known: `head`, `plane`, `observer`")
        );
        assert!(wrong("head.clasify.iso.0.value=1").contains("did you mean `classify`?"));
        assert!(
            wrong("head.classify.iso.0.valu=1")
                .contains("`classify.iso.0` has no key `valu`; did you mean `value`?")
        );
        assert!(wrong("head.classify.iso.7.value=1").contains("1 items"));
        assert!(wrong("head.classify.iso.first.value=1").contains("a number from 0"));
        assert!(wrong("head.volume.file.name=1").contains("single value"));
        assert!(wrong("head.volume=3").contains("set one of its keys, `center`"));
        assert!(wrong("head.volume.file").contains("no `=`"));
        assert!(wrong("=").contains("no component ``"));
    }

    #[test]
    fn entities_written_with_headings_or_inline_take_overrides_too() {
        let text = "[[entity]]\nname = \"a.b\"\n[entity.view]\nsize = [1, 2]\n";
        let changes = ["a.b.view.size.1=3".to_owned(), "a.b.sampling.stop_at=0".to_owned()];
        let text = apply("x", text, &changes).unwrap();
        assert!(
            text.contains("size = [1, 3]") && text.contains("sampling = { stop_at = 0 }"),
            "{text}"
        );
        let text =
            apply("x", "entity = [{ view = {} }]", &["observer.view.roll=3".to_owned()]).unwrap();
        assert!(text.contains("roll = 3"), "{text}");
    }
}
