//! Seeds of tracers from files: a `tracer` with a `file` becomes one with the `points` in it.

use std::sync::Arc;

use crate::read::case_text::source_beside;
use crate::text::source::{Origin, Source};
use crate::text::tree::{TomlNode, TomlValue, TreeError};

/// What a file of seeds holds.
const WANTED: &str = "write one point a line, its coordinates as two or three numbers (m) with a decimal \
                      point, between them a comma or a space; the first line may name them, # begins a comment";

/// Puts points in the place of the names of their files, so that a case stands for itself.
///
/// # Errors
/// When a file cannot be read, or holds no points, or there are `points` beside it.
pub fn resolve(root: &mut TomlNode) -> Result<(), TreeError> {
    let Some(tracers) = root.table_mut().and_then(|entries| entries.get_mut("tracer")) else {
        return Ok(());
    };
    let TomlValue::Array(tracers) = &mut tracers.value else { return Ok(()) };
    tracers.iter_mut().try_for_each(resolve_one)
}

fn resolve_one(tracer: &mut TomlNode) -> Result<(), TreeError> {
    let Some(entries) = tracer.table_mut() else { return Ok(()) };
    // A path of another type is refused when the case is typed
    let Some(file) = entries.get("file").filter(|file| file.text().is_some()).cloned() else {
        return Ok(());
    };
    if entries.contains_key("points") {
        return Err(TreeError {
            origin: file.key.clone(),
            message: "the tracer has both `points` and `file`".to_owned(),
            help: "give one of them".to_owned(),
        });
    }
    let points = read_points(&file)?;
    entries.remove("file");
    entries.insert("points".to_owned(), points);
    Ok(())
}

/// The points in a file, as they would be written in the case.
fn read_points(file: &TomlNode) -> Result<TomlNode, TreeError> {
    let name = file.text().unwrap_or_default();
    let source = source_beside(name, &file.origin).map_err(|message| TreeError {
        origin: file.origin.clone(),
        message,
        help: "give the path of a text file, relative to the file in which it is written"
            .to_owned(),
    })?;
    let source = Arc::new(source);
    let mut points: Vec<Vec<f64>> = Vec::new();
    let mut start = 0;
    let mut named = false;
    for line in source.text.split_inclusive('\n') {
        let origin =
            Origin { source: Arc::clone(&source), span: start..start + line.trim_end().len() };
        start += line.len();
        let text = line.split('#').next().unwrap_or_default().trim();
        if text.is_empty() {
            continue;
        }
        let n = points.first().map_or(0, Vec::len);
        match point(text) {
            Some(point) if n == 0 || point.len() == n => points.push(point),
            // One line of names before the first point
            None if points.is_empty() && !std::mem::replace(&mut named, true) => {}
            Some(point) => {
                let message =
                    format!("this point has {} coordinates, the first has {n}", point.len());
                return Err(TreeError { origin, message, help: WANTED.to_owned() });
            }
            None => {
                let message = format!("this line of {name} is no point");
                return Err(TreeError { origin, message, help: WANTED.to_owned() });
            }
        }
    }
    if points.is_empty() {
        return Err(empty(&source));
    }
    let node = |value| TomlNode { key: file.key.clone(), origin: file.origin.clone(), value };
    let point = |point: &Vec<f64>| {
        let numbers = point.iter().map(|x| node(TomlValue::Float(*x)));
        node(TomlValue::Array(numbers.collect()))
    };
    Ok(node(TomlValue::Array(points.iter().map(point).collect())))
}

fn empty(source: &Arc<Source>) -> TreeError {
    let end = source.text.len();
    TreeError {
        origin: Origin { source: Arc::clone(source), span: end..end },
        message: format!("{} has no points", source.name),
        help: WANTED.to_owned(),
    }
}

/// The two or three numbers of a line; `None` of other lines.
fn point(text: &str) -> Option<Vec<f64>> {
    let words = text.split([',', ';', ' ', '\t']).filter(|word| !word.is_empty());
    let numbers = words.map(|word| word.parse::<f64>().ok().filter(|x| x.is_finite()));
    let numbers = numbers.collect::<Option<Vec<f64>>>()?;
    (2..=3).contains(&numbers.len()).then_some(numbers)
}

#[cfg(test)]
mod tests {
    use crate::Case;

    fn read(seeds: &str) -> Result<Vec<Vec<f64>>, String> {
        let directory = tempfile::tempdir().unwrap();
        std::fs::write(directory.path().join("seeds.csv"), seeds).unwrap();
        let case = "
title = 't'
geometry = 'planar'
fluid = { model = 'stokes', viscosity = 1.0 }
domain.box = { min = [-4.0, -4.0], max = [4.0, 4.0] }
boundary = { left = 'no-slip', right = 'no-slip', bottom = 'no-slip', top = 'no-slip' }
mesh = { size = 0.5 }
time.unsteady = { step = 0.1, end = 1.0 }
tracer = [{ name = 'a', file = 'seeds.csv' }]
";
        let path = directory.path().join("t.toml");
        std::fs::write(&path, case).unwrap();
        let file =
            Case::read(&path.display().to_string(), &[]).map_err(|error| error.to_string())?;
        assert_eq!(file.case().tracer[0].file, None);
        Ok(file.case().tracer[0].points.clone())
    }

    #[test]
    fn seeds_are_read_with_and_without_names() {
        let wanted = vec![vec![0.0, 0.5], vec![1.0, -1.5]];
        for text in ["x,y\n0,0.5\n1, -1.5\n", "# by hand\n0 .5\n\n1 -1.5 # last"] {
            assert_eq!(read(text).as_ref(), Ok(&wanted), "{text}");
        }
        let error = |text: &str| read(text).unwrap_err();
        assert!(error("x,y\n0,0\n1,a\n").contains("no point"));
        assert!(error("0,0\n1,0,3\n").contains("has 3 coordinates"));
        assert!(error("x,y\n").contains("no points"));
    }
}
