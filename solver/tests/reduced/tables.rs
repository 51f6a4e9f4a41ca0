//! A connection as a table of a case, and what is refused of it.

use alewife::case::{Severity, check_reduced};

use super::{last, read, run};

/// Velocities of the middle link of Purcell's swimmer by the rate of its first angle, at the nodes i and j: steady Stokes
/// flows.
const NODES: &str = include_str!("../../reduced/tests/tree/purcell.csv");

/// All rows, by the mirror and by turning the swimmer end to end.
pub fn purcell() -> String {
    let mut first = [[[0.0; 3]; 6]; 6];
    for line in NODES.lines().skip(1) {
        let row: Vec<f64> = line.split(',').map(|text| text.parse().unwrap()).collect();
        let at = [0, 1].map(|k| (0..6_usize).find(|n| (row[k] - *n as f64).abs() < 0.5).unwrap());
        first[at[0]][at[1]] = [row[2], row[3], row[4]];
        first[5 - at[0]][5 - at[1]] = [-row[2], row[3], row[4]];
    }
    let mut rows = Vec::new();
    for i in 0..6 {
        for j in 0..6 {
            let ([a, b, c], [x, y, turn]) = (first[i][j], first[j][i]);
            rows.push(format!("{:?}", [a, b, c, -x, -y, turn]));
        }
    }
    format!(
        "reduced={{ loads = 'connection', connection = {{ range = [0.62, 0.62], nodes = [6, 6], \
         values = [{}] }} }}",
        rows.join(", ")
    )
}

#[test]
fn purcells_swimmer_goes_by_its_table_as_in_the_full_solver() {
    let series = run("purcell-three-link", &[&purcell()]);
    // By a full run, of the middle link
    let [x, y] = ["x", "y"].map(|axis| last(&series, &format!("swimmer-2.{axis}")));
    let (way, full) = (x.hypot(y), 0.044_584_f64.hypot(0.013_345));
    assert!((way / full - 1.0).abs() < 1e-3, "{x} {y}");
    assert!((y.atan2(x) - 0.013_345_f64.atan2(0.044_584)).to_degrees().abs() < 0.1, "{x} {y}");
    // It has no loads
    assert!(!series.names.iter().any(|name| name.contains("force") || name.contains("power")));
}

#[test]
fn a_table_that_does_not_fit_is_refused_by_key() {
    let wrong = |settings: &[&str]| -> Vec<String> {
        let found = check_reduced(&read("purcell-three-link", settings));
        let errors = found.into_iter().filter(|one| one.severity == Severity::Error);
        errors.map(|one| one.key).collect()
    };
    let table = purcell();
    assert_eq!(wrong(&["reduced={ loads = 'connection' }"]), ["reduced.loads"]);
    let with = |setting: &str| wrong(&[&table, setting]);
    assert_eq!(with("reduced.loads=resistive"), ["reduced.connection"]);
    assert_eq!(with("reduced.connection.range=[0.62]"), ["reduced.connection.range"]);
    assert_eq!(with("reduced.connection.nodes=[6, 0]"), ["reduced.connection.nodes"]);
    assert_eq!(with("reduced.connection.nodes=[5, 6]"), ["reduced.connection.values"]);
    assert_eq!(with("reduced.connection.values.3=[1.0]"), ["reduced.connection.values.3"]);
    let narrow = with("reduced.connection.range=[0.4, 0.4]");
    assert_eq!(narrow, ["reduced.connection.range.0", "reduced.connection.range.1"]);
    let coefficient = "reduced.coefficients={ along = 1.0 }";
    assert_eq!(with(coefficient), ["reduced.coefficients.along"]);
}
