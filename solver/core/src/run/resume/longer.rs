//! Strokes that go on: knots of a table or of a file may be more than they were, if they agree with the past.

use crate::case::Stroke;

/// Change of a value at the time of the state, over the range of the stroke, up to which a stroke is the same: the
/// slope of a natural spline near its end depends on what follows.
const SAME: f64 = 1e-4;

/// Whether the knots of a key, as they are written, are those of a state of a time (s) up to there, and others at
/// most later.
pub(super) fn agrees_with_past(key: &str, state: &str, case: &str, time: f64) -> bool {
    let knots = |text: &str| serde_json::from_str::<Vec<Vec<f64>>>(text).ok();
    let (Some(before), Some(now)) = (knots(state), knots(case)) else { return false };
    // Up to the one that ends the interval of the state
    let past = before.iter().position(|knot| knot.first().is_some_and(|at| *at >= time));
    let past = past.map_or(before.len(), |nth| nth + 1);
    let is_same = |(one, other): (&Vec<f64>, &Vec<f64>)| {
        one.iter().zip(other).take(2).all(|(one, other)| one == other)
    };
    if now.len() < past || !before[..past].iter().zip(&now).all(is_same) {
        return false;
    }
    let (Some(before), Some(now)) = (stroke(key, &before), stroke(key, &now)) else { return false };
    let [least, most] = before.range();
    (before.at(time)[0] - now.at(time)[0]).abs() <= SAME * (most - least)
}

/// The stroke that knots make.
fn stroke(key: &str, knots: &[Vec<f64>]) -> Option<Stroke> {
    let rows = knots.iter().map(Vec::as_slice);
    match key.rsplit('.').next()? {
        "table" => Some(Stroke::Table(rows.map(|row| row.try_into().ok()).collect::<Option<_>>()?)),
        "cubic" => Some(Stroke::Cubic(rows.map(|row| row.try_into().ok()).collect::<Option<_>>()?)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::agrees_with_past;

    #[test]
    fn knots_may_be_added_and_not_be_changed() {
        let agrees = |key: &str, state: &str, case: &str, time: f64| {
            agrees_with_past(&format!("joint.0.kind.bent.angle.{key}"), state, case, time)
        };
        let cubic = "[[0.0,0.0,1.0],[1.0,1.0,0.5],[2.0,0.5,0.1]]";
        // The slope at the end is another one
        let longer = "[[0.0,0.0,1.0],[1.0,1.0,0.5],[2.0,0.5,-0.3],[3.0,0.0,0.0]]";
        assert!(agrees("cubic", cubic, longer, 2.0));
        assert!(agrees("cubic", cubic, longer, 1.0));
        // Within the interval whose end has another slope
        assert!(!agrees("cubic", cubic, longer, 1.5));
        let other = longer.replace("[1.0,1.0", "[1.0,1.1");
        assert!(!agrees("cubic", cubic, &other, 2.0) && !agrees("cubic", cubic, &other, 1.0));
        assert!(agrees("cubic", cubic, &longer.replace("[2.0,0.5", "[2.5,0.5"), 1.0));
        assert!(!agrees("cubic", cubic, "[[0.0,0.0,1.0]]", 1.0));
        let table = "[[0.0,0.0],[1.0,1.0]]";
        assert!(agrees("table", table, "[[0.0,0.0],[1.0,1.0],[2.0,3.0]]", 1.0));
        // It was constant behind its last knot
        assert!(!agrees("table", table, "[[0.0,0.0],[1.0,1.0],[2.0,3.0]]", 1.5));
        assert!(agrees("table", table, "[[0.0,0.0],[1.0,1.0],[1.5,1.0],[2.0,3.0]]", 1.5));
        assert!(!agrees("points", table, "[[0.0,0.0],[1.0,1.0],[2.0,3.0]]", 1.0));
        assert!(!agrees("table", "absent", table, 1.0));
    }
}
