//! A bar in the plane as a soft case, and its derivatives beside differences.

use std::fs;
use std::path::PathBuf;

use alewife_case::soft::SoftFile;
use alewife_case::soft::search::Parameter;
use alewife_reduced::search::Sought as _;
use alewife_reduced::tier::{Seeker, Sought};
use tempfile::TempDir;

/// A bar in the plane with fibres along one side, which swims across itself.
pub(crate) const BAR: &str = r#"
title = "a bar"
geometry = "planar"

[[solid]]
name = "bar"
order = "linear"
grid = { from = [0.0, -0.06], to = [0.012, 0.06], cells = [2, 12] }
material = { law = "corotated-volume", young = 4e4, poisson = 0.3, density = 1000.0, viscosity = 5.0 }

[[solid.fibre]]
name = "below"
region = { from = [-inf, -0.06], to = [0.006, 0.06] }
direction = [0.0, 1.0]
stiffness = 1e5
stretch.wave = { mean = 0.95, amplitude = 0.04, frequency = 3.0, phase = 0.1 }

[[solid.hold]]
region = { from = [-inf, -0.011], to = [inf, 0.011] }
axes = ["y"]

[soft]
frame = 0.04
frames = 12
tolerance = 1e-12

[loads]
density = 1000.0
drag.bezier = [0.05, 0.05, 1.85, 2.05]
thrust.bezier = [-0.8, -0.5, 0.1, 2.5]

[[marker]]
name = "tip"
at = [0.0, 0.06]
columns = { x = "tip x", y = "-tip y" }

[record]
file = "record.csv"
time_unit = 1e-3
length_unit = 1e-3

[[calibration.parameter]]
name = "young"
keys = ["solid.0.material.young"]
bounds = [1e4, 1e6]

[optimisation.objective.travel]
direction = [1.0, 0.0]
cost_of_work = 0.01

[[optimisation.parameter]]
name = "amplitude"
keys = ["solid.0.fibre.0.stretch.wave.amplitude"]
bounds = [0.001, 0.05]
scale = 0.01

[robot.set]
"solid.0.material.young" = 6e4
"#;

/// A record that fits, with a control that nothing names.
pub(crate) fn record() -> String {
    let row = |k: usize| format!("{},{},{}\n", 40 * k, 0.1 * k as f64, -0.05 * k as f64);
    "time (ms),tip x,tip y\n".to_owned() + &(0..14).map(row).collect::<String>()
}

pub(crate) struct Folder(pub(crate) TempDir);

impl Folder {
    pub(crate) fn new(case: &str, record: &str) -> Self {
        let folder = TempDir::new().expect("there is room");
        fs::write(folder.path().join("case.toml"), case).expect("it is written");
        fs::write(folder.path().join("record.csv"), record).expect("it is written");
        Self(folder)
    }

    pub(crate) fn case(&self) -> PathBuf {
        self.0.path().join("case.toml")
    }

    pub(crate) fn read(&self, settings: &[&str]) -> SoftFile {
        let settings: Vec<String> = settings.iter().map(|one| (*one).to_owned()).collect();
        SoftFile::read(&self.case().display().to_string(), &settings).expect("it is a soft case")
    }
}

/// Keys as numbers that are sought, with their scales.
pub(crate) fn sought(file: &SoftFile, keys: &[(&str, &str, f64)]) -> Sought {
    let parameter = |(name, key, scale): &(&str, &str, f64)| Parameter {
        name: (*name).to_owned(),
        keys: vec![(*key).to_owned()],
        start: None,
        bounds: [-1e9, 1e9],
        scale: Some(*scale),
    };
    Sought::new(&file.case, &keys.iter().map(parameter).collect::<Vec<_>>())
}

/// Compares slopes with central differences, relative to the largest of them.
pub(crate) fn agrees(
    seeker: &mut Seeker<2>,
    start: &[f64],
    keys: &[(&str, &str, f64)],
    slopes: &[f64],
) {
    let scale = |k: usize| keys[k].2;
    let largest = (0..keys.len()).map(|k| (slopes[k] * scale(k)).abs()).fold(0.0, f64::max);
    for k in 0..keys.len() {
        let mut at = |by: f64| {
            let mut values = start.to_vec();
            values[k] += by;
            seeker.evaluate(&values).expect("it moves").objective
        };
        let h = 1e-4 * scale(k);
        let expected = (at(h) - at(-h)) / (2.0 * h);
        let apart = (slopes[k] - expected).abs() * scale(k) / largest;
        assert!(apart < 1e-5, "{}: {} {expected}", keys[k].0, slopes[k]);
    }
}
