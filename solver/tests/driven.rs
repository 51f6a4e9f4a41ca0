//! Environments with thrusters and by a connection: a vehicle that holds what it is told, a line, and Purcell's swimmer.
#![expect(clippy::unwrap_used, reason = "a test that cannot open its case has failed")]

use std::f64::consts::FRAC_1_SQRT_2;

use alewife::case::{Asked, Case, CaseFile, Severity, SplitMix64, check};
use alewife::environment::{Autoreset, Batch, Environment, Outcome, Swim};
use alewife::reduced::simulate;

use crate::reduced::tables::purcell as purcells_table;

fn read(name: &str, settings: &[&str]) -> CaseFile {
    let settings: Vec<String> = settings.iter().map(|one| (*one).to_owned()).collect();
    let file = Case::read(name, &settings).unwrap();
    let errors = check(&file).into_iter().filter(|one| one.severity == Severity::Error);
    assert_eq!(errors.map(|one| one.to_string()).collect::<Vec<_>>(), Vec::<String>::new());
    file
}

/// Force of a thruster (N) by its command.
fn force(command: f64) -> f64 {
    [8.9, 176.0, -404.1, 389.9, -140.3].iter().rev().fold(0.0, |sum, c| sum * command * command + c)
        * command
}

/// The command for a force, up to that of 0.9.
fn command(wanted: f64) -> f64 {
    let (mut low, mut high) = (0.0, 0.9);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if force(middle) < wanted.abs() { low = middle } else { high = middle }
    }
    low.copysign(wanted)
}

/// Commands of the eight thrusters for forces along the axes (N) and torques about them (N m).
fn thrusters([x, y, z]: [f64; 3], [roll, pitch, yaw]: [f64; 3]) -> Vec<f64> {
    let (x, y) = (x / (4.0 * FRAC_1_SQRT_2), y / (4.0 * FRAC_1_SQRT_2));
    let turn = yaw / (4.0 * 0.267 * FRAC_1_SQRT_2);
    let (roll, pitch) = (roll / (4.0 * 0.218), pitch / (4.0 * 0.12));
    let forces = [
        x - y - turn,
        x + y + turn,
        x + y - turn,
        x - y + turn,
        0.25 * z + roll - pitch,
        0.25 * z - roll - pitch,
        0.25 * z + roll + pitch,
        0.25 * z - roll + pitch,
    ];
    forces.iter().map(|one| command(*one)).collect()
}

/// Proportional and integral in what lacks of velocities, proportional and differential in angles.
#[derive(Default)]
struct Pid {
    sums: [f64; 3],
}

impl Pid {
    /// Commands by velocities that lack, angles that lack, and angular velocities.
    fn asks(&mut self, lacks: [f64; 3], angles: [f64; 3], rates: [f64; 3]) -> Vec<f64> {
        let mut forces = [0.0; 3];
        for ((force, sum), lack) in forces.iter_mut().zip(&mut self.sums).zip(lacks) {
            *sum = (*sum + 0.1 * lack).clamp(-1.5, 1.5);
            *force = 60.0 * lack + 60.0 * *sum;
        }
        let torque = |k: usize| 8.0 * angles[k] - 2.5 * rates[k];
        thrusters(forces, [torque(0), torque(1), torque(2)])
    }
}

fn three(values: &[f64]) -> [f64; 3] {
    [values[0], values[1], values[2]]
}

/// The shipped observations: u, v, w, roll, pitch, three rates, heading, what lacks of u, v and w.
fn held(env: &mut impl Environment, seed: u64) -> Vec<f64> {
    let mut pid = Pid::default();
    let mut seen = env.reset(Some(seed)).unwrap().observation;
    loop {
        let angles = [-seen[3], -seen[4], -seen[8]];
        let Outcome { observation, truncated, terminated, .. } =
            env.step(&pid.asks(three(&seen[9..]), angles, three(&seen[5..]))).unwrap();
        assert!(!terminated, "it turns over");
        seen = observation;
        if truncated {
            return seen;
        }
    }
}

