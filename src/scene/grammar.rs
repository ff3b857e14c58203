//! What a component's schema allows at each place, checked value by value so that every fault has its place in the text.

use std::ops::Range;

use serde_json::Value as Schema;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::error::Fault;
use super::nearest::suggestion;

/// Checks one value and all inside it: keys, types, words, lengths and ranges. `path` is how sentences name the value.
pub(super) fn check(value: &Spanned<DeValue>, schema: &Schema, path: &str) -> Result<(), Fault> {
    let branches = alternatives(schema);
    let fitting: Vec<_> = branches.iter().copied().filter(|b| fits(value.get_ref(), b)).collect();
    let Some(&branch) = fitting.first() else {
        let expected: Vec<_> = branches.iter().map(|b| describe(b)).collect();
        return Err(Fault::new(
            value.span(),
            format!("`{path}` is {}; it must be {}", found(value.get_ref()), expected.join(" or ")),
        ));
    };
    let wrong = |message| Err(Fault::new(value.span(), message));
    match value.get_ref() {
        DeValue::String(word) => match word_fault(word, &fitting, path) {
            Some(message) => wrong(message),
            None => Ok(()),
        },
        DeValue::Integer(_) | DeValue::Float(_) => {
            number_fault(number(value.get_ref()), branch, path).map_or(Ok(()), wrong)
        }
        DeValue::Array(items) => {
            if let Some(message) = length_fault(items.len(), branch, path) {
                return wrong(message);
            }
            let Some(schema) = branch.get("items") else { return Ok(()) };
            let mut items = items.iter().enumerate();
            items.try_for_each(|(i, item)| check(item, schema, &format!("{path}.{i}")))
        }
        DeValue::Table(table) => check_table(table, value.span(), branch, path),
        DeValue::Boolean(_) | DeValue::Datetime(_) => Ok(()),
    }
}

/// Checks the keys of a table, and what they hold, in the order of the text.
fn check_table(
    table: &DeTable,
    span: Range<usize>,
    schema: &Schema,
    path: &str,
) -> Result<(), Fault> {
    let mut entries: Vec<_> = table.iter().collect();
    entries.sort_by_key(|(key, _)| key.span().start);
    for (key, value) in entries {
        let name: &str = key.get_ref();
        let Some(inner) = child(schema, name) else {
            return Err(Fault::new(key.span(), unknown_key(path, name, schema)));
        };
        check(value, inner, &format!("{path}.{name}"))?;
    }
    let required = schema.get("required").and_then(Schema::as_array).into_iter().flatten();
    match required.filter_map(Schema::as_str).find(|&key| !table.contains_key(key)) {
        Some(key) => Err(Fault::new(span, format!("`{path}` needs the key `{key}`; state it"))),
        None => Ok(()),
    }
}

/// The sentence about a key that a table does not take.
pub(super) fn unknown_key(path: &str, key: &str, schema: &Schema) -> String {
    format!("`{path}` has no key `{key}`; {}", suggestion(key, &keys(schema)))
}

/// The forms that a value may have, nothing (`null`) apart.
fn alternatives(schema: &Schema) -> Vec<&Schema> {
    match ["anyOf", "oneOf"].iter().find_map(|key| schema.get(key)?.as_array()) {
        Some(branches) => branches
            .iter()
            .flat_map(alternatives)
            .filter(|b| b.get("type").is_none_or(|t| t != "null"))
            .collect(),
        None => vec![schema],
    }
}

/// The keys that a table of this schema takes.
pub(super) fn keys(schema: &Schema) -> Vec<&str> {
    let tables = alternatives(schema).into_iter();
    let properties = tables.filter_map(|b| b.get("properties")?.as_object());
    properties.flatten().map(|(key, _)| key.as_str()).collect()
}

/// The schema of what stands under a key of a table.
pub(super) fn child<'s>(schema: &'s Schema, key: &str) -> Option<&'s Schema> {
    alternatives(schema).into_iter().find_map(|b| b.get("properties")?.get(key))
}

/// The schema of the items of an array, if the schema allows an array.
pub(super) fn items(schema: &Schema) -> Option<&Schema> {
    alternatives(schema).into_iter().find_map(|b| b.get("items"))
}

/// The bytes of what stands at a dotted path inside a value, or of the deepest there is on the way.
pub(super) fn span_at(value: &Spanned<DeValue>, path: &str) -> Range<usize> {
    let mut here = value;
    for step in path.split('.').filter(|step| !step.is_empty()) {
        let next = match step.parse::<usize>() {
            Ok(index) => here.get_ref().get(index),
            Err(_) => here.get_ref().get(step),
        };
        match next {
            Some(next) => here = next,
            None => break,
        }
    }
    here.span()
}

