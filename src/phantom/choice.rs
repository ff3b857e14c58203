//! Things made by formula are chosen by name.

/// The entry of a table called `name`, or a sentence that lists the names of its `kind`.
pub(super) fn choose<T: Copy>(table: &[(&str, T)], name: &str, kind: &str) -> Result<T, String> {
    let found = table.iter().find(|(known, _)| *known == name);
    found.map(|(_, made)| *made).ok_or_else(|| {
        let known: Vec<_> = table.iter().map(|(known, _)| format!("`{known}`")).collect();
        format!("there is no {kind} `{name}`; choose one of {}", known.join(", "))
    })
}
