//! A fish with tendons, a servo, ellipsoids and a keel: angles by `MuJoCo`, a twin, bad input, fits of one body.

use std::path::Path;

use alewife::case::{Case, Severity, check};
use alewife::reduced::calibrate;

use super::{last, read, run};

/// Time (s), and centres of mass (m) of the head and the last segment of the tail by `MuJoCo` 3.3.7 (`implicitfast`, steps of
/// 1/8 ms) of the same fish from rest at a tail beat of 0.749 Hz.
const SLOW: [[f64; 7]; 6] = [
    [0.1, 0.100725, 0.001044, 0.034901, 0.432713, -0.016563, 0.001319],
    [0.2, 0.100110, 0.001511, 0.035277, 0.424295, -0.016623, 0.002163],
    [0.3, 0.100230, -0.000788, 0.034861, 0.415463, -0.006369, 0.001515],
    [0.4, 0.098225, -0.005602, 0.034598, 0.411021, 0.008100, 0.000250],
    [0.6, 0.086321, -0.014562, 0.034988, 0.411945, 0.036741, 0.001210],
    [0.8, 0.066504, -0.021218, 0.034736, 0.391036, 0.044084, 0.001131],
];

/// The same at 1.313 Hz, over 4 s.
const FAST: [[f64; 7]; 8] = [
    [0.5, 0.057554, -0.016805, 0.034224, 0.378493, 0.043911, -0.000844],
    [1.0, -0.026851, -0.008544, 0.035232, 0.293276, -0.003557, 0.003127],
    [1.5, -0.107063, -0.014786, 0.035405, 0.223214, -0.012131, 0.003422],
    [2.0, -0.190635, -0.032989, 0.035041, 0.132642, 0.028491, 0.003154],
    [2.5, -0.273910, -0.023757, 0.035177, 0.046154, -0.024739, 0.003108],
    [3.0, -0.354080, -0.033055, 0.035404, -0.025978, -0.023105, 0.003557],
    [3.5, -0.437247, -0.049176, 0.035107, -0.112082, 0.011332, 0.003148],
    [4.0, -0.520935, -0.039165, 0.035093, -0.200106, -0.045500, 0.003143],
];

/// The angles (rad) of the five joints of the tail of the slow one at its first four times.
const ANGLES: [[f64; 5]; 4] = [
    [-0.1272, -0.1401, -0.0744, 0.0505, 0.1767],
    [-0.2038, -0.2864, -0.1488, 0.0312, 0.2189],
    [-0.2349, -0.3910, -0.1949, -0.0102, 0.1466],
    [-0.2227, -0.3853, -0.2086, -0.0452, 0.0548],
];

/// Distances (m) of both centres from those of a table.
fn distances(series: &super::Series, table: &[[f64; 7]]) -> Vec<f64> {
    let mut found = Vec::new();
    for row in table {
        let at = series.times.iter().position(|time| (time - row[0]).abs() < 1e-9).unwrap();
        for (nth, body) in ["head", "tail4"].into_iter().enumerate() {
            let off = |axis: usize| {
                let name = format!("{body}.{}", ["x", "y", "z"][axis]);
                series.column(&name).unwrap()[at] - row[1 + 3 * nth + axis]
            };
            found.push([0, 1, 2].map(off).map(|part| part * part).iter().sum::<f64>().sqrt());
        }
    }
    found
}

/// Over 4 s within a millimetre in the root mean square, and within a tenth of one while nothing has grown.
#[test]
fn a_fish_swims_as_in_mujoco() {
    let fast = ["time.unsteady.end=4", "reduced.servo.0.rate=8.24982231"];
    let found = distances(&run("tendon-fish", &fast), &FAST);
    let square: f64 = found.iter().map(|off| off * off).sum();
    let mean = (square / found.len() as f64).sqrt();
    assert!(mean < 5e-4 && found.iter().all(|off| *off < 1e-3), "{mean} {found:?}");
    let slow = run("tendon-fish", &["time.unsteady.end=0.8"]);
    let found = distances(&slow, &SLOW);
    assert!(found.iter().all(|off| *off < 1e-4), "{found:?}");
    // Without the least denominator of MuJoCo 3 it pitches by a quarter more
    let full = run("tendon-fish", &["time.unsteady.end=0.8", "reduced.lift=full"]);
    assert!(distances(&full, &SLOW).iter().any(|off| *off > 1e-3));
}

