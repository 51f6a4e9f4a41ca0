//! The shipped soft cases against their references.

use std::path::PathBuf;

use alewife_case::soft::SoftFile;
use alewife_reduced::tier::{Job, Kind, Model, Seeker, Sought, Which};
use tempfile::TempDir;

/// A shipped case, by its folder.
fn shipped(name: &str) -> SoftFile {
    let case = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../cases").join(name);
    SoftFile::read(&case.display().to_string(), &[]).expect("it is a soft case")
}

#[test]
#[ignore = "long: 15 s; small: a_calibration_finds_the_number_of_the_model_that_made_the_record"]
fn the_calibration_of_the_starfish_meets_its_references() {
    let out = TempDir::new().expect("there is room");
    let file = shipped("starfish-twin");
    let job = Job::<3>::new(&file, Which::Calibration).expect("it is a search");
    let found = job.seek(out.path(), &mut |_| ()).expect("it searches");
    println!("{}", found.text(Which::Calibration));
    assert!(found.compared.len() >= 2);
    for one in &found.compared {
        assert!(one.is_within(), "{}", one.line());
    }
}

/// The vertex of the parabola through three points, by the first numbers.
fn vertex(at: [f64; 3], values: [f64; 3]) -> f64 {
    let [one, other] = [0, 1].map(|k| (values[k + 1] - values[k]) / (at[k + 1] - at[k]));
    let bend = (other - one) / (at[2] - at[0]);
    0.5 * (at[0] + at[1]) - 0.5 * one / bend
}

#[test]
#[ignore = "long: 5 min; small: derivatives_by_every_key_are_those_of_differences"]
fn the_beat_of_most_way_per_work_is_that_of_a_sweep() {
    let out = TempDir::new().expect("there is room");
    let file = shipped("carangiform-soft");
    let job = Job::<2>::new(&file, Which::Optimisation).expect("it is a search");
    let found = job.seek(out.path(), &mut |_| ()).expect("it searches");
    println!("{}", found.text(Which::Optimisation));
    let best = &found.found.best.values;
    // Whole frequencies and amplitudes that know nothing of it
    let frequencies: Vec<f64> = (0..8).map(|k| 0.5 * 1.2_f64.powi(k)).collect();
    let amplitudes: Vec<f64> = (0..7).map(|k| 0.12 * 1.15_f64.powi(k)).collect();
    let objective = file.case.optimisation.as_ref().expect("it has one").objective.clone();
    let parameters = &file.case.optimisation.as_ref().expect("it has one").parameter;
    let mut seeker = Seeker {
        model: Model::<2>::new(&file).expect("it is a body"),
        sought: Sought::new(&file.case, parameters),
        kind: Kind::Optimisation(objective),
    };
    let mut table = Vec::new();
    for frequency in &frequencies {
        let mut row = Vec::new();
        for amplitude in &amplitudes {
            seeker.set(&[*frequency, *amplitude]).expect("it is a beat");
            row.push(seeker.value().expect("it moves"));
        }
        println!("{frequency:.4}: {row:.5?}");
        table.push(row);
    }
    let all = || (0..frequencies.len()).flat_map(|i| (0..amplitudes.len()).map(move |j| (i, j)));
    let (i, j) = all().max_by(|a, b| table[a.0][a.1].total_cmp(&table[b.0][b.1])).expect("some");
    println!("best of the sweep: {} at {} {}", table[i][j], frequencies[i], amplitudes[j]);
    assert!((1..7).contains(&i) && (1..6).contains(&j), "{i} {j}");
    let around = [0, 1, 2];
    let frequency =
        vertex(around.map(|k| frequencies[i + k - 1].ln()), around.map(|k| table[i + k - 1][j]));
    let amplitude =
        vertex(around.map(|k| amplitudes[j + k - 1].ln()), around.map(|k| table[i][j + k - 1]));
    println!("its vertex: {} {}", frequency.exp(), amplitude.exp());
    // No point of the sweep is better, and none near it as good by much
    let value = -found.found.best.objective;
    assert!(value >= table[i][j] && value < 1.02 * table[i][j], "{value} {}", table[i][j]);
    assert!(best.len() == 2, "{best:?}");
    for one in &found.compared {
        assert!(one.is_within(), "{}", one.line());
    }
}
