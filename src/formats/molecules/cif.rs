//! mmCIF: the table `_atom_site`, a loop of named columns (International Tables for Crystallography G).

use glam::DVec3;

use super::atom::{Atom, Element, Residue};
use super::pdb::is_water;

/// The atoms of the first model.
pub fn atoms(text: &str) -> Result<Vec<Atom>, String> {
    let mut lines = text.lines().enumerate().skip_while(|(_, line)| !is_column(line)).peekable();
    let mut columns = Vec::new();
    while let Some((_, line)) = lines.next_if(|(_, line)| is_column(line)) {
        columns.push(line.trim().trim_start_matches("_atom_site.").to_owned());
    }
    let find = |name: &str| columns.iter().position(|column| column == name);
    let of = |name: &str| {
        find(name).ok_or_else(|| format!("has no column _atom_site.{name}; fetch the file again"))
    };
    let [x, y, z, symbol] = [of("Cartn_x")?, of("Cartn_y")?, of("Cartn_z")?, of("type_symbol")?];
    let [name, residue, chain, number] =
        ["label_atom_id", "label_comp_id", "label_asym_id", "label_seq_id"].map(find);
    let [alternate, model] = ["label_alt_id", "pdbx_PDB_model_num"].map(find);
    let mut atoms = Vec::new();
    let mut first_model: Option<String> = None;
    for (at, line) in lines {
        let line = line.trim();
        if line.starts_with('#')
            || line == "loop_"
            || line.starts_with('_')
            || line.starts_with("data_")
        {
            break;
        }
        let words = words(line);
        let word =
            |column: Option<usize>| column.and_then(|c| words.get(c)).copied().unwrap_or(".");
        let coordinate =
            |column: usize| words.get(column)?.parse::<f64>().ok().filter(|c| c.is_finite());
        let (Some(x), Some(y), Some(z)) = (coordinate(x), coordinate(y), coordinate(z)) else {
            return Err(format!(
                "line {} is no row of its _atom_site table: it lacks a coordinate",
                at + 1
            ));
        };
        if first_model.get_or_insert_with(|| word(model).to_owned()) != word(model) {
            break;
        }
        if !matches!(word(alternate), "." | "?" | "A" | "1") {
            continue;
        }
        let element = Element::of(word(Some(symbol)));
        let is_backbone = (word(name) == "CA" && element == Element::Carbon) || word(name) == "P";
        let counted = word(number).parse().ok().filter(|_| is_backbone);
        let backbone = counted.map(|number| Residue { chain: word(chain).to_owned(), number });
        atoms.push(Atom {
            place: DVec3::new(x, y, z),
            element,
            is_water: is_water(word(residue)),
            backbone,
        });
    }
    Ok(atoms)
}

fn is_column(line: &str) -> bool {
    line.trim_start().starts_with("_atom_site.")
}

/// The words of a row; those in quotes may have blanks in them.
fn words(line: &str) -> Vec<&str> {
    let (mut words, mut rest) = (Vec::new(), line.trim_start());
    while let Some(first) = rest.chars().next() {
        let quoted = matches!(first, '\'' | '"');
        let body = if quoted { &rest[1..] } else { rest };
        let closes = |&(at, c): &(usize, char)| {
            let next = body[at + c.len_utf8()..].chars().next();
            if quoted {
                c == first && next.is_none_or(char::is_whitespace)
            } else {
                c.is_whitespace()
            }
        };
        let end = body.char_indices().find(closes).map_or(body.len(), |(at, _)| at);
        words.push(&body[..end]);
        rest = body[end..].trim_start_matches(|c| quoted && c == first).trim_start();
    }
    words
}