#[test]
fn the_tail_of_a_fish_bends_as_in_mujoco_at_first() {
    let series = run("tendon-fish", &["time.unsteady.end=0.4"]);
    let column = |name: &str| series.column(name).unwrap();
    for (row, angles) in SLOW.iter().zip(&ANGLES) {
        let at = series.times.iter().position(|time| (time - row[0]).abs() < 1e-9).unwrap();
        for (joint, expected) in angles.iter().enumerate() {
            let found = column(&format!("tail{joint}.joint.angle"))[at];
            assert!((found - expected).abs() < 1e-3, "{joint} at {}: {found} {expected}", row[0]);
        }
    }
    // The effort of the servo is what its rate lacks
    let (rate, effort) = (column("motor.joint.rate"), column("motor.joint.torque"));
    for (rate, effort) in rate.iter().zip(&effort).skip(200) {
        assert!((100.0 * (4.706_105_8 - rate) - effort).abs() < 1e-9, "{rate} {effort}");
        assert!((rate / 4.706_105_8 - 1.0).abs() < 0.02, "{rate}");
    }
}

/// Records of the same fish with other coefficients, rounded to a tenth of a millimetre: one to be fitted from rest, one
/// held out that begins when it swims.
#[test]
fn a_twin_gets_two_coefficients_back() {
    let place = tempfile::tempdir().unwrap();
    let coarse = "time.unsteady.step=0.002";
    for (name, beat, from) in [("slow", 0.749, 0), ("fast", 1.313, 500)] {
        let rate = format!("reduced.servo.0.rate={}", beat * std::f64::consts::TAU);
        let other = ["reduced.coefficients.slender=7.0", "reduced.coefficients.kutta=3.3"];
        let end = "time.unsteady.end=2";
        let series = run("tendon-fish", &[other[0], other[1], coarse, end, &rate]);
        let columns = ["head.x", "tail4.y"].map(|name| series.column(name).unwrap());
        let mut text = "t,x,y\n".to_owned();
        for row in (from..series.times.len()).step_by(25) {
            let [x, y] = [0, 1].map(|k| 1e3 * columns[k][row]);
            text += &format!("{:.3},{x:.1},{y:.1}\n", series.times[row] - series.times[from]);
        }
        std::fs::write(place.path().join(format!("{name}.csv")), text).unwrap();
    }
    let record = "time = 't'\ncolumns = { 'head.x' = 'x', 'tail4.y' = 'y' }\n\
                  units = { 'head.x' = 0.001, 'tail4.y' = 0.001 }\n";
    let text = format!(
        "extends = 'tendon-fish'\ntime.unsteady.step = 0.002\n\
         [calibration]\nfit = ['slender', 'kutta']\n\
         [[calibration.from]]\ncsv = 'slow.csv'\n{record}set = ['reduced.servo.0.rate={}']\n\
         [[calibration.from]]\ncsv = 'fast.csv'\nholdout = true\nstart = 1.0\n{record}\
         set = ['reduced.servo.0.rate={}']\n",
        0.749 * std::f64::consts::TAU,
        1.313 * std::f64::consts::TAU
    );
    let result = calibrate(&written(place.path(), &text)).unwrap();
    for ((name, value), expected) in result.names.iter().zip(&result.fit.parameters).zip([7.0, 3.3])
    {
        assert!((value / expected - 1.0).abs() < 0.02, "{name}: {value}");
    }
    let way =
        |one: &&alewife::reduced::Deviation| one.is_held_out && one.quantity == "head.x in all";
    let way = result.deviations.iter().find(way).unwrap();
    assert!(way.relative.abs() < 0.01 && way.recorded.abs() > 0.1, "{way:?}");
    let tracks = result.to_csv();
    assert!(
        tracks.starts_with("from,holdout,track,time,model,recorded\nslow.csv,false,head.x,0.0,")
    );
    assert!(tracks.contains("fast.csv,true,tail4.y,1.0,0.0,0.0"), "{tracks}");
}

/// A body that has its own coefficient: the twin of three links has the same of all.
#[test]
fn a_coefficient_of_one_body_is_found_and_taken_over() {
    let settings = [
        "reduced.coefficients.added_mass=0.7",
        "reduced.coefficients.tangential_quadratic=0.5",
        "calibration.fit=['normal_quadratic', 'eel-3.normal_quadratic']",
        "calibration.bounds={ normal_quadratic = [0.1, 20.0], 'eel-3.normal_quadratic' = [0.1, 20.0] }",
    ];
    let result = calibrate(&read("eel-calibration", &settings)).unwrap();
    for (name, value) in result.names.iter().zip(&result.fit.parameters) {
        assert!((value / 4.5 - 1.0).abs() < 0.05, "{name}: {value}");
    }
    let place = tempfile::tempdir().unwrap();
    std::fs::write(place.path().join("calibrated.toml"), result.to_toml()).unwrap();
    let text = "extends = 'eel-calibration'\n[reduced]\nloads = 'links'\n\
                calibrated = { file = 'calibrated.toml' }\n";
    let own = |file: &alewife::case::CaseFile| {
        let reduced = file.case().reduced.as_ref().unwrap();
        reduced.body["eel-3"]["normal_quadratic"]
    };
    let file = written(place.path(), text);
    assert!((own(&file) - result.fit.parameters[1]).abs() < 1e-12);
}

