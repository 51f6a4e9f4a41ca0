//! A fish with tendons, a servo, ellipsoids and a keel: angles by `MuJoCo`, a twin, bad input, fits of one body.

use std::path::Path;

use alewife::case::{Case, Severity, check};
use alewife::reduced::calibrate;

use super::{last, read, run};

/// Time (s), and the angles (rad) of the five joints of the tail by `MuJoCo` 3.3.7 (steps of 1 ms, `implicitfast`) of the
/// same fish from rest at a tail beat of 0.749 Hz, its motor without a bound: `MuJoCo` has the slope of a servo in its
/// matrix beyond the bound, too, and starts 4 ms later by it.
const MUJOCO: [[f64; 6]; 4] = [
    [0.1, -0.1274, -0.1399, -0.0734, 0.0523, 0.1800],
    [0.2, -0.2046, -0.2854, -0.1482, 0.0321, 0.2209],
    [0.3, -0.2349, -0.3909, -0.1947, -0.0098, 0.1475],
    [0.4, -0.2227, -0.3853, -0.2086, -0.0453, 0.0546],
];

#[test]
fn the_tail_of_a_fish_bends_as_in_mujoco_at_first() {
    let unlimited = "reduced.servo=[{ joint = 'motor', rate = 4.7061058, gain = 100.0 }]";
    let series = run("tendon-fish", &["time.unsteady.end=0.4", unlimited]);
    let column = |name: &str| series.column(name).unwrap();
    for row in MUJOCO {
        let at = series.times.iter().position(|time| (time - row[0]).abs() < 1e-9).unwrap();
        for (joint, expected) in row[1..].iter().enumerate() {
            let found = column(&format!("tail{joint}.joint.angle"))[at];
            assert!((found - expected).abs() < 6e-3, "{joint} at {}: {found} {expected}", row[0]);
        }
    }
    // The effort of the servo is what its rate lacks
    let (rate, effort) = (column("motor.joint.rate"), column("motor.joint.torque"));
    for (rate, effort) in rate.iter().zip(&effort).skip(100) {
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
