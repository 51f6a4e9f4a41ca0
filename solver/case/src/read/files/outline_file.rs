//! Shapes from files: a `polygon` with a `file` becomes the points in it, a `surface` its triangles.

use std::sync::Arc;

use super::surface_file;
use crate::read::case_text::source_beside;
use crate::text::source::{Origin, Source};
use crate::text::tree::{TomlNode, TomlValue, TreeError};

/// Tables of a case with shapes in them.
const TABLES: [&str; 2] = ["body", "swimmer"];

/// What a file of corners holds.
const WANTED: &str = "write the corner of each line as two numbers, x and y (m), with a decimal point, \
                      between them a comma or a space; the first line may name them, # begins a comment";

/// Puts corners in the place of the names of their files, so that a case stands for itself.
///
/// # Errors
/// When a file cannot be read, or holds no corners, or there are `points` beside it.
pub fn resolve(root: &mut TomlNode) -> Result<(), TreeError> {
    for table in TABLES {
        if let Some(node) = root.table_mut().and_then(|entries| entries.get_mut(table)) {
            resolve_below(node)?;
        }
    }
    Ok(())
}

fn resolve_below(node: &mut TomlNode) -> Result<(), TreeError> {
    match &mut node.value {
        TomlValue::Table(entries) => {
            for (key, entry) in entries {
                match key.as_str() {
                    "polygon" => resolve_polygon(entry)?,
                    "surface" => surface_file::resolve(entry)?,
                    _ => resolve_below(entry)?,
                }
            }
        }
        TomlValue::Array(items) => {
            for item in items {
                resolve_below(item)?;
            }
        }
        _ => {}
    }
    Ok(())
}

fn resolve_polygon(polygon: &mut TomlNode) -> Result<(), TreeError> {
    let Some(entries) = polygon.table_mut() else { return Ok(()) };
    // A path of another type is refused when the case is typed
    let Some(file) = entries.get("file").filter(|file| file.text().is_some()).cloned() else {
        return Ok(());
    };
    if entries.contains_key("points") {
        return Err(TreeError {
            origin: file.key.clone(),
            message: "the polygon has both `points` and `file`".to_owned(),
            help: "give one of them".to_owned(),
        });
    }
    let points = read_points(&file)?;
    entries.remove("file");
    entries.insert("points".to_owned(), points);
    Ok(())
}

/// The corners in a file, as they would be written in the case.
fn read_points(file: &TomlNode) -> Result<TomlNode, TreeError> {
    let name = file.text().unwrap_or_default();
    let source = source_beside(name, &file.origin).map_err(|message| TreeError {
        origin: file.origin.clone(),
        message,
        help: "give the path of a text file, relative to the file in which it is written"
            .to_owned(),
    })?;
    let source = Arc::new(source);
    let mut points: Vec<[f64; 2]> = Vec::new();
    let mut start = 0;
    for line in source.text.split_inclusive('\n') {
        let origin =
            Origin { source: Arc::clone(&source), span: start..start + line.trim_end().len() };
        start += line.len();
        let text = line.split('#').next().unwrap_or_default().trim();
        if text.is_empty() {
            continue;
        }
        match corner(text) {
            Some(corner) => points.push(corner),
            // Names before the first corner
            None if points.is_empty() => {}
            None => {
                let message = format!("this line of {name} is no corner");
                return Err(TreeError { origin, message, help: WANTED.to_owned() });
            }
        }
    }
    // Many files close the outline
    if points.len() > 3 && points.first() == points.last() {
        points.pop();
    }
    if points.len() < 3 {
        return Err(too_few(&source, points.len()));
    }
    let node = |value| TomlNode { key: file.key.clone(), origin: file.origin.clone(), value };
    let corner = |point: &[f64; 2]| {
        node(TomlValue::Array(point.map(|x| node(TomlValue::Float(x))).to_vec()))
    };
    Ok(node(TomlValue::Array(points.iter().map(corner).collect())))
}

fn too_few(source: &Arc<Source>, n: usize) -> TreeError {
    let end = source.text.len();
    TreeError {
        origin: Origin { source: Arc::clone(source), span: end..end },
        message: format!("{} has {n} corners", source.name),
        help: format!("a polygon has three or more: {WANTED}"),
    }
}

/// The two numbers of a line; `None` of other lines.
fn corner(text: &str) -> Option<[f64; 2]> {
    let words = text.split([',', ';', ' ', '\t']).filter(|word| !word.is_empty());
    let numbers = words.map(|word| word.parse::<f64>().ok()).collect::<Option<Vec<f64>>>()?;
    let [x, y] = numbers.as_slice() else { return None };
    Some([*x, *y])
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