fn written(place: &Path, text: &str) -> alewife::case::CaseFile {
    let path = place.join("case.toml");
    std::fs::write(&path, text).unwrap();
    Case::read(path.to_str().unwrap(), &[]).unwrap()
}

#[test]
fn what_cannot_be_is_refused_by_key() {
    let wrong = |case: &str, setting: &str, expected: &str| {
        let found = check(&read(case, &[setting]));
        let errors: Vec<_> = found.iter().filter(|one| one.severity == Severity::Error).collect();
        let is_told =
            errors.iter().any(|one| one.key.starts_with(expected) && !one.help.is_empty());
        assert!(is_told, "{setting}: {errors:?}");
    };
    let fish = |setting: &str, expected: &str| wrong("tendon-fish", setting, expected);
    fish("reduced.servo.0.joint=tail9", "reduced.servo.0.joint");
    fish("reduced.servo.0.gain=-1.0", "reduced.servo.0.gain");
    fish("reduced.servo.0.limit=0.0", "reduced.servo.0.limit");
    fish("reduced.tendon.0.sites.0.body=nobody", "reduced.tendon.0.sites.0.body");
    fish("reduced.tendon.0.sites.1.position=[1.0, 2.0]", "reduced.tendon.0.sites.1.position");
    fish("reduced.tendon.1.stiffness=0.0", "reduced.tendon.1.stiffness");
    fish("reduced.tendon.1.name=left", "reduced.tendon.1.name");
    fish("reduced.keel.tilt_stiffness=-1.0", "reduced.keel.tilt_stiffness");
    fish("body.0.motion=held", "reduced.keel");
    fish("body.0.velocity=[0.1, 0.0, 0.0]", "reduced.keel");
    fish("reduced.ellipsoid.3.semi_axes=[0.1, 0.0, 0.1]", "reduced.ellipsoid.3.semi_axes");
    fish("reduced.ellipsoid.3.body=nobody", "reduced.ellipsoid.3.body");
    let eel = |setting: &str, expected: &str| wrong("eel-calibration", setting, expected);
    eel("calibration.fit=['nobody.added_mass']", "calibration.fit.0");
    eel("calibration.fit=['eel-2.slim']", "calibration.fit.0");
    eel("calibration.from.0.start=-1.0", "calibration.from.0.start");
    wrong("eel-calibration", "reduced.lift=full", "reduced.lift");
    let level = "reduced.keel={ heave_stiffness = 1.0, tilt_stiffness = 1.0 }";
    wrong("eel-calibration", level, "reduced.keel");
    let pieces = "reduced.ellipsoid=[{ body = 'eel-1', position = [0.0, 0.0, 0.0], semi_axes = [0.1, 0.1, 0.1] }]";
    wrong("eel-calibration", pieces, "reduced.ellipsoid");
}

/// A tendon in the plane, slack until the tail is bent away from it: it holds the tail by its spring.
#[test]
fn a_tendon_of_a_case_is_slack_or_pushes() {
    let tendon = |pushes: bool| {
        let sites = "[{ body = 'eel-1', position = [0.0, 0.01] }, { body = 'eel-3', position = [0.0, 0.01] }]";
        format!(
            "reduced.tendon=[{{ name = 'back', stiffness = 50.0, damping = 0.1, rest = 10.0, pushes = {pushes}, sites = {sites} }}]"
        )
    };
    let hinge = "swimmer.0.kind.chain.joints.1={ hinge = { stiffness = 0.01, damping = 0.001 } }";
    let way = |more: &[&str]| {
        last(&run("eel-calibration", &[&[hinge][..], more].concat()), "eel-3.angle")
    };
    let (free, slack, pushed) = (way(&[]), way(&[&tendon(false)]), way(&[&tendon(true)]));
    assert!(
        (free - slack).abs() < 1e-12 && (free - pushed).abs() > 1e-3,
        "{free} {slack} {pushed}"
    );
}
