//! Problems of `polygon`: too few corners, repeated ones, sides that cross.

use alewife_mesh::{MeshError, Outline, PlacedShape, Point, Shape};

use crate::rules::Findings;
use crate::spec::body::given::polygon::PolygonShape;

/// Whether corners make a polygon.
pub fn check(findings: &mut Findings<'_>, key: &str, polygon: &PolygonShape) {
    let points = &polygon.points;
    let own = format!("{key}.points");
    let n = points.len();
    if n == 0 {
        findings.error(
            key,
            "the polygon has no corners".to_owned(),
            "write points = [[x, y], [x, y], [x, y], ...], or file = \"outline.csv\"",
        );
        return;
    }
    // That they are three at least is declared
    if n < 3 || !findings.has_no_error() {
        return;
    }
    if let Some(i) = (0..n).find(|i| points[*i] == points[(i + 1) % n]) {
        let [x, y] = points[i];
        let message = if i + 1 == n {
            format!("the last corner of the polygon repeats the first, ({x}, {y})")
        } else {
            format!("corners {} and {} of the polygon are the same, ({x}, {y})", i + 1, i + 2)
        };
        findings.error(&own, message, "leave one of them out");
        return;
    }
    let placed = PlacedShape {
        name: String::new(),
        shape: Shape::Polygon { points: polygon.corners() },
        center: Point::<2>::zeros(),
        angle: 0.0,
        size: None,
    };
    match Outline::new(&placed) {
        Err(MeshError::SelfIntersection { x, y, .. }) => findings.error(
            &own,
            format!("sides of the polygon meet near ({x:.4}, {y:.4}) in the frame of the body"),
            "list the corners in the order in which one follows the other around the body, none on another \
             side",
        ),
        Err(_) => findings.error(
            &own,
            "the corners of the polygon enclose no area".to_owned(),
            "give three or more that are not on one line",
        ),
        Ok(_) => {}
    }
}

#[cfg(test)]
mod tests {
    use crate::{Case, Severity, check};

    /// Messages of the errors in a case of a body of some shape in the plane.
    fn wrong(shape: &str) -> Vec<String> {
        let text = format!(
            "title = 't'
geometry = 'planar'
fluid = {{ model = 'stokes', viscosity = 1.0 }}
domain.box = {{ min = [-4, -4], max = [4, 4] }}
mesh = {{ size = 0.5 }}
time.unsteady = {{ step = 0.1, end = 1.0 }}
body = [{{ name = 'b', shape.{shape}, center = [0, 0], motion = 'free' }}]
boundary = {{ left = 'no-slip', right = 'no-slip', bottom = 'no-slip', top = 'no-slip' }}
"
        );
        let found = match Case::parse("t.toml", &text, &[]) {
            Ok(file) => check(&file),
            Err(error) => return vec![error.to_string()],
        };
        let errors = found.into_iter().filter(|one| one.severity == Severity::Error);
        errors.map(|found| format!("{}: {}", found.key, found.message)).collect()
    }

    #[test]
    fn corners_that_make_no_polygon_are_named() {
        for (points, told) in [
            ("[[0, 0], [1, 0]]", "points"),
            ("[[0, 0], [1, 0], [1, 0], [0, 1]]", "corners 2 and 3"),
            ("[[0, 0], [1, 0], [0, 1], [0, 0]]", "repeats the first"),
            ("[[0, 0], [1, 1], [1, 0], [0, 1]]", "meet near (0.5"),
            ("[[0, 0], [1, 0], [2, 0]]", "meet near"),
        ] {
            let found = wrong(&format!("polygon.points = {points}"));
            assert!(found.iter().any(|one| one.contains(told)), "{points}: {found:?}");
        }
        let found = wrong("polygon = {}");
        assert!(found[0].contains("has no corners"), "{found:?}");
        let found = wrong("box.size = [1, -1]");
        assert!(found[0].contains("body.0.shape.box.size"), "{found:?}");
    }

    #[test]
    fn polygons_either_way_round_and_boxes_are_bodies() {
        for shape in [
            "polygon.points = [[0, 0], [1, 0], [0, 1]]",
            "polygon.points = [[0, 0], [0, 1], [1, 0]]",
            "box.size = [1, 0.2]",
        ] {
            assert_eq!(wrong(shape), Vec::<String>::new(), "{shape}");
        }
    }
}
