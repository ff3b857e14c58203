//! Zarr's metadata: files of JSON, and what their keys hold.

use std::path::Path;

use serde_json::Value;

use crate::formats::stream::Stream;

/// The longest file of metadata that is read, bytes: the root of a group may hold those of all its arrays.
const LONGEST: u64 = 64 << 20;

/// The object in a file of a folder; `None` where there is no such file.
pub(super) fn read(folder: &Path, name: &str) -> Result<Option<Value>, String> {
    let path = folder.join(name);
    if !path.exists() {
        return Ok(None);
    }
    let wrong = |problem: String| format!("its `{}` {problem}", path.display());
    let mut stream = Stream::open(&path).map_err(wrong)?;
    if stream.must_hold(LONGEST + 1, "").is_ok() {
        return Err(wrong(format!("is longer than {LONGEST} bytes; keep metadata alone in it")));
    }
    let bytes = stream.rest().map_err(wrong)?;
    match serde_json::from_slice(&bytes) {
        Ok(value @ Value::Object(_)) => Ok(Some(value)),
        Ok(_) => Err(wrong("is no object of JSON; write the array again".to_owned())),
        Err(error) => Err(wrong(format!("is not JSON ({error}); write the array again"))),
    }
}

/// Whole numbers of a key, one for each axis.
pub(super) fn whole_numbers(value: &Value, key: &str) -> Result<Vec<usize>, String> {
    let numbers = value.get(key).and_then(Value::as_array);
    let whole = |number: &Value| number.as_u64().and_then(|number| number.try_into().ok());
    let numbers = numbers.and_then(|numbers| numbers.iter().map(whole).collect());
    numbers.ok_or_else(|| {
        let found = value.get(key).map_or("absent".to_owned(), short);
        format!("its `{key}` is {found}, and whole numbers are expected; correct it")
    })
}

/// The text of a key.
pub(super) fn text<'v>(value: &'v Value, key: &str) -> Result<&'v str, String> {
    value.get(key).and_then(Value::as_str).ok_or_else(|| {
        let found = value.get(key).map_or("absent".to_owned(), short);
        format!("its `{key}` is {found}, and a text is expected; correct it")
    })
}

/// The list of a key; none where there is no such key, or `null`.
pub(super) fn list<'v>(value: &'v Value, key: &str) -> &'v [Value] {
    value.get(key).and_then(Value::as_array).map_or(&[], Vec::as_slice)
}

/// A value for a sentence: its first letters.
pub(super) fn short(value: &Value) -> String {
    let text = value.to_string();
    if text.chars().count() <= 60 {
        text
    } else {
        text.chars().take(60).chain("…".chars()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn what_a_key_does_not_hold_is_said() {
        let value = json!({ "shape": [3, 4], "wrong": [3, -4], "name": 5 });
        assert_eq!(whole_numbers(&value, "shape"), Ok(vec![3, 4]));
        for (key, said) in [("wrong", "[3,-4]"), ("nothing", "absent"), ("name", "is 5")] {
            let problem = whole_numbers(&value, key).unwrap_err();
            assert!(problem.contains(said), "{problem}");
        }
        assert!(text(&value, "name").unwrap_err().contains("a text is expected"));
        assert!(list(&value, "nothing").is_empty());
        assert!(short(&json!("long".repeat(99))).ends_with('…'));
    }
}
