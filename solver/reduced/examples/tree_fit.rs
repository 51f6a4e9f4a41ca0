//! Fits the links of a robotic eel to its swims at 20 degrees, and predicts those at 10 and 40 degrees.
//!
//! ```sh
//! cargo run --release -p alewife-reduced --example tree_fit -- DIRECTORY
//! ```
//!
//! The directory holds the tracks `{10,20,40}deg_hardware_trajectories.csv`, which are
//! `data/rexeel_forward_swimming` of github.com/RoboticExplorationLab/RoboticSwimmingWithUnifiedFluidRobot: the place (cm)
//! and the yaw (degrees) of the head at 30 Hz, some twenty runs in each file.

use std::error::Error;
use std::f64::consts::{PI, TAU};
use std::path::Path;

use alewife_reduced::tree::loads::{Load, StripCoefficients, Strips};
use alewife_reduced::tree::{
    Bounds, Command, Drive, Joint, JointKind, Link, Number, PlacedLoad, Pose, Residuals, Root,
    Scheme, Stepper, Symmetric, Tree, TreeError, fit, real, vector,
};
use num_dual::Dual64;

/// Lengths (m), masses (kg) and moments of inertia (kg m2) of the links.
const LENGTHS: [f64; 6] = [0.12, 0.098, 0.098, 0.098, 0.098, 0.098];
const MASSES: [f64; 6] = [0.192, 0.14, 0.14, 0.14, 0.14, 0.14];
const MOMENTS: [f64; 6] = [2.43599e-4, 1.48349e-4, 1.48349e-4, 1.48349e-4, 1.48349e-4, 1.48349e-4];

/// Height (m), of the water it swims in all it feels.
const HEIGHT: f64 = 0.0935;

/// Rows of a track, 30 a second, and steps between them.
const ROWS: usize = 120;
const STEPS: usize = 4;

/// What a radian of yaw weighs (m): half the length of the eel.
const LEVER: f64 = 0.3;

/// Head along the swim, across and its yaw (m, m, rad).
type Row<T> = [T; 3];

/// Added mass, drag across and along by the square of the velocity.
fn eel<T: Number>(coefficients: &[T]) -> Result<Tree<T>, TreeError> {
    let zero = real(0.0);
    let coefficients = StripCoefficients {
        added_mass: coefficients[0],
        normal_linear: zero,
        normal_quadratic: coefficients[1],
        tangential_linear: zero,
        tangential_quadratic: coefficients[2],
    };
    let links = (0..6).map(|k| {
        let half = 0.5 * LENGTHS[k];
        // As thick as an elliptic cylinder of its mass
        let width = MASSES[k] / (PI * half * HEIGHT * 1000.0);
        let load = Load::Strips(Strips {
            half_length: real(half),
            half_width: real(width),
            depth: real(HEIGHT),
            density: real(1000.0),
            viscosity: real(1e-3),
            coefficients,
        });
        let body = Symmetric::rigid(real(MASSES[k]), vector([0.0, 0.0, MOMENTS[k]]));
        if k == 0 {
            return Link::root(body).loaded(load);
        }
        let center = Pose::at(vector([-half, 0.0, 0.0]));
        let joint = Joint::new(JointKind::Hinge, [0.0, 0.0, 1.0]).driven(Drive::Given);
        let mut link = Link::new(k - 1, joint, body.seen_from(&center));
        link.loads.push(PlacedLoad { pose: Some(center), load });
        link.placed([if k == 1 { -0.5 * LENGTHS[0] } else { -LENGTHS[k - 1] }, 0.0, 0.0])
    });
    Tree::new(Root::Planar, links.collect())
}

