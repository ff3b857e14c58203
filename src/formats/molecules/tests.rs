//! Molecules in both formats, and files that are damaged.

use glam::DVec3;
use proptest::prelude::*;

use super::Element::{Carbon, Nitrogen, Other, Oxygen};
use super::atom::Residue;
use super::*;

const PDB: &str = "\
ATOM      1  N   GLY A   7       0.000   0.000   0.000  1.00 10.00           N  
ATOM      2  CA  GLY A   7       1.450   0.000   0.000  1.00 10.00           C  
ATOM      3  C  AGLY A   7       2.000   1.400   0.000  0.60 10.00           C  
ATOM      4  C  BGLY A   7       2.100   1.300   0.000  0.40 10.00           C  
HETATM    5 ZN    ZN A 101       9.000   9.000   9.000  1.00 10.00          ZN  
HETATM    6  O   HOH A 201       1.450   1.000   1.000  1.00 10.00           O  
CONECT    5    1
ENDMDL
ATOM      1  N   GLY A   7       5.000   0.000   0.000  1.00 10.00           N  
";

const CIF: &str = "data_x
loop_
_atom_site.group_PDB
_atom_site.type_symbol
_atom_site.label_atom_id
_atom_site.label_alt_id
_atom_site.label_comp_id
_atom_site.label_asym_id
_atom_site.label_seq_id
_atom_site.Cartn_x
_atom_site.Cartn_y
_atom_site.Cartn_z
ATOM   N N     . GLY A 7 0.000 0.000 0.000
ATOM   C CA    . GLY A 7 1.450 0.000 0.000
ATOM   C C     A GLY A 7 2.000 1.400 0.000
ATOM   C C     B GLY A 7 2.100 1.300 0.000
HETATM ZN \"ZN\" . ZN  B . 9.000 9.000 9.000
HETATM O 'O 1' . HOH C . 1.450 1.000 1.000
#
";

#[test]
fn both_formats_give_the_same_atoms_and_their_bonds() {
    let [pdb, cif] = [PDB, CIF].map(|text| molecule(text).unwrap());
    assert_eq!(pdb.atoms, cif.atoms);
    assert_eq!(pdb.atoms.len(), 5);
    assert_eq!(pdb.atoms[1].backbone, Some(Residue { chain: "A".to_owned(), number: 7 }));
    assert_eq!((pdb.atoms[3].element, pdb.atoms[3].place), (Element::Other, DVec3::splat(9.0)));
    // N–CA and CA–C by their distances, none to the water that is near; the zinc's as it is stated.
    assert_eq!(cif.bonds, [[0, 1], [1, 2]]);
    assert_eq!(pdb.bonds, [[0, 1], [0, 3], [1, 2]]);
}

#[test]
fn an_element_that_is_not_stated_is_that_of_the_name() {
    let short =
        PDB.lines().map(|line| line.get(..66).unwrap_or(line)).collect::<Vec<_>>().join("\n");
    let elements: Vec<_> =
        molecule(&short).unwrap().atoms.iter().map(|atom| atom.element).collect();
    assert_eq!(elements, [Nitrogen, Carbon, Carbon, Other, Oxygen]);
}

#[test]
fn what_is_no_molecule_is_said() {
    assert!(molecule("hello\n").unwrap_err().contains("no atom"));
    assert!(
        molecule("ATOM      1  N   GLY A   7       0.000   0.0zz   0.000")
            .unwrap_err()
            .contains("line 1")
    );
    assert!(molecule(&CIF.replace("Cartn_z", "other")).unwrap_err().contains("Cartn_z"));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_prefix_and_no_change_of_a_file_panics(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<char>()), 0..6),
        cut in any::<prop::sample::Index>(),
        cif in any::<bool>(),
    ) {
        let mut text: Vec<char> = if cif { CIF } else { PDB }.chars().collect();
        for (at, letter) in changes {
            let place = at.index(text.len());
            text[place] = letter;
        }
        text.truncate(cut.index(text.len()) + 1);
        if let Ok(read) = molecule(&text.into_iter().collect::<String>()) {
            prop_assert!(read.atoms.iter().all(|atom| atom.place.is_finite()));
            prop_assert!(read.bonds.iter().flatten().all(|&n| (n as usize) < read.atoms.len()));
        }
    }
}

#[test]
fn atoms_that_are_all_in_one_place_have_few_bonds() {
    let line = PDB.lines().next().unwrap();
    let text: Vec<String> = (0..4000)
        .map(|n| format!("{}{:8.3}{}\n", &line[..30], f64::from(n % 40) * 0.02, &line[38..]))
        .collect();
    assert!(molecule(&text.concat()).unwrap().bonds.len() <= 4000 * 8);
}
