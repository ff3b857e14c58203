//! Which file names which: `use` statements and paths, followed through re-exports to the file that defines.

use std::collections::{BTreeMap, BTreeSet};

use crate::files::{File, files};

/// A module by the names on its path: `["volume", "gel"]`.
type Module = Vec<String>;

/// For each file, the files that it names.
pub struct Imports {
    named: BTreeMap<String, BTreeSet<String>>,
}

/// What a file is, while imports are followed.
struct Tree {
    /// The file of each module.
    modules: BTreeMap<Module, String>,
    /// For each module, what it hands on from others: the last name, and where it comes from.
    handed_on: BTreeMap<Module, BTreeMap<String, Module>>,
}

impl Imports {
    /// The imports of the library: without tests, the command line, and the two files at the root.
    pub fn of_the_library() -> Self {
        Self::of(&files(&["src", "systems"]).into_iter().filter(is_library).collect::<Vec<_>>())
    }

    /// The imports of the program among its own files; the one at their root names all verbs, and they what it defines.
    pub fn of_the_program() -> Self {
        let verbs = files(&["src/cli"]).into_iter().filter(|file| file.path != "src/cli/mod.rs");
        Self::of(&verbs.collect::<Vec<_>>())
    }

    fn of(all: &[File]) -> Self {
        let modules = all.iter().map(|file| (module(&file.path), file.path.clone())).collect();
        let mut tree = Tree { modules, handed_on: BTreeMap::new() };
        for file in all {
            let own = module(&file.path);
            let text = untested(file);
            let found = paths(&[statements(&text, true), rows(&text)].concat());
            let found = found.into_iter().filter_map(|path| tree.resolve(&own, &path));
            let handed = found.filter_map(|(at, rest)| Some((rest.last()?.clone(), at)));
            let handed: BTreeMap<_, _> = handed.collect();
            tree.handed_on.insert(own, handed);
        }
        let mut named = BTreeMap::new();
        for file in all {
            named.insert(file.path.clone(), tree.named_by(file));
        }
        Self { named }
    }

    /// Every arrow from a file to a file of another room, as their rooms and the arrow in words.
    pub fn between_rooms(&self) -> Vec<([String; 2], String)> {
        let arrows = self.named.iter().flat_map(|(from, to)| to.iter().map(move |to| (from, to)));
        let rooms = arrows.map(|(from, to)| ([room(from), room(to)], format!("{from} → {to}")));
        rooms.filter(|([from, to], _)| from != to).collect()
    }

    /// Every arrow that lies on a circle of files.
    pub fn circles(&self) -> Vec<String> {
        let reaches = |from: &String, to: &String| {
            let (mut seen, mut next) = (BTreeSet::new(), vec![from]);
            while let Some(file) = next.pop() {
                let more = self.named.get(file).into_iter().flatten();
                next.extend(more.filter(|file| seen.insert(*file)));
            }
            seen.contains(to)
        };
        let arrows = self.named.iter().flat_map(|(from, to)| to.iter().map(move |to| (from, to)));
        let turning = arrows.filter(|(from, to)| reaches(to, from));
        turning.map(|(from, to)| format!("{from} → {to}")).collect()
    }

    /// Arrows from a stage to a file of another one.
    pub fn between_stages(&self) -> Vec<String> {
        let stage =
            |file: &str| file.strip_prefix("systems/")?.split_once('/').map(|s| s.0.to_owned());
        let arrows = self.named.iter().flat_map(|(from, to)| to.iter().map(move |to| (from, to)));
        let crossing = arrows
            .filter(|(from, to)| stage(from).zip(stage(to)).is_some_and(|(from, to)| from != to));
        crossing.map(|(from, to)| format!("{from} → {to}")).collect()
    }
}

impl Tree {
    /// The files that a file names.
    fn named_by(&self, file: &File) -> BTreeSet<String> {
        let own = module(&file.path);
        let text = untested(file);
        let mut found = paths(&statements(&text, false));
        found.extend(inline(&text));
        let defined = |path: &Vec<String>| {
            let (at, rest) = self.resolve(&own, path)?;
            self.modules.get(&self.origin(at, rest.first(), 0)).cloned()
        };
        found.iter().filter_map(defined).filter(|named| *named != file.path).collect()
    }

    /// The module that a path leads to, and what is left of the path; `None` for other crates.
    fn resolve(&self, own: &Module, path: &[String]) -> Option<(Module, Vec<String>)> {
        let (mut at, mut rest) = (own.clone(), path);
        match path.first()?.as_str() {
            "crate" => (at, rest) = (Vec::new(), &path[1..]),
            "self" => rest = &path[1..],
            "super" => {
                while rest.first().is_some_and(|name| name == "super") {
                    at.pop();
                    rest = &rest[1..];
                }
            }
            name if !self.modules.contains_key(&joined(&at, name)) => return None,
            _ => {}
        }
        while let Some(name) = rest.first()
            && self.modules.contains_key(&joined(&at, name))
        {
            at.push(name.clone());
            rest = &rest[1..];
        }
        Some((at, rest.to_vec()))
    }