/// A wave of 0.5 Hz to the back, begun over a second.
fn command<T: Number>(degrees: f64, time: f64, link: usize) -> Command<T> {
    let [part, growth] = if time < 1.0 {
        [time * time * (3.0 - 2.0 * time), 6.0 * time * (1.0 - time)]
    } else {
        [1.0, 0.0]
    };
    let (amplitude, rate) = (-degrees.to_radians(), 0.5 * TAU);
    let phase = rate * time - 0.7 * TAU * (link as f64 - 1.0) / 5.0;
    Command {
        place: real(amplitude * part * phase.sin()),
        rate: real(amplitude * (growth * phase.sin() + part * rate * phase.cos())),
        effort: real(0.0),
    }
}

fn track<T: Number>(coefficients: &[T], degrees: f64) -> Result<Vec<Row<T>>, TreeError> {
    let tree = eel(coefficients)?;
    let mut state = tree.rest();
    let mut stepper = Stepper::new(&tree, Scheme::Midpoint);
    let mut rows = Vec::new();
    for _ in 1..ROWS {
        for _ in 0..STEPS {
            let command = |time: f64, link: usize| command(degrees, time, link);
            stepper.step(&tree, &mut state, real(1.0 / (30.0 * STEPS as f64)), &command)?;
        }
        let at = &state.root;
        rows.push([at.position.x, at.position.y, at.heading()]);
    }
    Ok(rows)
}

/// The mean of all runs of a file, from its second row on.
fn recorded(directory: &Path, degrees: u32) -> Result<Vec<Row<f64>>, Box<dyn Error>> {
    let path = directory.join(format!("{degrees}deg_hardware_trajectories.csv"));
    let mut reader = csv::Reader::from_path(path)?;
    let mut rows = vec![[0.0; 4]; ROWS];
    for record in reader.records() {
        let record = record?;
        let field = |k: usize| record.get(k).unwrap_or_default();
        let frame: usize = field(1).parse()?;
        let values = [3, 4, 5].map(|k| field(k).parse::<f64>().unwrap_or(f64::NAN));
        if frame < ROWS && values.iter().all(|value| value.is_finite()) {
            let [x, y, yaw] = values;
            // It swims along y from the middle of its tank
            let row = [(y - 61.0) * 0.01, (61.0 - x) * 0.01, (yaw - 90.0).to_radians(), 1.0];
            rows[frame].iter_mut().zip(row).for_each(|(sum, value)| *sum += value);
        }
    }
    Ok(rows[1..].iter().map(|[x, y, yaw, n]| [x / n, y / n, yaw / n]).collect())
}

struct Swim(Vec<Row<f64>>);

impl Residuals for Swim {
    fn residuals(&self, coefficients: &[Dual64]) -> Result<Vec<Dual64>, TreeError> {
        let found = track(coefficients, 20.0)?;
        let left = |(found, seen): (&Row<Dual64>, &Row<f64>)| {
            [found[0] - seen[0], (found[2] - seen[2]) * LEVER]
        };
        Ok(found.iter().zip(&self.0).flat_map(left).collect())
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let directory = std::env::args().nth(1).ok_or("which directory?")?;
    let directory = Path::new(&directory);
    let bounds = [3.0, 20.0, 5.0].map(|upper| Bounds { lower: 0.0, upper });
    let found = fit(&Swim(recorded(directory, 20)?), &[1.0, 2.0, 0.1], &bounds, 200)?;
    let names = ["added_mass", "normal_quadratic", "tangential_quadratic"];
    for (k, name) in names.iter().enumerate() {
        println!("{name:22} {:8.3} +- {:.3}", found.parameters[k], found.uncertainties[k]);
    }
    for degrees in [10, 20, 40] {
        let (made, seen) =
            (track(&found.parameters, f64::from(degrees))?, recorded(directory, degrees)?);
        let (Some(made), Some(seen)) = (made.last(), seen.last()) else { continue };
        println!(
            "{degrees} degrees: way {:.2} cm, recorded {:.2} ({:+.1} %); yaw {:.1} degrees, recorded {:.1}",
            100.0 * made[0],
            100.0 * seen[0],
            100.0 * (made[0] / seen[0] - 1.0),
            made[2].to_degrees(),
            seen[2].to_degrees()
        );
    }
    Ok(())
}
