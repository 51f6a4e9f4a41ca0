//! Surfaces from files: `surface = { file = "fish.stl" }` becomes the triangles in the file, and these a solid.

use std::collections::BTreeMap;

use alewife_mesh::spatial::{SurfaceFault, TriangleMesh};

use super::read_mesh::{Unreadable, bytes_of};
use crate::text::source::Origin;
use crate::text::tree::{TomlNode, TomlValue, TreeError};
use crate::{Case, ShapeSpec};

/// What a file of triangles holds, and the key that names it.
pub(super) struct NamedFile<T> {
    /// The path as it is written.
    pub file: TomlNode,
    /// What was read.
    pub content: T,
}

/// Reads the file of triangles that a surface names; nothing of a surface that names none.
///
/// # Errors
/// When there are triangles beside the name, or the file cannot be read.
pub(super) fn read_named<T>(
    surface: &BTreeMap<String, TomlNode>,
    read: impl FnOnce(&[u8]) -> Result<T, SurfaceFault>,
) -> Result<Option<NamedFile<T>>, TreeError> {
    // A path of another type is refused when the case is typed
    let Some(file) = surface.get("file").filter(|file| file.text().is_some()).cloned() else {
        return Ok(None);
    };
    let refused = |message: String, help: &str| TreeError {
        origin: file.origin.clone(),
        message,
        help: help.to_owned(),
    };
    if surface.contains_key("data") {
        let message = "the surface has both `file` and `data`".to_owned();
        return Err(refused(message, "give `file`: runs write `data` in its place"));
    }
    let name = file.text().unwrap_or_default();
    let bytes = bytes_of(name, &file.origin).map_err(|Unreadable { message, .. }| {
        let help =
            "give the path of an STL, OBJ or PLY file, relative to the file in which it is written";
        refused(message, help)
    })?;
    let content =
        read(&bytes).map_err(|fault| refused(format!("{name}: {fault}"), fault.remedy()))?;
    Ok(Some(NamedFile { file, content }))
}

/// Puts the triangles of a file in the place of its name, so that a case stands for itself.
///
/// # Errors
/// When the file cannot be read, or holds no triangles.
pub fn resolve(surface: &mut TomlNode) -> Result<(), TreeError> {
    let Some(entries) = surface.table_mut() else { return Ok(()) };
    let Some(NamedFile { file, content }) = read_named(entries, TriangleMesh::read)? else {
        return Ok(());
    };
    entries.remove("file");
    let data = TomlNode { value: TomlValue::String(content.to_line()), ..file };
    entries.insert("data".to_owned(), data);
    Ok(())
}

/// Makes solids of the triangles of all bodies.
///
/// # Errors
/// When triangles are the surface of none, with the place of the fault.
pub fn read_into(case: &mut Case, root: &TomlNode) -> Result<(), TreeError> {
    for (index, body) in case.body.iter_mut().enumerate() {
        let ShapeSpec::Surface(surface) = &mut body.shape else { continue };
        // What is out of its range is told of with the rest of the case
        let is_positive = surface.scale.is_finite() && surface.scale > 0.0;
        if !is_positive {
            continue;
        }
        surface.make_solid().map_err(|fault| {
            let key = match fault {
                SurfaceFault::Crease { .. } => "smooth",
                _ => "data",
            };
            let found = root.find(&format!("body.{index}.shape.surface.{key}"));
            let origin: Origin = if found.is_exact {
                found.node.origin.clone()
            } else {
                root.find(&format!("body.{index}.shape.surface.data")).node.origin.clone()
            };
            let message = format!("the surface of \"{}\": {fault}", body.name);
            TreeError { origin, message, help: fault.remedy().to_owned() }
        })?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::fmt::Write;

    use crate::{Case, Severity, ShapeSpec, check};

    /// An octahedron, some of its triangles as they are told.
    fn octahedron(turned: usize, left_out: usize) -> String {
        let mut text = String::new();
        for at in ["1 0 0", "-1 0 0", "0 2 0", "0 -2 0", "0 0 1", "0 0 -1"] {
            let _ = writeln!(text, "v {at}");
        }
        let all = ["1 3 5", "3 2 5", "2 4 5", "4 1 5", "3 1 6", "2 3 6", "4 2 6", "1 4 6"];
        for (nth, triangle) in all.iter().enumerate().skip(left_out) {
            let words: Vec<&str> = triangle.split(' ').collect();
            let order = if nth < turned { [1, 0, 2] } else { [0, 1, 2] };
            let _ = writeln!(text, "f {} {} {}", words[order[0]], words[order[1]], words[order[2]]);
        }
        text
    }

    fn read(obj: &str, keys: &str) -> Result<crate::CaseFile, String> {
        let directory = tempfile::tempdir().unwrap();
        std::fs::write(directory.path().join("body.obj"), obj).unwrap();
        let case = format!(
            "
title = 't'
geometry = 'spatial'
fluid = {{ model = 'stokes', viscosity = 1.0 }}
domain.box = {{ min = [-4, -4, -4], max = [4, 4, 4] }}
mesh = {{ size = 0.5 }}
time = {{ steady = {{}} }}
boundary = {{ left = 'no-slip', right = 'no-slip', bottom = 'no-slip', top = 'no-slip', back = 'no-slip', front = 'no-slip' }}
[[body]]
name = 'b'
center = [0, 0, 0]
motion = 'free'
shape.surface = {{ {keys} }}
"
        );
        let path = directory.path().join("t.toml");
        std::fs::write(&path, case).unwrap();
        Case::read(&path.display().to_string(), &[]).map_err(|error| error.to_string())
    }

    #[test]
    fn a_surface_from_a_file_is_a_solid_and_stands_for_itself() {
        let file = read(&octahedron(0, 0), "file = 'body.obj', scale = 0.5, smooth = 120").unwrap();
        let shape = &file.case().body[0].shape;
        let ShapeSpec::Surface(surface) = shape else { panic!("a surface") };
        assert_eq!((surface.n_triangles(), &surface.file), (8, &None));
        assert!(shape.volume() > 8.0 / 3.0 / 8.0 && shape.reach() >= 1.0);
        let errors = check(&file);
        let errors = errors.iter().filter(|one| one.severity == Severity::Error);
        assert_eq!(errors.map(|one| &one.message).collect::<Vec<_>>(), Vec::<&String>::new());
        // The case of the run needs no file
        let again = Case::parse("t.toml", &file.case().to_toml().unwrap(), &[]).unwrap();
        assert_eq!(again.case(), file.case());
    }

    #[test]
    fn what_is_no_surface_is_told_with_its_place() {
        let smooth = "file = 'body.obj', smooth = 120";
        for (obj, keys, told) in [
            (octahedron(0, 1), smooth, "3 edges are open"),
            (octahedron(1, 0), smooth, "turned inside out"),
            (octahedron(8, 0), smooth, "inside out"),
            (octahedron(0, 0), "file = 'body.obj'", "turns by more than 45 degrees"),
            (octahedron(0, 0), "file = 'other.obj'", "other.obj"),
            ("hello".to_owned(), smooth, "no STL, OBJ or PLY"),
            (octahedron(0, 0) + "f 1 2 99", smooth, "line 15"),
            (octahedron(0, 0), "file = 'body.obj', center = 'middle'", "center"),
            (octahedron(0, 0), "data = 'xx'", "stored surface"),
        ] {
            let error = read(&obj, keys).unwrap_err();
            assert!(error.contains(told), "{told}: {error}");
        }
        let file = read(&octahedron(0, 0), "").unwrap();
        assert!(check(&file).iter().any(|one| one.message.contains("has no triangles")));
    }
}
