//! Where the nodes of a glTF's scene place its meshes.

use glam::{DMat4, DQuat, DVec3};

use super::document::{Document, Mesh, Node};

/// The meshes of the scene, each as often as it is placed, and its matrix to the scene's coordinates.
///
/// Without scenes and nodes, every mesh as it is. Fails where nodes name nodes that are not there, or `most` are passed.
pub(super) fn placed(document: &Document, most: usize) -> Result<Vec<(&Mesh, DMat4)>, String> {
    let wrong = |what: &str, at: usize| {
        format!("names {what} {at}, which it does not have; export it again")
    };
    if document.nodes.is_empty() {
        return Ok(document.meshes.iter().map(|mesh| (mesh, DMat4::IDENTITY)).collect());
    }
    let roots = match document.scenes.get(document.scene.unwrap_or(0)) {
        Some(scene) => scene.nodes.clone(),
        None => roots(document),
    };
    let mut waiting: Vec<_> = roots.iter().rev().map(|&root| (root, DMat4::IDENTITY)).collect();
    let (mut found, mut passed) = (Vec::new(), 0);
    while let Some((at, above)) = waiting.pop() {
        passed += 1;
        if passed + waiting.len() > most {
            return Err(format!(
                "places more than {most} nodes, or nodes in a circle; export it again"
            ));
        }
        let node = document.nodes.get(at).ok_or_else(|| wrong("node", at))?;
        let matrix = above * own(node);
        if let Some(mesh) = node.mesh {
            let mesh = document.meshes.get(mesh).ok_or_else(|| wrong("mesh", mesh))?;
            found.push((mesh, matrix));
        }
        waiting.extend(node.children.iter().rev().map(|&child| (child, matrix)));
    }
    Ok(found)
}

/// The nodes that are no one's children.
fn roots(document: &Document) -> Vec<usize> {
    let mut is_child = vec![false; document.nodes.len()];
    for &child in document.nodes.iter().flat_map(|node| &node.children) {
        if let Some(is_child) = is_child.get_mut(child) {
            *is_child = true;
        }
    }
    (0..is_child.len()).filter(|&at| !is_child[at]).collect()
}

/// The matrix of a node: stated, or made of its scale, rotation and translation.
fn own(node: &Node) -> DMat4 {
    node.matrix.map_or_else(
        || {
            let rotation = DQuat::from_array(node.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]));
            DMat4::from_scale_rotation_translation(
                DVec3::from(node.scale.unwrap_or([1.0; 3])),
                if rotation.length() > 0.0 { rotation.normalize() } else { DQuat::IDENTITY },
                DVec3::from(node.translation.unwrap_or_default()),
            )
        },
        |columns| DMat4::from_cols_array(&columns),
    )
}
