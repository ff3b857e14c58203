//! `gelray info` of a mesh: what it is made of, where it lies, and whether it encloses anything.

use std::path::Path;

use gelray::formats::meshes::{MeshPicture, mesh_format, read_mesh};
use gelray::polygon::enclosed::Enclosed;
use gelray::view::extent::Extent;
use glam::DVec3;

use super::failure::{Failure, tell};
use super::number::number;
use super::table::table;

/// What a mesh holds, a fact a line, in its file's own coordinates; warnings are told unless `quiet`.
pub fn words(path: &Path, quiet: bool) -> Result<String, Failure> {
    let triangles = read_mesh(path)?;
    for warning in triangles.warnings.iter().filter(|_| !quiet) {
        tell(format_args!("warning: {warning}"));
    }
    let format = mesh_format(path).map_or("mesh", |format| format.name);
    let enclosed = Enclosed::by(&triangles.vertices, &triangles.faces);
    let extent = Extent::of(triangles.vertices.iter().copied());
    let extent = extent.map_or("none".to_owned(), |Extent { low, high }| {
        format!("{} to {}", point(low), point(high))
    });
    let colors = match (triangles.colors.is_empty(), triangles.face_colors.is_empty()) {
        (false, _) => ", in the colors of its vertices",
        (true, false) => ", in the colors of its materials",
        (true, true) => "",
    };
    let clear = triangles.opacities.iter().filter(|opacity| **opacity < 1.0).count();
    let clear = if clear > 0 { format!(", {clear} of them seen through") } else { String::new() };
    let rows = [
        ("file", path.display().to_string()),
        (
            "triangles",
            format!(
                "{} of {} points, {format}{colors}{clear}",
                triangles.faces.len(),
                enclosed.points
            ),
        ),
        ("extent", extent),
        ("area", number(enclosed.area)),
        ("closed", closed(&enclosed)),
    ];
    let pictures = triangles.pictures.iter().map(|own| ("picture", picture(own)));
    let rows = rows.into_iter().chain(pictures);
    let rows: Vec<_> = rows.map(|(name, text)| [name.to_owned(), text]).collect();
    Ok(table(&rows, &[]))
}

/// What a picture is called and how large it is, or why it cannot be had.
fn picture(own: &MeshPicture) -> String {
    let words = match own.weighed() {
        Ok(([width, height], _)) => format!("{}, {width} × {height} pixels", own.name),
        Err(problem) => format!("{}, which {problem}", own.name),
    };
    let veil = own.veil.as_ref().map(|veil| format!("; seen through by {}", picture(veil)));
    words + &veil.unwrap_or_default()
}

fn closed(enclosed: &Enclosed) -> String {
    if enclosed.is_closed() {
        let way = if enclosed.volume < 0.0 { ", its triangles face inward" } else { "" };
        return format!("yes, around a volume of {}{way}", number(enclosed.volume.abs()));
    }
    let faults = [
        (enclosed.open, "of one triangle alone (rims of holes)"),
        (enclosed.shared, "of more than two triangles"),
        (enclosed.turned, "of triangles that face different sides"),
    ];
    let stated = faults.iter().filter(|(count, _)| *count > 0);
    let stated: Vec<_> = stated.map(|(count, what)| format!("{count} edges {what}")).collect();
    format!("no: {}", stated.join(", "))
}

fn point(p: DVec3) -> String {
    format!("({}, {}, {})", number(p.x), number(p.y), number(p.z))
}
