//! One `[[entity]]` table: what it is called, what it is, and whether its components belong together.

use std::collections::{HashMap, HashSet};

use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

use super::error::Fault;
use super::nearest::list;
use super::table::{COMPONENTS, Row, no_component};

/// The names of entities: as stated, or else what they are, numbered where that name is taken.
pub(super) fn names(tables: &[&Spanned<DeValue>]) -> Vec<String> {
    let stated = |table: &Spanned<DeValue>| {
        Some(table.get_ref().get("name")?.get_ref().as_str()?.to_owned())
    };
    let taken: HashSet<String> = tables.iter().filter_map(|t| stated(t)).collect();
    let mut unused = Unused::beside(taken);
    let name = |table: &&Spanned<DeValue>| {
        stated(table).unwrap_or_else(|| {
            let noun =
                COMPONENTS.iter().find(|r| r.is_noun() && table.get_ref().get(r.key).is_some());
            unused.take(noun.map_or(
                "entity",
                |row| {
                    if row.key == "view" { "observer" } else { row.key }
                },
            ))
        })
    };
    tables.iter().map(name).collect()
}

/// Names that are free: a word, or else the word with the least number from 2 that is not taken.
pub(super) struct Unused {
    taken: HashSet<String>,
    /// Where the search for a word's next number goes on: below it every number is taken.
    next: HashMap<&'static str, u32>,
}

impl Unused {
    /// All names but those that are taken.
    pub fn beside(taken: HashSet<String>) -> Self {
        Self { taken, next: HashMap::new() }
    }

    /// The word if it is free, else numbered; from now on it is taken.
    pub fn take(&mut self, word: &'static str) -> String {
        let next = self.next.entry(word).or_insert(1);
        loop {
            let name = if *next == 1 { word.to_owned() } else { format!("{word} {next}") };
            *next += 1;
            if self.taken.insert(name.clone()) {
                return name;
            }
        }
    }
}

/// The table of one entity, its keys checked, and the component that says what it is.
pub(super) fn checked<'r, 't>(
    value: &'r Spanned<DeValue<'t>>,
    name: &str,
) -> Result<(&'r DeTable<'t>, &'static str), Fault> {
    let Some(table) = value.get_ref().as_table() else {
        let problem = "an entity must be a table: `[[entity]]`, then a component a line";
        return Err(Fault::new(value.span(), problem));
    };
    let mut keys: Vec<_> = table.keys().collect();
    keys.sort_by_key(|key| key.span().start);
    let about = |span, problem| Fault::new(span, format!("entity `{name}`{problem}"));
    if let Some((key, problem)) = unknown(&keys) {
        return Err(about(key.span(), problem));
    }
    if let Some(stated) = table.get("name")
        && stated.get_ref().as_str().is_none_or(str::is_empty)
    {
        return Err(Fault::new(stated.span(), "`name` must be a string of at least one letter"));
    }
    let rows: Vec<_> =
        keys.iter().filter_map(|key| Some((*key, Row::of(key.get_ref())?))).collect();
    if let Some((key, row)) = rows.iter().find(|(_, row)| row.is_lonely(table)) {
        let homes = row.with.iter().map(|w| format!("`{w}`")).collect::<Vec<_>>().join(" or ");
        let problem = format!(
            " states `{}` without what it belongs to; add {homes} or take it away",
            row.key
        );
        return Err(about(key.span(), problem));
    }
    let nouns: Vec<_> = rows.iter().filter(|(_, row)| row.is_noun()).collect();
    match nouns[..] {
        [(_, row)] => Ok((table, row.key)),
        [] => {
            let all: Vec<_> = COMPONENTS.iter().filter(|r| r.is_noun()).map(|r| r.key).collect();
            Err(about(value.span(), format!(" is nothing; state one of {}", list(&all))))
        }
        [(_, first), (key, second), ..] => Err(about(
            key.span(),
            format!(" is both `{}` and `{}`; make two entities of it", first.key, second.key),
        )),
    }
}

/// The first key that is neither `name` nor a component, and the rest of a sentence about it.
fn unknown<'k, 't>(
    keys: &[&'k Spanned<DeString<'t>>],
) -> Option<(&'k Spanned<DeString<'t>>, String)> {
    let known: Vec<_> = std::iter::once("name").chain(COMPONENTS.iter().map(|r| r.key)).collect();
    let key = keys.iter().find(|key| !known.contains(&&**key.get_ref()))?;
    let word = key.get_ref();
    Some((key, format!(": {}", no_component(word, &known))))
}