#[test]
fn a_tuned_controller_holds_a_velocity_whatever_the_ballast_and_the_drag() {
    let target = "environment.target.u={ uniform = [0.499, 0.501] }";
    let mut env = Swim::open(&read("underwater-vehicle/hold", &[target])).unwrap();
    let mut worst = 0.0_f64;
    let mut samples = Vec::new();
    // Other ballast and drag than any controller has been tuned by
    for seed in 1000..1012 {
        let last = held(&mut env, seed);
        worst = worst.max((last[0] / 0.5 - 1.0).abs()).max(last[10].abs()).max(last[11].abs());
        assert!(last[8].abs() < 0.05 && last[3].abs() < 0.1 && last[4].abs() < 0.2, "{last:?}");
        samples.push((last[12] * 1e12).round());
    }
    assert!(worst < 0.05, "{worst}");
    samples.sort_by(f64::total_cmp);
    samples.dedup();
    assert!(samples.len() > 6, "samples do not differ: {samples:?}");
}

#[test]
fn it_follows_a_line_by_its_line_of_sight() {
    let mut env = Swim::open(&read("underwater-vehicle/line", &[])).unwrap();
    for seed in 0..6 {
        let mut pid = Pid::default();
        let mut seen = env.reset(Some(seed)).unwrap().observation;
        let last = loop {
            // Observations: ..., cross, what lacks of the heading and of u, z
            let lacks = [seen[10], -seen[1], -0.5 * seen[11] - seen[2]];
            let angles = [-seen[3], -seen[4], seen[9]];
            let outcome = env.step(&pid.asks(lacks, angles, three(&seen[5..]))).unwrap();
            assert!(!outcome.terminated, "it turns over");
            seen = outcome.observation;
            if outcome.truncated {
                break seen;
            }
        };
        assert!(last[8].abs() < 0.05 && last[9].abs() < 0.05, "{seed}: {last:?}");
        assert!(last[10].abs() < 0.05 && last[11].abs() < 0.1, "{seed}: {last:?}");
    }
}

#[test]
fn thrusters_have_the_same_bits_in_any_number_of_threads_and_alone() {
    let file = read("underwater-vehicle/hold", &["time.unsteady.end=1.0", "environment.samples=3"]);
    let played = |threads: usize, n: usize| {
        let mut batch = Batch::open(&file, n, threads).unwrap();
        batch.reset(None, None).unwrap();
        let mut random = SplitMix64(3);
        let mut seen: Vec<u64> = Vec::new();
        for _ in 0..14 {
            let all: Vec<f64> = (0..8 * 9).map(|_| 2.0 * random.uniform() - 1.0).collect();
            batch.step(&all[..8 * n], Autoreset::NextStep).unwrap();
            let observations = batch.observations().chunks(20).take(3).flatten();
            seen.extend(observations.map(|one| one.to_bits()));
        }
        seen
    };
    let alone = played(1, 3);
    assert_eq!(alone, played(2, 9));
    assert_eq!(alone, played(3, 5));
    let mut swim = Swim::open(&file).unwrap();
    swim.reset(Some(swim.task().seed())).unwrap();
    let mut random = SplitMix64(3);
    for nth in 0..10 {
        let all: Vec<f64> = (0..8 * 9).map(|_| 2.0 * random.uniform() - 1.0).collect();
        let observed = swim.step(&all[..8]).unwrap().observation;
        let bits: Vec<u64> = observed.iter().map(|value| value.to_bits()).collect();
        assert_eq!(bits, alone[nth * 60..nth * 60 + 20], "{nth}");
    }
    // The first decision of a new episode is that of the first one: nothing is left of a lag
    let [first, again] = [0, 1].map(|_| {
        swim.reset(Some(5)).unwrap();
        swim.step(&[0.7; 8]).unwrap().observation
    });
    assert_eq!(first, again);
}