    /// The module that defines what `at` hands on under a name; `at` itself if it defines it.
    fn origin(&self, at: Module, name: Option<&String>, followed: usize) -> Module {
        let from = name.and_then(|name| self.handed_on.get(&at)?.get(name));
        match from {
            Some(from) if followed < 8 => self.origin(from.clone(), name, followed + 1),
            _ => at,
        }
    }
}

fn joined(module: &Module, name: &str) -> Module {
    module.iter().cloned().chain([name.to_owned()]).collect()
}

fn is_library(file: &File) -> bool {
    let apart = ["src/lib.rs", "src/main.rs"].contains(&file.path.as_str());
    !apart && !file.is_in("src/cli/") && !file.path.contains("/tests") && !is_test_alone(file)
}

/// Files that their module declares for tests.
fn is_test_alone(file: &File) -> bool {
    ["hostile_files.rs", "real_files.rs", "made.rs"].iter().any(|name| file.path.ends_with(name))
}

/// The module that a file is: `systems/cast/mod.rs` is `systems::cast`.
fn module(path: &str) -> Module {
    let path = path.strip_prefix("src/").unwrap_or(path).trim_end_matches(".rs");
    path.trim_end_matches("/mod").split('/').map(str::to_owned).collect()
}

/// The room of a file: the first name on its module's path.
fn room(path: &str) -> String {
    module(path).swap_remove(0)
}

/// The code of a file before its tests, without comments.
fn untested(file: &File) -> String {
    let text: Vec<_> = file.code().map(|(_, line)| line).collect();
    let text = text.join("\n");
    let end = text.find("\nmod tests {").unwrap_or(text.len());
    text[..end].to_owned()
}

/// Where a `use` statement begins in a part of a text that a semicolon ends.
fn use_in(part: &str) -> Option<usize> {
    part.rfind("use ").filter(|at| {
        let before = part[..*at].trim_end_matches(' ');
        before.is_empty() || before.ends_with(['\n', '}', ')']) || before.ends_with("pub")
    })
}

/// The paths of the `use` statements of a text: of those that hand on what others define (`pub use`), or of the rest.
fn statements(text: &str, handing_on: bool) -> Vec<String> {
    let statement = |part: &str| {
        let start = use_in(part)?;
        let line = part[..start].rsplit('\n').next().unwrap_or_default();
        (line.starts_with("pub") == handing_on).then(|| part[start + 4..].replace('\n', " "))
    };
    text.split(';').filter_map(statement).collect()
}

/// What the rows of a macro `files!` hand on, each a file and the names in it.
fn rows(text: &str) -> Vec<String> {
    let Some((_, rows)) = text.split_once("\nfiles! {") else { return Vec::new() };
    let rows = rows.split_once("\n}").map_or(rows, |(rows, _)| rows);
    let names = |row: &str| Some(row.split_once('}')?.0.trim().replace('\n', " ") + "}");
    rows.split(';').filter_map(names).collect()
}

/// The paths of some `use` statements, groups taken apart.
fn paths(statements: &[String]) -> Vec<Vec<String>> {
    let mut found = Vec::new();
    for statement in statements {
        expand(statement.trim(), &mut found);
    }
    found
}

fn expand(statement: &str, found: &mut Vec<Vec<String>>) {
    let Some((before, group)) = statement.split_once('{') else {
        let path = statement.split(" as ").next().unwrap_or_default().trim();
        found.push(path.split("::").map(str::to_owned).collect());
        return;
    };
    let group = group.trim_end().trim_end_matches('}');
    let (mut depth, mut start) = (0, 0);
    for (at, letter) in group.char_indices().chain([(group.len(), ',')]) {
        match letter {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                let item = group[start..at].trim();
                if !item.is_empty() {
                    expand(&format!("{before}{item}"), found);
                }
                start = at + 1;
            }
            _ => {}
        }
    }
}

/// Paths in the code itself: from `crate`, `super` or `self`, or from the name of a module in small letters.
fn inline(text: &str) -> Vec<Vec<String>> {
    let is_word = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
    let parts = text.split(';').map(|part| &part[..use_in(part).unwrap_or(part.len())]);
    let words = parts.flat_map(|part| part.split(|c: char| !is_word(c)));
    let words = words.filter(|word| word.contains("::"));
    let path =
        |word: &str| word.trim_matches(':').split("::").map(str::to_owned).collect::<Vec<_>>();
    words.map(path).filter(|path| path.len() > 1).collect()
}