fn has_type(schema: &Schema, kind: &str) -> bool {
    match schema.get("type") {
        Some(Schema::String(t)) => t == kind,
        Some(Schema::Array(types)) => types.iter().any(|t| t == kind),
        _ => false,
    }
}

fn fits(value: &DeValue, schema: &Schema) -> bool {
    match value {
        DeValue::String(_) => has_type(schema, "string"),
        DeValue::Integer(_) => has_type(schema, "integer") || has_type(schema, "number"),
        DeValue::Float(_) => has_type(schema, "number"),
        DeValue::Boolean(_) => has_type(schema, "boolean"),
        DeValue::Array(_) => has_type(schema, "array"),
        DeValue::Table(_) => has_type(schema, "object"),
        DeValue::Datetime(_) => false,
    }
}

fn found(value: &DeValue) -> String {
    match value {
        DeValue::String(word) => format!("the string \"{word}\""),
        DeValue::Integer(_) | DeValue::Float(_) => format!("the number {}", number(value)),
        DeValue::Boolean(truth) => format!("`{truth}`"),
        DeValue::Array(items) => format!("an array of {}", items.len()),
        DeValue::Table(_) => "a table".to_owned(),
        DeValue::Datetime(_) => "a date".to_owned(),
    }
}

fn describe(schema: &Schema) -> String {
    let length = |key| schema.get(key).and_then(Schema::as_u64);
    match schema.get("const").and_then(Schema::as_str) {
        Some(word) => format!("\"{word}\""),
        None if has_type(schema, "integer") => "a whole number".to_owned(),
        None if has_type(schema, "number") => "a number".to_owned(),
        None if has_type(schema, "boolean") => "`true` or `false`".to_owned(),
        None if has_type(schema, "object") => "a table { key = value }".to_owned(),
        None if has_type(schema, "array") => match length("minItems") {
            Some(n) if length("maxItems") == Some(n) => format!("an array of {n}"),
            _ => "an array".to_owned(),
        },
        None => schema.get("pattern").and_then(Schema::as_str).map_or_else(
            || "a string".to_owned(),
            |pattern| format!("a string of the form {pattern}"),
        ),
    }
}

fn word_fault(word: &str, fitting: &[&Schema], path: &str) -> Option<String> {
    let words: Vec<_> = fitting.iter().filter_map(|b| b.get("const")?.as_str()).collect();
    let closed = words.len() == fitting.len() && !words.contains(&word);
    closed.then(|| format!("`{path}` is never \"{word}\"; {}", suggestion(word, &words)))
}

/// The number that a value is; an integer past 128 bits is infinite.
fn number(value: &DeValue) -> f64 {
    match value {
        DeValue::Integer(n) => {
            i128::from_str_radix(n.as_str(), n.radix()).map_or(f64::INFINITY, |n| n as f64)
        }
        DeValue::Float(x) => x.as_str().parse().unwrap_or(f64::NAN),
        _ => f64::NAN,
    }
}

fn number_fault(x: f64, schema: &Schema, path: &str) -> Option<String> {
    let single = schema.get("format").is_some_and(|f| f == "float");
    if !x.is_finite() || (single && !(x as f32).is_finite()) {
        return Some(format!("`{path}` is {x}; it must be a finite number"));
    }
    let bound = |key| schema.get(key).and_then(Schema::as_f64);
    let least = [("minimum", "at least"), ("exclusiveMinimum", "above")];
    let most = [("maximum", "at most"), ("exclusiveMaximum", "below")];
    let low = least.iter().find_map(|(key, words)| Some((*key, *words, bound(key)?)));
    let high = most.iter().find_map(|(key, words)| Some((*key, *words, bound(key)?)));
    let below = low.is_some_and(|(key, _, b)| if key == "minimum" { x < b } else { x <= b });
    let above = high.is_some_and(|(key, _, b)| if key == "maximum" { x > b } else { x >= b });
    let bounds: Vec<_> =
        [low, high].iter().flatten().map(|(_, words, b)| format!("{words} {b}")).collect();
    (below || above).then(|| format!("`{path}` is {x}; it must be {}", bounds.join(" and ")))
}

fn length_fault(length: usize, schema: &Schema, path: &str) -> Option<String> {
    let bound = |key| schema.get(key).and_then(Schema::as_u64).map(|n| n as usize);
    let expected = match (bound("minItems"), bound("maxItems")) {
        (Some(n), Some(m)) if n == m => (length != n).then(|| format!("{n}")),
        (Some(n), _) if length < n => Some(format!("at least {n}")),
        (_, Some(m)) if length > m => Some(format!("at most {m}")),
        _ => None,
    };
    expected
        .map(|expected| format!("`{path}` is an array of {length}; it must be one of {expected}"))
}