/// What is observed is what a run with the same commands has in its series, lag included.
#[test]
fn an_episode_of_a_vehicle_is_the_run_that_repeats_it() {
    let quantities = "environment.observations=['vehicle.velocity.x', 'vehicle.velocity.z', \
                      'vehicle.body_angular_velocity.z', 'vehicle.x']";
    let settings = [quantities, "time.unsteady.end=2.0", "environment.randomise=[]"];
    let file = read("underwater-vehicle/hold", &settings);
    let mut swim = Swim::open(&file).unwrap();
    swim.reset(Some(1)).unwrap();
    let mut random = SplitMix64(8);
    let mut seen = Vec::new();
    for nth in 0..20 {
        let action: Vec<f64> = (0..8).map(|_| 2.0 * random.uniform() - 1.0).collect();
        for (one, value) in swim.task().actions().iter().zip(&action) {
            let (time, command) = (0.1 * f64::from(nth), one.command.clone());
            file.model.commands.ask(&Asked { time, command, target: one.target(*value) }).unwrap();
        }
        seen.push(swim.step(&action).unwrap().observation);
    }
    let series = simulate(&file.model).unwrap();
    for (nth, name) in swim.task().observations().iter().enumerate() {
        let column = series.column(name).unwrap();
        for (row, observation) in seen.iter().enumerate() {
            let difference = (observation[nth] - column[10 * (row + 1)]).abs();
            assert!(difference < 1e-9, "{name} {row}: {difference}");
        }
    }
}

/// Purcell's swimmer with two joints on command, by its table.
fn purcell(observations: &str) -> CaseFile {
    let table = purcells_table();
    let joint = "{ bent.angle.command = { limits = [-0.5, 0.5], filter = 0.04 } }";
    let joints = format!("swimmer.0.kind.chain.joints=[{joint}, {joint}]");
    let task = format!(
        "environment={{ interval = 0.05, observations = [{observations}], \
         actions = ['swimmer.joint.1', 'swimmer.joint.2'], reward = [{{ of = 'swimmer.x' }}] }}"
    );
    let time = "time.unsteady={ end = 2.0, step = 0.01 }";
    read("purcell-three-link", &[&table, &joints, &task, time, "reference=[]"])
}

/// As far as a run with the same commands comes.
#[test]
fn a_connection_swims_on_command() {
    let file = purcell("'swimmer.x', 'swimmer-1.velocity.y', 'swimmer-1.joint.angle'");
    let mut swim = Swim::open(&file).unwrap();
    swim.reset(Some(1)).unwrap();
    let mut seen = Vec::new();
    for nth in 0..40_usize {
        let action = [[1.0, 1.0], [1.0, -1.0], [-1.0, -1.0], [-1.0, 1.0]][nth / 5 % 4];
        for (one, value) in swim.task().actions().iter().zip(action) {
            let (time, command) = (0.05 * nth as f64, one.command.clone());
            file.model.commands.ask(&Asked { time, command, target: one.target(value) }).unwrap();
        }
        seen.push(swim.step(&action).unwrap().observation);
    }
    let series = simulate(&file.model).unwrap();
    for (nth, name) in swim.task().observations().iter().enumerate() {
        let column = series.column(name).unwrap();
        let most = seen.iter().map(|one| one[nth].abs()).fold(0.0, f64::max);
        assert!(most > 1e-4, "{name} stays at rest");
        for (row, observation) in seen.iter().enumerate() {
            let difference = (observation[nth] - column[5 * (row + 1)]).abs();
            assert!(difference < 1e-9, "{name} {row}: {difference}");
        }
    }
    let error = Swim::open(&purcell("'swimmer-1.force.x'")).unwrap_err();
    assert!(error.to_string().contains("a connection has no loads"), "{error}");
}
