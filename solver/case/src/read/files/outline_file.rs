//! Shapes from files: a `polygon` with a `file` becomes the points in it, a `surface` its triangles.

use std::sync::Arc;

use super::surface_file;
use crate::read::columns::point_file::{
    at_end, lines, put_points, resolve_in_bodies, rows, text_of,
};
use crate::text::tree::{TomlNode, TreeError};

/// What a file of corners holds.
const WANTED: &str = "write the corner of each line as two numbers, x and y (m), with a decimal point, \
                      between them a comma or a space; the first line may name them, # begins a comment";

/// Puts corners in the place of the names of their files, so that a case stands for itself.
///
/// # Errors
/// When a file cannot be read, or holds no corners, or there are `points` beside it.
pub fn resolve(root: &mut TomlNode) -> Result<(), TreeError> {
    resolve_in_bodies(root, |key, entry| match key {
        "polygon" => Some(put_points(entry, "polygon", read_points)),
        "surface" => Some(surface_file::resolve(entry)),
        _ => None,
    })
}

/// The corners in a file, as they would be written in the case.
fn read_points(file: &TomlNode) -> Result<TomlNode, TreeError> {
    let source = Arc::new(text_of(file, "text")?);
    let mut points: Vec<[f64; 2]> = Vec::new();
    for line in lines(&source) {
        match line.numbers().as_deref() {
            Some(&[x, y]) => points.push([x, y]),
            // Names before the first corner
            _ if points.is_empty() => {}
            _ => {
                let name = file.text().unwrap_or_default();
                let message = format!("this line of {name} is no corner");
                return Err(TreeError { origin: line.origin, message, help: WANTED.to_owned() });
            }
        }
    }
    // Many files close the outline
    if points.len() > 3 && points.first() == points.last() {
        points.pop();
    }
    if points.len() < 3 {
        let message = format!("{} has {} corners", source.name, points.len());
        return Err(at_end(&source, message, format!("a polygon has three or more: {WANTED}")));
    }
    Ok(rows(file, &points))
}

#[cfg(test)]
mod tests {
    use crate::{Case, ShapeSpec};

    fn read(outline: &str) -> Result<Vec<[f64; 2]>, String> {
        let directory = tempfile::tempdir().unwrap();
        std::fs::write(directory.path().join("outline.csv"), outline).unwrap();
        let case = "
title = 't'
geometry = 'planar'
fluid = { model = 'stokes', viscosity = 1.0 }
domain.box = { min = [-4.0, -4.0], max = [4.0, 4.0] }
boundary = { left = 'no-slip', right = 'no-slip', bottom = 'no-slip', top = 'no-slip' }
mesh = { size = 0.5 }
time.unsteady = { step = 0.1, end = 1.0 }
body = [{ name = 'b', shape.polygon.file = 'outline.csv', center = [0, 0], motion = 'free' }]
";
        let path = directory.path().join("t.toml");
        std::fs::write(&path, case).unwrap();
        let file =
            Case::read(&path.display().to_string(), &[]).map_err(|error| error.to_string())?;
        let ShapeSpec::Polygon(polygon) = &file.case().body[0].shape else { panic!("a polygon") };
        assert_eq!(polygon.file, None);
        Ok(polygon.points.clone())
    }

    #[test]
    fn corners_are_read_with_and_without_names_closed_or_not() {
        let wanted = vec![[0.0, 0.0], [1.0, 0.0], [0.5, 1.5]];
        for text in [
            "x,y\n0,0\n1.0, 0\n0.5,1.5\n",
            "# made by hand\n0 0\n\n1 0 # right\n 5e-1\t1.5\n0 0",
            "TRIANGLE 1\n0;0\n1;0\n0.5;1.5",
        ] {
            assert_eq!(read(text).as_ref(), Ok(&wanted), "{text}");
        }
    }

    #[test]
    fn what_is_no_corner_is_told_with_its_line() {
        let error = |text: &str| read(text).unwrap_err();
        assert!(error("x,y\n0,0\n1,a\n0,1\n").contains("no corner"));
        assert!(error("0,0\n1,0,3\n0,1\n").contains("no corner"));
        assert!(error("0,0\n1,0\n").contains("2 corners"));
        assert!(error("").contains("0 corners"));
    }
}
