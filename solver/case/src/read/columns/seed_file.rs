//! Seeds of tracers from files: a `tracer` with a `file` becomes one with the `points` in it.

use std::sync::Arc;

use super::point_file::{at_end, lines, put_points, rows, text_of};
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
    tracers.iter_mut().try_for_each(|tracer| put_points(tracer, "tracer", read_points))
}

/// The points in a file, as they would be written in the case.
fn read_points(file: &TomlNode) -> Result<TomlNode, TreeError> {
    let source = Arc::new(text_of(file, "text")?);
    let mut points: Vec<Vec<f64>> = Vec::new();
    let mut named = false;
    for line in lines(&source) {
        let n = points.first().map_or(0, Vec::len);
        let message = match line.numbers().filter(|numbers| is_point(numbers)) {
            Some(point) if n == 0 || point.len() == n => {
                points.push(point);
                continue;
            }
            // One line of names before the first point
            None if points.is_empty() && !std::mem::replace(&mut named, true) => continue,
            Some(point) => {
                format!("this point has {} coordinates, the first has {n}", point.len())
            }
            None => format!("this line of {} is no point", file.text().unwrap_or_default()),
        };
        return Err(TreeError { origin: line.origin, message, help: WANTED.to_owned() });
    }
    if points.is_empty() {
        let message = format!("{} has no points", source.name);
        return Err(at_end(&source, message, WANTED.to_owned()));
    }
    Ok(rows(file, &points))
}

fn is_point(numbers: &[f64]) -> bool {
    (2..=3).contains(&numbers.len()) && numbers.iter().all(|x| x.is_finite())
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
